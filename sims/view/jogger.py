"""An operator's keys as a smooth motion of what a task wants."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeAlias, final

import numpy as np
import pinocchio as pin

from tasks import FrameOrientation, FramePose, FramePosition
from wbc import Hierarchy, Robot
from wbc.arrays import Array

__all__ = ["Jogger"]

Script: TypeAlias = Callable[[float], None]

STEP: Final = 0.05
"""Turn of one key press [rad]."""
REACH: Final = 0.2
"""Way of one key press over its turn [m/rad]: a centimetre."""
BLEND: Final = 6.0
"""How fast the target follows the keys [1/s]."""
KEYS: Final = {
    265: (0, 1.0),
    264: (0, -1.0),
    263: (1, 1.0),
    262: (1, -1.0),
    266: (2, 1.0),
    267: (2, -1.0),
}
"""GLFW key codes: up and down are x, left and right y, page up and down z."""


@final
class Jogger:
    """Turns key presses into a smooth orientation target, or into an added way.

    The target follows the keyed angles as a critically damped second-order system, so
    its velocity and acceleration are known and no press makes a jump.
    """

    def __init__(self) -> None:
        self._R = np.eye(3)
        self._start(0.0)

    def _start(self, t: float) -> None:
        self._wanted, self._t = np.zeros(3), t
        self._angle, self._rate = np.zeros(3), np.zeros(3)

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
            self._start(0.0)
        self._turn(task, self._R, self._advance(t))

    def over(
        self, hierarchy: Hierarchy, robot: Robot, script: Script | None, t: float
    ) -> Script | None:
        """A script that adds the keys to what another one wants, from t [s] on.

        They move the last task of the hierarchy whose target is a position, turn it
        where that is an orientation, and do nothing where there is none such.
        """
        kinds = (FramePosition, FrameOrientation, FramePose)
        able = [task for task in hierarchy.tasks() if isinstance(task, kinds)]
        if not able:
            return script
        task, base = able[-1], able[-1].parameters(robot).copy()
        self._start(t)

        def jogged(t: float) -> None:
            nonlocal base
            _set(task, base)
            if script is not None:
                script(t)
            base = task.parameters(robot).copy()
            pull = self._advance(t)
            if isinstance(task, FrameOrientation):
                self._turn(task, base[:9].reshape(3, 3), pull)
            else:
                added = np.concatenate([self._angle, self._rate, pull])
                _set(task, np.concatenate([base[:9] + REACH * added, base[9:]]))

        return jogged

    def _advance(self, t: float) -> Array:
        """Follow the keys up to t [s]; the acceleration (3,) that it takes."""
        dt, self._t = max(t - self._t, 0.0), t
        pull = BLEND**2 * (self._wanted - self._angle) - 2.0 * BLEND * self._rate
        self._rate = self._rate + dt * pull
        self._angle = self._angle + dt * self._rate
        return pull

    def _turn(self, task: FrameOrientation, base: Array, pull: Array) -> None:
        R = base @ pin.exp3(self._angle)
        omega = R @ (pin.Jexp3(self._angle) @ self._rate)
        task.set_target(R, omega, R @ (pin.Jexp3(self._angle) @ pull))


def _set(task: FramePosition | FrameOrientation | FramePose, p: Array) -> None:
    """Give a task the target that its parameters hold."""
    if isinstance(task, FrameOrientation):
        task.set_target(p[:9].reshape(3, 3), p[9:12], p[12:])
    elif isinstance(task, FramePosition):
        task.set_target(p[:3], p[3:6], p[6:9])
    else:
        twist = np.concatenate([p[3:6], p[18:21]])
        change = np.concatenate([p[6:9], p[21:]])
        task.set_target(p[:3], p[9:18].reshape(3, 3), twist, change)
