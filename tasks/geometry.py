"""Points, lines and planes in the world, and a point of the robot held on them."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.base import CatalogueTask
from tasks.evaluator import Code
from tasks.path import Path
from wbc import PD, Robot
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
        header = np.array([0.0, self.length, 0.0, 0.0])
        parts = [header, self.point, self.direction, self.normals.ravel()]
        self.table = frozen(np.concatenate(parts), (16,), "the line", finite=False)

    @classmethod
    def between(cls, start: ArrayLike, end: ArrayLike) -> Line:
        """The segment from start (3,) to end (3,) [m].

        Raises:
            InputError: the two coincide.
        """
        a, b = frozen(start, (3,), "start"), frozen(end, (3,), "end")
        return cls(a, b - a, float(np.linalg.norm(b - a)) or None)


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
class PointOnPoint(CatalogueTask):
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

    code = Code.ON_POINT

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

    def parameters(self, robot: Robot) -> Array:
        """The point, at rest (9,)."""
        del robot
        return np.concatenate([self.point, np.zeros(6)])


@final
class PointOnLine(CatalogueTask):
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

    code = Code.ON_LINE

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

    def parameters(self, robot: Robot) -> Array:
        """Point and two normals (9,)."""
        del robot
        return np.concatenate([self.line.point, self.line.normals.ravel()])


@final
class PointOnPlane(CatalogueTask):
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

    code = Code.ON_PLANE

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

    def parameters(self, robot: Robot) -> Array:
        """Point and normal (6,)."""
        del robot
        return np.concatenate([self.plane.point, self.plane.normal])
