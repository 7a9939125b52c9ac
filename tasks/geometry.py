"""Points, lines and planes in the world, and a point of the robot held on them."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.path import Path, PathPoint
from wbc import PD, MotionTask, Rows, State
from wbc.arrays import Array, frozen, positive, unit

__all__ = ["Line", "Plane", "PointOnLine", "PointOnPlane", "PointOnPoint"]


@final
class Line(Path):
    """A straight line, or a segment of it where it has a length.

    Args:
        point: (3,) where s = 0 [m].
        direction: (3,) along which s grows; need not be of unit length.
        length: of the segment [m]; infinite by default.

    Raises:
        InputError: a zero or infinite direction, a wrong shape, no positive length.
    """

    def __init__(
        self, point: ArrayLike, direction: ArrayLike, length: float | None = None
    ) -> None:
        self.point = frozen(point, (3,), "the line's point")
        self.direction = unit(direction, "the line's direction")
        self.length = np.inf if length is None else positive(length, "length")
        self.normals = perpendicular(self.direction)
        point_rows = np.zeros((4, 9))
        point_rows[0, 3:6], point_rows[0, 6:] = self.normals
        point_rows[1, :3] = self.direction
        self._rows = point_rows

    @classmethod
    def between(cls, start: ArrayLike, end: ArrayLike) -> Line:
        """The segment from start (3,) to end (3,) [m].

        Raises:
            InputError: the two coincide.
        """
        a, b = frozen(start, (3,), "start"), frozen(end, (3,), "end")
        return cls(a, b - a, float(np.linalg.norm(b - a)) or None)

    def locate(self, p: Array) -> float:
        """Position s [m] of the foot of the perpendicular from p (3,)."""
        return float(self.direction @ (p - self.point))

    def at(self, s: float) -> PathPoint:
        """Point and frame at s, which may lie beyond the ends."""
        rows = self._rows.copy()
        rows[0, :3] = self.point + s * self.direction
        return PathPoint(rows)


@final
class Plane:
    """A plane through a point, with a normal.

    Args:
        point: (3,) in the plane [m].
        normal: (3,) need not be of unit length.

    Raises:
        InputError: a zero normal, a wrong shape, or not finite.
    """

    def __init__(self, point: ArrayLike, normal: ArrayLike) -> None:
        self.point = frozen(point, (3,), "the plane's point")
        self.normal = unit(normal, "the plane's normal")

    def distance(self, p: Array) -> float:
        """Signed distance [m] of p (3,), positive on the normal's side."""
        return float(self.normal @ (p - self.point))


def perpendicular(direction: Array) -> Array:
    """Two unit vectors (2, 3) that make a right-handed triad with a unit direction."""
    helper = np.eye(3)[int(np.argmin(np.abs(direction)))]
    first = np.cross(direction, helper)
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(direction, first)])


@final
class PointOnPoint(MotionTask):
    """Origin of a frame on a fixed point, three rows [m]; orientation stays free.

    Args:
        frame: name of the robot's frame.
        point: (3,) in the world [m].
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> on point" by default.

    Raises:
        InputError: unusable point or gains.
    """

    def __init__(
        self,
        frame: str,
        point: ArrayLike,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        law = PD(stiffness, damping)
        super().__init__(
            name or f"{frame} on point", "m", ("x", "y", "z"), law, (frame,)
        )
        self.point = frozen(point, (3,), f"point of '{self.name}'")

    def evaluate(self, state: State, out: Rows) -> None:
        """E = p - p_0."""
        F = state.frame(self.frames[0])
        out.error[:] = F.p - self.point
        out.J[:] = F.J[:3]
        out.drift[:] = F.drift[:3]


@final
class PointOnLine(MotionTask):
    """Origin of a frame on a line, two rows across it [m]; along it is free.

    Args:
        frame: name of the robot's frame.
        line: the line; a length, if it has one, does not matter here.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> on line" by default.

    Raises:
        InputError: unusable gains.
    """

    def __init__(
        self,
        frame: str,
        line: Line,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        law = PD(stiffness, damping)
        rows = ("across 1", "across 2")
        super().__init__(name or f"{frame} on line", "m", rows, law, (frame,))
        self.line = line

    def evaluate(self, state: State, out: Rows) -> None:
        """e_i = n_i . (p - p_0) for two normals of the line."""
        F = state.frame(self.frames[0])
        normals = self.line.normals
        out.error[:] = normals @ (F.p - self.line.point)
        out.J[:] = normals @ F.J[:3]
        out.drift[:] = normals @ F.drift[:3]


@final
class PointOnPlane(MotionTask):
    """Origin of a frame on a plane, one row [m]; P4 eq. (10) with its sign mended.

    Args:
        frame: name of the robot's frame.
        plane: the plane.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> on plane" by default.

    Raises:
        InputError: unusable gains.
    """

    def __init__(
        self,
        frame: str,
        plane: Plane,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        law = PD(stiffness, damping)
        super().__init__(name or f"{frame} on plane", "m", ("normal",), law, (frame,))
        self.plane = plane

    def evaluate(self, state: State, out: Rows) -> None:
        """E = n . (p - p_0)."""
        F = state.frame(self.frames[0])
        out.error[0] = self.plane.distance(F.p)
        out.J[0] = self.plane.normal @ F.J[:3]
        out.drift[0] = self.plane.normal @ F.drift[:3]
