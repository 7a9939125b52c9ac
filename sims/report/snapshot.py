"""Still pictures of a MuJoCo scene, drawn without a window."""

from __future__ import annotations

import base64
import copy
import io
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from sims.writing import write
from wbc.errors import InputError, WbcError

if TYPE_CHECKING:
    import mujoco

__all__ = ["Image", "NoDisplay", "data_url", "render", "write_png"]

Image: TypeAlias = NDArray[np.uint8]


@final
class NoDisplay(WbcError, RuntimeError):
    """No picture can be drawn on this machine: it has no usable OpenGL."""


def render(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    camera: mujoco.MjvCamera | None = None,
    width: int = 960,
    height: int = 600,
) -> Image:
    """A picture (height, width, 3) of the scene as `data` holds it.

    Neither `model` nor `data` is written to. Without `camera` MuJoCo's free camera
    looks at the whole scene.

    Raises:
        InputError: a size that is not positive.
        NoDisplay: no OpenGL, with what to do about it.
    """
    if width < 1 or height < 1:
        raise InputError(f"a picture needs a positive size, got {width} x {height}.")
    roomy = copy.copy(model)  # the frame buffer's size is part of the model
    roomy.vis.global_.offwidth = max(width, model.vis.global_.offwidth)
    roomy.vis.global_.offheight = max(height, model.vis.global_.offheight)
    try:
        return _draw(roomy, data, camera, width, height)
    except Exception as error:  # each backend of OpenGL fails with a type of its own
        raise NoDisplay(
            f"no picture without OpenGL ({type(error).__name__}: {error}). Set the "
            "environment variable MUJOCO_GL to egl or osmesa before Python starts, "
            "and install the system's EGL or OSMesa library."
        ) from error


def write_png(path: str | Path, image: Image) -> None:
    """Write a picture (height, width, 3) of bytes as a PNG file.

    Raises:
        InputError: another shape or another type of number.
        NotWritten: there is no room for the file, or no right to write it.
    """
    import PIL.Image

    pixels = np.asarray(image)
    if pixels.dtype != np.uint8 or pixels.ndim != 3 or pixels.shape[2] != 3:
        raise InputError(
            f"a picture is (height, width, 3) of uint8, not {pixels.shape} of "
            f"{pixels.dtype}."
        )
    buffer = io.BytesIO()
    PIL.Image.fromarray(pixels).save(buffer, format="PNG")
    write(path, buffer.getvalue())


def data_url(image: Image) -> str:
    """A picture (height, width, 3) as a JPEG within the text of a page."""
    import PIL.Image

    buffer = io.BytesIO()
    PIL.Image.fromarray(image).save(buffer, format="JPEG", quality=85)
    packed = base64.b64encode(buffer.getvalue()).decode("ascii")
    return f"data:image/jpeg;base64,{packed}"


def _context(width: int, height: int) -> Any:
    """An OpenGL context: EGL on a Linux without windows, else MuJoCo's choice."""
    import mujoco

    chosen = ("MUJOCO_GL", "DISPLAY", "WAYLAND_DISPLAY")
    if sys.platform == "linux" and not any(os.environ.get(name) for name in chosen):
        from mujoco.egl import GLContext

        return GLContext(width, height)
    return mujoco.GLContext(width, height)


def _draw(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    camera: mujoco.MjvCamera | None,
    width: int,
    height: int,
) -> Image:
    import mujoco

    context = _context(width, height)
    try:
        context.make_current()
        gpu = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, gpu)
        scene = mujoco.MjvScene(model, maxgeom=10_000)
        options, every = mujoco.MjvOption(), mujoco.mjtCatBit.mjCAT_ALL
        if camera is None:
            camera = mujoco.MjvCamera()
            mujoco.mjv_defaultFreeCamera(model, camera)
        mujoco.mjv_updateScene(model, data, options, None, camera, every, scene)
        frame = mujoco.MjrRect(0, 0, width, height)
        mujoco.mjr_render(frame, scene, gpu)
        picture = np.zeros((height, width, 3), dtype=np.uint8)
        mujoco.mjr_readPixels(picture, None, frame, gpu)
        gpu.free()
    finally:
        context.free()
    return np.ascontiguousarray(picture[::-1])  # OpenGL's first row is the lowest
