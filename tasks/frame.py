"""Tasks on the pose of a frame of the robot."""

from __future__ import annotations

from typing import final

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from wbc import PD, MotionTask, Rows, State
from wbc.arrays import Array, frozen, rotation

__all__ = ["FrameOrientation", "FramePose", "FramePosition"]

AXES = ("x", "y", "z")
STILL = np.zeros(3)


@final
class FramePosition(MotionTask):
    """Origin of a frame at a point: e = p_WF - p_d [m].

    Args:
        frame: name of the robot's frame F.
        target: (3,) p_d in the world [m].
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> position" by default.

    Raises:
        InputError: target or gains of the wrong shape, or not finite.
    """

    def __init__(
        self,
        frame: str,
        target: ArrayLike,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        law = PD(stiffness, damping)
        super().__init__(name or f"{frame} position", "m", AXES, law, (frame,))
        self.set_target(target)

    def set_target(
        self,
        target: ArrayLike,
        velocity: ArrayLike = STILL,
        acceleration: ArrayLike = STILL,
    ) -> None:
        """Move the target: position [m], velocity [m/s], acceleration [m/s^2].

        Raises:
            InputError: not of shape (3,) or not finite; the target stays as it was.
        """
        p = frozen(target, (3,), f"target of '{self.name}'")
        pd = frozen(velocity, (3,), f"target velocity of '{self.name}'")
        pdd = frozen(acceleration, (3,), f"target acceleration of '{self.name}'")
        self._p, self._pd, self._pdd = p, pd, pdd

    def evaluate(self, state: State, out: Rows) -> None:
        """Write the rows."""
        F = state.frame(self.frames[0])
        out.error[:] = F.p - self._p
        out.J[:] = F.J[:3]
        out.rate[:] = -self._pd
        out.drift[:] = F.drift[:3] - self._pdd


@final
class FrameOrientation(MotionTask):
    """Orientation of a frame: e = log(R_WF R_d^T) [rad], world axes.

    Its rate is the angular velocity relative to the target's, so the task has no
    singularity; at an error of exactly half a turn it picks one of the two ways.

    Args:
        frame: name of the robot's frame F.
        target: (3, 3) rotation R_d in the world.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> orientation" by default.

    Raises:
        InputError: the target is no rotation, or a gain is unusable.
    """

    def __init__(
        self,
        frame: str,
        target: ArrayLike,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        law = PD(stiffness, damping)
        super().__init__(name or f"{frame} orientation", "rad", AXES, law, (frame,))
        self.set_target(target)

    def set_target(
        self,
        target: ArrayLike,
        velocity: ArrayLike = STILL,
        acceleration: ArrayLike = STILL,
    ) -> None:
        """Turn the target: rotation, angular velocity and acceleration, world axes.

        Raises:
            InputError: unusable values; the target stays as it was.
        """
        R = rotation(target, f"target of '{self.name}'")
        omega = frozen(velocity, (3,), f"target velocity of '{self.name}'")
        alpha = frozen(acceleration, (3,), f"target acceleration of '{self.name}'")
        self._R, self._omega, self._alpha = R, omega, alpha

    def evaluate(self, state: State, out: Rows) -> None:
        """Write the rows."""
        F = state.frame(self.frames[0])
        out.error[:] = orientation_error(F.R, self._R)
        out.J[:] = F.J[3:]
        out.rate[:] = -self._omega
        out.drift[:] = F.drift[3:] - self._alpha


@final
class FramePose(MotionTask):
    """Position and orientation of a frame together, six rows [linear; angular].

    Args:
        frame: name of the robot's frame F.
        position: (3,) p_d [m].
        orientation: (3, 3) R_d.
        stiffness: [1/s^2], one number or one a row.
        damping: [1/s], critical by default.
        name: "<frame> pose" by default.

    Raises:
        InputError: unusable target or gains.
    """

    def __init__(
        self,
        frame: str,
        position: ArrayLike,
        orientation: ArrayLike,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        rows = tuple(f"{kind} {axis}" for kind in ("p", "R") for axis in AXES)
        law = PD(stiffness, damping)
        super().__init__(name or f"{frame} pose", "m, rad", rows, law, (frame,))
        self.set_target(position, orientation)

    def set_target(
        self,
        position: ArrayLike,
        orientation: ArrayLike,
        twist: ArrayLike = np.zeros(6),  # noqa: B008 - never written
        acceleration: ArrayLike = np.zeros(6),  # noqa: B008 - never written
    ) -> None:
        """Move the target; twist and its derivative are [linear; angular], world axes.

        Raises:
            InputError: unusable values; the target stays as it was.
        """
        p = frozen(position, (3,), f"target of '{self.name}'")
        R = rotation(orientation, f"target of '{self.name}'")
        V = frozen(twist, (6,), f"target twist of '{self.name}'")
        A = frozen(acceleration, (6,), f"target acceleration of '{self.name}'")
        self._p, self._R, self._V, self._A = p, R, V, A

    def evaluate(self, state: State, out: Rows) -> None:
        """Write the rows."""
        F = state.frame(self.frames[0])
        out.error[:3] = F.p - self._p
        out.error[3:] = orientation_error(F.R, self._R)
        out.J[:] = F.J
        out.rate[:] = -self._V
        out.drift[:] = F.drift - self._A


def orientation_error(R: Array, R_d: Array) -> Array:
    """Rotation vector (3,) [rad] that turns R_d into R, world axes."""
    return np.array(pin.log3(R @ R_d.T))
