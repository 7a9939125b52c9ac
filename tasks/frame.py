"""Tasks on the pose of a frame of the robot."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.base import CatalogueTask
from tasks.evaluator import Code
from tasks.target import ORIGIN, POINT, POSE, STILL, UPRIGHT, take_target
from wbc import PD, Robot
from wbc.arrays import Array
from wbc.checks import named

__all__ = ["FrameOrientation", "FramePose", "FramePosition"]

AXES = ("x", "y", "z")
AT_REST = STILL[:3]


@final
class FramePosition(CatalogueTask):
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

    code = Code.ON_POINT

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
        super().__init__(named(name, f"{frame} position"), "m", AXES, law, (frame,))
        self._parameters = np.zeros(9)
        self.set_target(target)

    def set_target(
        self,
        target: ArrayLike,
        velocity: ArrayLike = AT_REST,
        acceleration: ArrayLike = AT_REST,
    ) -> None:
        """Move the target: position [m], velocity [m/s], acceleration [m/s^2].

        Raises:
            InputError: not of shape (3,) or not finite; the target stays as it was.
        """
        given = (target, UPRIGHT, velocity, acceleration)
        take_target(self.name, POINT, given, self._parameters)

    def parameters(self, robot: Robot) -> Array:
        """Target, its velocity and acceleration (9,), live."""
        del robot
        return self._parameters


@final
class FrameOrientation(CatalogueTask):
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

    code = Code.ORIENTATION

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
        super().__init__(
            named(name, f"{frame} orientation"), "rad", AXES, law, (frame,)
        )
        self._parameters = np.zeros(15)
        self.set_target(target)

    def set_target(
        self,
        target: ArrayLike,
        velocity: ArrayLike = AT_REST,
        acceleration: ArrayLike = AT_REST,
    ) -> None:
        """Turn the target: rotation, angular velocity and acceleration, world axes.

        Raises:
            InputError: unusable values; the target stays as it was.
        """
        given = (ORIGIN, target, velocity, acceleration)
        take_target(self.name, POINT, given, self._parameters)

    def parameters(self, robot: Robot) -> Array:
        """Target (9,), its angular velocity and acceleration, live."""
        del robot
        return self._parameters


@final
class FramePose(CatalogueTask):
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

    code = Code.POSE

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
        super().__init__(named(name, f"{frame} pose"), "m, rad", rows, law, (frame,))
        self._parameters = np.zeros(24)
        self.set_target(position, orientation)

    def set_target(
        self,
        position: ArrayLike,
        orientation: ArrayLike,
        twist: ArrayLike = STILL,
        acceleration: ArrayLike = STILL,
    ) -> None:
        """Move the target; twist and its derivative are [linear; angular], world axes.

        Raises:
            InputError: unusable values; the target stays as it was.
        """
        given = (position, orientation, twist, acceleration)
        take_target(self.name, POSE, given, self._parameters)

    def parameters(self, robot: Robot) -> Array:
        """Those of `FramePosition`, then those of `FrameOrientation`, live."""
        del robot
        return self._parameters
