"""A live window on a cell: MuJoCo's passive viewer with an overlay and a few keys."""

from __future__ import annotations

import threading
import time
import warnings
from typing import Any, Final, final

import mujoco

from sims.view.jogger import Jogger
from sims.view.overlay import Frame, World
from sims.view.painting import paint
from wbc.errors import WbcError

__all__ = ["KEYS", "NoWindow", "Restart", "Window", "WindowClosed", "need_display"]

FRAME: Final = 1.0 / 60.0
"""Between two pictures [s]."""
PATIENCE: Final = 5.0
"""With a window that closes [s]."""
PAUSE, RESTART = ord(" "), 259
"""GLFW key codes of space and backspace."""
KEYS: Final = (
    "space pauses, backspace goes back to the start of the run, arrow and page keys "
    "jog a pose that is held, closing the window ends it all"
)


@final
class NoWindow(WbcError, RuntimeError):
    """No window opens on this machine."""


class Restart(Exception):
    """The operator wants the run from its start."""


class WindowClosed(Exception):
    """The operator has closed the window."""


@final
class Window:
    """MuJoCo's passive viewer, fed at 60 frames a second in real time.

    Args:
        world: the cell.
        jogger: gets the keys that are not the window's own.
        camera: from where it is seen at first; MuJoCo's choice by default.

    Raises:
        NoWindow: none opens.
    """

    def __init__(
        self, world: World, jogger: Jogger, camera: mujoco.MjvCamera | None = None
    ) -> None:
        self._data, self._jogger = world.data, jogger
        self._paused = self._restart = False
        self._due, self._shown = 0.0, time.perf_counter()
        threads = set(threading.enumerate())
        self._window: Any = self._launch(world)
        self._threads = set(threading.enumerate()) - threads
        if camera is not None:
            with self._window.lock():
                self._window.cam.lookat[:] = camera.lookat
                self._window.cam.distance = camera.distance
                self._window.cam.azimuth = camera.azimuth
                self._window.cam.elevation = camera.elevation

    def _launch(self, world: World) -> Any:
        try:
            import mujoco.viewer  # opens the window system, which a headless run lacks

            return mujoco.viewer.launch_passive(
                world.model,
                world.data,
                key_callback=self._key,
                show_left_ui=False,
                show_right_ui=False,
            )
        except (ImportError, RuntimeError) as error:
            raise NoWindow(str(error)) from error

    @property
    def camera(self) -> mujoco.MjvCamera:
        """From where it is seen, as the operator has turned it."""
        return self._window.cam

    def _key(self, key: int) -> None:
        if key == PAUSE:
            self._paused = not self._paused
        elif key == RESTART:
            self._restart = True
        else:
            self._jogger.press(key)

    def due(self) -> bool:
        """Whether it is time for a picture; a clock set back starts afresh."""
        if self._data.time < self._due - FRAME:
            self._due = self._data.time
        return bool(self._data.time >= self._due)

    def show(self, frame: Frame) -> None:
        """Show it, and keep real time; while it is paused, do not return.

        Raises:
            Restart: the operator wants the run from its start.
            WindowClosed: the window is gone.
        """
        self._due = self._data.time + FRAME
        self._draw(frame)
        while self._paused and self._window.is_running() and not self._restart:
            time.sleep(FRAME)
            self._draw(frame)
        if not self._window.is_running():
            raise WindowClosed
        if self._restart:
            self._restart = self._paused = False
            raise Restart
        late = time.perf_counter() - self._shown
        time.sleep(max(0.0, FRAME - late))
        self._shown = time.perf_counter()

    def _draw(self, frame: Frame) -> None:
        """Hand the state and its overlay over to the window's own thread."""
        scene = self._window.user_scn
        with self._window.lock():
            scene.ngeom = 0
            paint(scene, frame.marks)
        left, right = frame.words
        if self._paused:
            left, right = f"paused\n{left}", f"\n{right}"
        corner, font = mujoco.mjtGridPos.mjGRID_TOPLEFT, mujoco.mjtFont.mjFONT_NORMAL
        self._window.set_texts((font, corner, left, right))
        before = self._data.time
        self._window.sync()
        if self._data.time < before:  # its own reset button wipes the state
            self._restart = True

    def close(self) -> None:
        """Close the window, and wait until all that it holds is given back."""
        self._window.close()
        for thread in self._threads:
            thread.join(PATIENCE)


def need_display() -> None:
    """Ask GLFW first: MuJoCo's viewer ends the whole process where GLFW fails.

    Raises:
        NoWindow: no window can be opened.
    """
    try:
        import glfw
    except ImportError as error:
        raise NoWindow(str(error)) from error
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        ready = glfw.init()
    if not ready:
        raise NoWindow(str(said[-1].message) if said else "GLFW does not start")
