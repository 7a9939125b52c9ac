"""A live window on a cell: MuJoCo's passive viewer with an overlay and a few keys."""

from __future__ import annotations

import threading
import time
import warnings
from typing import Any, Final, final

import mujoco

from sims.view.caption import Caption
from sims.view.jogger import Jogger
from sims.view.overlay import Frame, World
from sims.view.painting import paint
from wbc.errors import WbcError

__all__ = ["KEYS", "NoWindow", "Restart", "Window", "WindowClosed", "need_display"]

FRAME: Final = 1.0 / 60.0
LONGEST: Final = 0.25
"""Least and greatest time between two pictures [s]."""
WORDS: Final = 0.1
"""Between two changes of the words [s]."""
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
        self._written, self._write_at = (False, "", ""), 0.0
        self._due, self._shown = world.data.time, (world.data.time, time.perf_counter())
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
        if self._data.time < self._shown[0]:
            self._due = self._data.time
        return bool(self._data.time >= self._due)

    def show(self, frame: Frame) -> None:
        """Show it in real time; while it is paused, do not return.

        Where drawing is slow, pictures are left out rather than time stretched.

        Raises:
            Restart: the operator wants the run from its start.
            WindowClosed: the window is gone.
        """
        t, then = self._data.time, self._shown
        ahead = (t - then[0]) - (time.perf_counter() - then[1])
        time.sleep(min(max(ahead, 0.0), LONGEST))
        self._shown = t, time.perf_counter()
        self._draw(frame)
        taken = time.perf_counter() - self._shown[1]
        self._due = t + min(max(FRAME, taken), LONGEST)
        while self._paused and self._window.is_running() and not self._restart:
            time.sleep(FRAME)
            self._draw(frame)
            self._shown = t, time.perf_counter()
        if not self._window.is_running():
            raise WindowClosed
        if self._restart:
            self._restart = self._paused = False
            raise Restart

    def _draw(self, frame: Frame) -> None:
        """Hand the state and its overlay over to the window's own thread."""
        scene = self._window.user_scn
        with self._window.lock():
            scene.ngeom = 0
            paint(scene, frame.marks)
        self._write(frame.words)
        before = self._data.time
        self._window.sync()
        if self._data.time < before:  # its own reset button wipes the state
            self._restart = True

    def _write(self, words: Caption) -> None:
        """Not at every picture: this waits until the one before has been drawn."""
        left, right = words
        if self._paused:
            left, right = f"paused\n{left}", f"\n{right}"
        now, written = time.perf_counter(), (self._paused, left, right)
        rested = now >= self._write_at or self._paused != self._written[0]
        if not rested or written == self._written:
            return
        corner, font = mujoco.mjtGridPos.mjGRID_TOPLEFT, mujoco.mjtFont.mjFONT_NORMAL
        self._window.set_texts((font, corner, left, right))
        end = time.perf_counter()
        self._written, self._write_at = written, end + max(WORDS, 2.0 * (end - now))

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
        raise NoWindow(
            _reason(str(said[-1].message)) if said else "GLFW does not start"
        )


def _reason(said: str) -> str:
    """GLFW's words without its number: "(65550) b'X11: Failed ...'"."""
    return said.partition(") ")[2].strip("b'\"") or said
