"""A live window on a cell, with keys to jog; headless where there is no display."""

from __future__ import annotations

import sys
import time
import warnings
from typing import Any, final

import mujoco
import numpy as np
import pinocchio as pin

from sims.cell import Cell
from tasks import FrameOrientation
from wbc import Solution
from wbc.arrays import Array

__all__ = ["Jogger", "Viewer", "open_viewer"]

STEP = 0.05
"""Turn of one key press [rad]."""
BLEND = 6.0
"""How fast the target follows the keys [1/s]."""
FRAME = 1.0 / 60.0

KEYS = {
    265: (0, 1.0),
    264: (0, -1.0),
    263: (1, 1.0),
    262: (1, -1.0),
    266: (2, 1.0),
    267: (2, -1.0),
}
"""GLFW key codes: arrows turn about the tool's x and y, page keys about its z."""


@final
class Jogger:
    """Turns key presses into a smooth orientation target.

    The target follows the keyed angles as a critically damped second-order system, so
    its velocity and acceleration are known and no press makes a jump.
    """

    def __init__(self) -> None:
        self._wanted = np.zeros(3)
        self._angle, self._rate = np.zeros(3), np.zeros(3)
        self._R, self._t = np.eye(3), 0.0

    def begin(self, R: Array) -> None:
        """Take R (3, 3) as the orientation without any key pressed."""
        self._R = R.copy()

    def press(self, key: int) -> None:
        """Take a key press; other keys do nothing."""
        if key in KEYS:
            axis, sign = KEYS[key]
            self._wanted[axis] += sign * STEP

    def script(self, task: FrameOrientation, t: float) -> None:
        """Move the task's target to time t [s]; t = 0 starts afresh."""
        if t < self._t:
            self._wanted[:] = self._angle[:] = self._rate[:] = 0.0
        dt, self._t = max(t - self._t, 0.0), t
        pull = BLEND**2 * (self._wanted - self._angle) - 2.0 * BLEND * self._rate
        self._rate += dt * pull
        self._angle += dt * self._rate
        R = self._R @ pin.exp3(self._angle)
        omega = R @ (pin.Jexp3(self._angle) @ self._rate)
        task.set_target(R, omega, R @ (pin.Jexp3(self._angle) @ pull))


@final
class Viewer:
    """MuJoCo's passive viewer, fed at 60 frames a second in real time.

    Space pauses, the arrow and page keys jog. Closing the window ends the run.
    """

    def __init__(self, cell: Cell, camera: mujoco.MjvCamera | None = None) -> None:
        import mujoco.viewer  # opens the window system, which a headless run lacks

        self.jogger = Jogger()
        self._paused, self._due = False, 0.0
        self._window: Any = mujoco.viewer.launch_passive(
            cell.model,
            cell.data,
            key_callback=self._key,
            show_left_ui=False,
            show_right_ui=False,
        )
        if camera is not None:
            with self._window.lock():
                view = self._window.cam
                view.lookat[:], view.distance = camera.lookat, camera.distance
                view.azimuth, view.elevation = camera.azimuth, camera.elevation

    def _key(self, key: int) -> None:
        if key == ord(" "):
            self._paused = not self._paused
        else:
            self.jogger.press(key)

    def __call__(self, cell: Cell, solution: Solution) -> bool:
        """Show the tick when a frame is due, and keep real time."""
        del solution
        if cell.data.time < self._due - FRAME:
            self._due = 0.0
        if cell.data.time < self._due:
            return bool(self._window.is_running())
        self._due = cell.data.time + FRAME
        began = time.perf_counter()
        self._window.sync()
        while self._paused and self._window.is_running():
            time.sleep(FRAME)
        time.sleep(max(0.0, FRAME - (time.perf_counter() - began)))
        return bool(self._window.is_running())

    def close(self) -> None:
        """Close the window."""
        self._window.close()


def open_viewer(cell: Cell, camera: mujoco.MjvCamera | None = None) -> Viewer | None:
    """A window on the cell, or None with a word on standard error where none opens."""
    try:
        _need_display()
        return Viewer(cell, camera)
    except (ImportError, RuntimeError) as error:
        sys.stderr.write(f"wbc: no display for --view ({error}); running headless\n")
        return None


def _need_display() -> None:
    """Ask GLFW first: MuJoCo's viewer ends the whole process where GLFW fails."""
    import glfw

    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        ready = glfw.init()
    if not ready:
        reason = str(said[-1].message) if said else "GLFW does not start"
        raise RuntimeError(reason)
