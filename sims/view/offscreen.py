"""Pictures of a cell that runs, drawn without a window."""

from __future__ import annotations

import copy
import sys
from typing import Any, Final, final

import mujoco
import numpy as np

from sims.report.snapshot import Image, NoDisplay
from sims.view.caption import Caption
from sims.view.overlay import Frame, World
from sims.view.painting import paint

__all__ = ["HEIGHT", "WIDTH", "Offscreen"]

WIDTH, HEIGHT = 1280, 720
GEOMS: Final = 20_000
"""Room in a scene: meat alone has thousands."""


@final
class Offscreen:
    """Draws one cell after another into memory.

    Args:
        camera: from where; MuJoCo's choice for the whole scene by default.

    Raises:
        NoDisplay: no OpenGL on this machine.
    """

    _world: World

    def __init__(self, camera: mujoco.MjvCamera | None = None) -> None:
        self._camera, self._gpu = camera, None
        try:
            self._context = _context()
            self._context.make_current()
        except Exception as error:  # each backend of OpenGL fails with its own type
            raise NoDisplay(
                f"no video without OpenGL ({type(error).__name__}: {error}). Set the "
                "environment variable MUJOCO_GL to egl or osmesa before Python starts, "
                "and install the system's EGL or OSMesa library."
            ) from error

    def attach(self, world: World) -> None:
        """Draw this cell from now on."""
        self._context.make_current()
        self._free()
        roomy = copy.copy(world.model)  # the frame buffer's size is part of the model
        roomy.vis.global_.offwidth, roomy.vis.global_.offheight = WIDTH, HEIGHT
        # without a graphics card shadows take twice as long as all the rest
        roomy.vis.quality.shadowsize = 0
        self._gpu = mujoco.MjrContext(roomy, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._gpu)
        self._world, self._options = world, mujoco.MjvOption()
        self._scene = mujoco.MjvScene(world.model, maxgeom=GEOMS)
        if self._camera is None:
            self._camera = mujoco.MjvCamera()
            mujoco.mjv_defaultFreeCamera(world.model, self._camera)

    def shoot(self, frame: Frame) -> Image:
        """The cell as it stands, with an overlay: (height, width, 3)."""
        self._context.make_current()
        model, data, scene = self._world.model, self._world.data, self._scene
        every = mujoco.mjtCatBit.mjCAT_ALL
        mujoco.mjv_updateScene(
            model, data, self._options, None, self._camera, every, scene
        )
        paint(scene, frame.marks)
        area = mujoco.MjrRect(0, 0, WIDTH, HEIGHT)
        mujoco.mjr_render(area, scene, self._gpu)
        self._write(area, frame.words)
        picture = np.empty((HEIGHT, WIDTH, 3), dtype=np.uint8)
        mujoco.mjr_readPixels(picture, None, area, self._gpu)
        return np.ascontiguousarray(picture[::-1])  # OpenGL's first row is the lowest

    def _write(self, area: mujoco.MjrRect, words: Caption) -> None:
        font, corner = mujoco.mjtFont.mjFONT_NORMAL, mujoco.mjtGridPos.mjGRID_TOPLEFT
        mujoco.mjr_overlay(font, corner, area, words.left, words.right, self._gpu)

    def _free(self) -> None:
        if self._gpu is not None:
            self._gpu.free()
            self._gpu = None

    def close(self) -> None:
        """Give the memory back."""
        self._context.make_current()
        self._free()
        self._context.free()


def _context() -> Any:
    """An OpenGL context, of EGL on a Linux where nothing else is asked for.

    Beside an open window, too: GLFW serves one thread only, and that one is the
    window's.
    """
    import os

    if sys.platform == "linux" and not os.environ.get("MUJOCO_GL"):
        from mujoco.egl import GLContext

        return GLContext(WIDTH, HEIGHT)
    return mujoco.GLContext(WIDTH, HEIGHT)
