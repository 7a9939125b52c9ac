"""An axis of a frame along a direction; rotation about the axis stays free."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.base import CatalogueTask
from tasks.evaluator import Code
from tasks.geometry.features import perpendicular
from tasks.kernels.paths import direction as path_direction
from tasks.path import Path, PathPoint, still
from wbc import PD, Robot
from wbc.arrays import Array, frozen, number, unit
from wbc.checks import named

__all__ = ["AxisAlignment", "AxisAlongPath"]

STILL = np.zeros(3)
ROWS = ("tilt 1", "tilt 2")


@final
class AxisAlignment(CatalogueTask):
    """An axis a of frame F along a direction n: two rows [rad].

    e = -(rotation vector from a to n), on two body-fixed directions across a, so
    that turning about a is free at any misalignment. P4 eq. (13) with its axis
    mended; at exactly half a turn any perpendicular axis serves, and one is taken.

    Args:
        frame: name of the robot's frame.
        direction: (3,) n in the world.
        axis: (3,) a in F's own axes; its z axis by default.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> axis" by default.

    Raises:
        InputError: a zero direction or axis, or unusable gains.
    """

    code = Code.ALONG

    def __init__(
        self,
        frame: str,
        direction: ArrayLike,
        *,
        axis: ArrayLike = (0.0, 0.0, 1.0),
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        law = PD(stiffness, damping)
        super().__init__(named(name, f"{frame} axis"), "rad", ROWS, law, (frame,))
        self._parameters = np.zeros(18)
        self._parameters[:9] = triad(axis, self.name)
        self.set_target(direction)

    def set_target(
        self,
        direction: ArrayLike,
        velocity: ArrayLike = STILL,
        acceleration: ArrayLike = STILL,
    ) -> None:
        """Turn the direction; angular velocity and acceleration in world axes.

        Raises:
            InputError: unusable values; the target stays as it was.
        """
        n = unit(direction, f"direction of '{self.name}'")
        omega = frozen(velocity, (3,), f"target velocity of '{self.name}'")
        alpha = frozen(acceleration, (3,), f"target acceleration of '{self.name}'")
        self._parameters[9:] = np.concatenate([n, omega, alpha])

    def parameters(self, robot: Robot) -> Array:
        """Axis and two directions across it, target, its motion (18,), live."""
        del robot
        return self._parameters


@final
class AxisAlongPath(CatalogueTask):
    """An axis of F at fixed angles to the path that F's origin travels, two rows [rad].

    The direction is d(s) = -cos(travel) m(s) + sin(travel) t(s), with t the tangent
    and m = cos(work) n1 + sin(work) n2 from the path's normals: for a welding torch
    whose axis points at the work, `work` is the work angle from the first normal
    and a positive `travel` pushes. s is the nearest point, so the feed-forward is
    part of Jacobian and drift.

    Args:
        frame: name of the robot's frame.
        path: the path.
        work: [rad].
        travel: [rad].
        axis: (3,) in F's own axes; its z axis by default.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> along path" by default.

    Raises:
        InputError: an angle that is not finite, a zero axis, or unusable gains.
    """

    code = Code.ALONG_PATH

    def __init__(
        self,
        frame: str,
        path: Path,
        *,
        work: float = 0.0,
        travel: float = 0.0,
        axis: ArrayLike = (0.0, 0.0, 1.0),
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        law = PD(stiffness, damping)
        super().__init__(named(name, f"{frame} along path"), "rad", ROWS, law, (frame,))
        self._triad, self.path = triad(axis, self.name), still(path, self.name)
        self.work = number(work, f"work angle of '{self.name}'")
        self.travel = number(travel, f"travel angle of '{self.name}'")

    def direction_at(self, point: PathPoint) -> Array:
        """The direction and two derivatives by s at a point of the path, (3, 3)."""
        d = np.zeros(9)
        path_direction(point.rows, self.work, self.travel, d)
        return d.reshape(3, 3)

    def parameters(self, robot: Robot) -> Array:
        """Axis and two directions across it, work and travel angle (11,)."""
        del robot
        return np.append(self._triad, [self.work, self.travel])

    def table(self, robot: Robot) -> Array:
        """The path."""
        del robot
        return self.path.table


def triad(axis: ArrayLike, task: str) -> Array:
    """An axis and two directions across it, (9,), one after the other."""
    a = unit(axis, f"axis of '{task}'")
    return np.concatenate([a, perpendicular(a).ravel()])
