"""An axis of a frame along a direction; rotation about the axis stays free."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.geometry import perpendicular
from tasks.path import Path, PathPoint
from wbc import PD, FrameState, MotionTask, Rows, State
from wbc.arrays import Array, frozen, unit
from wbc.errors import InputError
from wbc.linalg import cross

__all__ = ["AxisAlignment", "AxisAlongPath"]

STILL = np.zeros(3)
ROWS = ("tilt 1", "tilt 2")


@final
class AxisAlignment(MotionTask):
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
        super().__init__(name or f"{frame} axis", "rad", ROWS, law, (frame,))
        self._triad = triad(axis, self.name)
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
        self._n, self._omega, self._alpha = n, omega, alpha

    def evaluate(self, state: State, out: Rows) -> None:
        """Write the rows."""
        F = state.frame(self.frames[0])
        B = (F.R @ self._triad[1:].T).T
        out.error[:] = -B @ rotation_between(F.R @ self._triad[0], self._n, B[0])
        out.J[:] = B @ F.J[3:]
        out.rate[:] = -B @ self._omega
        swept = cross(F.V[3:], self._omega)
        out.drift[:] = B @ (F.drift[3:] - self._alpha + swept)


@final
class AxisAlongPath(MotionTask):
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
        super().__init__(name or f"{frame} along path", "rad", ROWS, law, (frame,))
        self._triad, self.path = triad(axis, self.name), path
        if not np.isfinite([work, travel]).all():
            raise InputError(f"angles of '{self.name}' must be finite.")
        self.work, self.travel = float(work), float(travel)

    def direction_at(self, point: PathPoint) -> Array:
        """The direction and two derivatives by s at a point of the path, (3, 3)."""
        m = np.cos(self.work) * point.n1[:3] + np.sin(self.work) * point.n2[:3]
        return -np.cos(self.travel) * m + np.sin(self.travel) * point.c[1:]  # type: ignore[no-any-return]

    def evaluate(self, state: State, out: Rows) -> None:
        """Write the rows."""
        F: FrameState = state.frame(self.frames[0])
        along = self.path.follow(state, self.frames[0])
        d, slope, bend = self.direction_at(along.point)
        B = (F.R @ self._triad[1:].T).T
        turn = cross(d, slope)
        omega = turn * along.rate
        out.error[:] = -B @ rotation_between(F.R @ self._triad[0], d, B[0])
        out.J[:] = B @ (F.J[3:] - np.outer(turn, along.J))
        alpha = cross(d, bend) * along.rate**2 + turn * along.drift
        out.drift[:] = B @ (F.drift[3:] - alpha + cross(F.V[3:], omega))


def triad(axis: ArrayLike, task: str) -> Array:
    """An axis and two directions across it, (3, 3), one a row."""
    a = unit(axis, f"axis of '{task}'")
    return np.vstack([a, perpendicular(a)])


def rotation_between(a: Array, n: Array, spare: Array) -> Array:
    """Rotation vector (3,) [rad] of the shortest turn from a to n, unit vectors.

    Args:
        a: (3,) from.
        n: (3,) to.
        spare: (3,) unit vector across a, the axis where n = -a.
    """
    axis = cross(a, n)
    sine, cosine = float(np.linalg.norm(axis)), float(a @ n)
    angle = np.arctan2(sine, cosine)
    if sine > 1e-12:
        return axis * (angle / sine)  # type: ignore[no-any-return]
    return spare * angle if cosine < 0.0 else axis
