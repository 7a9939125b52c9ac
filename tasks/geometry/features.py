"""Points, lines, planes, circles and cylinders, fixed in a frame of any kind."""

from __future__ import annotations

from typing import TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike

from tasks.geometry.moving import MovingFrame
from tasks.path import Path
from wbc.arrays import Array, frozen, positive, unit
from wbc.errors import InputError, shown

__all__ = [
    "Carrier",
    "Circle",
    "Cylinder",
    "Line",
    "Plane",
    "Point",
    "perpendicular",
]

Carrier: TypeAlias = str | MovingFrame | None
"""What a feature is fixed in: a frame of the robot by its name, a frame that moves by
itself, or the world (None). The feature's coordinates are in its axes."""


@final
class Point:
    """A point.

    Args:
        position: (3,) in its carrier's axes [m].
        on: its carrier.

    Raises:
        InputError: a wrong shape, not finite, or no carrier.
    """

    def __init__(
        self, position: ArrayLike = (0.0, 0.0, 0.0), *, on: Carrier = None
    ) -> None:
        self.position = frozen(position, (3,), "the point's position")
        self.on = _carrier(on, "point")


@final
class Line(Path):
    """A straight line, or a segment of it where it has a length; an axis.

    Args:
        point: (3,) where s = 0, in its carrier's axes [m].
        direction: (3,) along which s grows; need not be of unit length.
        length: of the segment [m]; infinite by default. Constraints see the whole line.
        on: its carrier.

    Raises:
        InputError: a zero or infinite direction, a wrong shape, no positive length, or
            no carrier.
    """

    on: Carrier

    def __init__(
        self,
        point: ArrayLike,
        direction: ArrayLike,
        length: float | None = None,
        *,
        on: Carrier = None,
    ) -> None:
        self.point = frozen(point, (3,), "the line's point")
        self.direction = unit(direction, "the line's direction")
        self.length = np.inf if length is None else positive(length, "length")
        self.normals = perpendicular(self.direction)
        header = np.array([0.0, self.length, 0.0, 0.0])
        parts = [header, self.point, self.direction, self.normals.ravel()]
        self.table = frozen(np.concatenate(parts), (16,), "the line", finite=False)
        self.on = _carrier(on, "line")

    @classmethod
    def between(cls, start: ArrayLike, end: ArrayLike, *, on: Carrier = None) -> Line:
        """The segment from start (3,) to end (3,) [m].

        Raises:
            InputError: the two coincide.
        """
        a, b = frozen(start, (3,), "start"), frozen(end, (3,), "end")
        return cls(a, b - a, float(np.linalg.norm(b - a)) or None, on=on)


@final
class Plane:
    """A plane through a point, with a normal.

    Args:
        point: (3,) in the plane, in its carrier's axes [m].
        normal: (3,) need not be of unit length.
        on: its carrier.

    Raises:
        InputError: a zero normal, a wrong shape, not finite, or no carrier.
    """

    def __init__(
        self, point: ArrayLike, normal: ArrayLike, *, on: Carrier = None
    ) -> None:
        self.point = frozen(point, (3,), "the plane's point")
        self.normal = unit(normal, "the plane's normal")
        self.on = _carrier(on, "plane")

    def distance(self, p: ArrayLike) -> float:
        """Signed distance [m] of p (3,), positive on the normal's side.

        Raises:
            InputError: p is not of shape (3,), or not finite.
        """
        return float(self.normal @ (frozen(p, (3,), "p") - self.point))


@final
class Circle:
    """A circle in space.

    Args:
        centre: (3,) in its carrier's axes [m].
        normal: (3,) of its plane; need not be of unit length.
        radius: [m].
        on: its carrier.

    Raises:
        InputError: a zero normal, a radius that is not positive, a wrong shape, or no
            carrier.
    """

    def __init__(
        self,
        centre: ArrayLike,
        normal: ArrayLike,
        radius: float,
        *,
        on: Carrier = None,
    ) -> None:
        self.centre = frozen(centre, (3,), "the circle's centre")
        self.normal = unit(normal, "the circle's normal")
        self.radius = positive(radius, "the circle's radius")
        self.on = _carrier(on, "circle")

    @property
    def axis(self) -> Line:
        """Through the centre, along the normal."""
        return Line(self.centre, self.normal, on=self.on)

    @property
    def plane(self) -> Plane:
        """In which the circle lies."""
        return Plane(self.centre, self.normal, on=self.on)


@final
class Cylinder:
    """An upright or tilted cylinder, known by its top.

    Args:
        top: (3,) centre of its top face, in its carrier's axes [m].
        direction: (3,) along its axis, out of the top face.
        radius: [m].
        on: its carrier.

    Raises:
        InputError: a zero direction, a radius that is not positive, a wrong shape, or
            no carrier.
    """

    def __init__(
        self,
        top: ArrayLike,
        direction: ArrayLike,
        radius: float,
        *,
        on: Carrier = None,
    ) -> None:
        self.top = frozen(top, (3,), "the cylinder's top")
        self.direction = unit(direction, "the cylinder's direction")
        self.radius = positive(radius, "the cylinder's radius")
        self.on = _carrier(on, "cylinder")

    @property
    def axis(self) -> Line:
        """Through the top's centre, along the direction."""
        return Line(self.top, self.direction, on=self.on)

    @property
    def rim(self) -> Circle:
        """The edge of the top face."""
        return Circle(self.top, self.direction, self.radius, on=self.on)


def perpendicular(direction: Array) -> Array:
    """Two unit vectors (2, 3) that make a right-handed triad with a unit direction."""
    helper = np.eye(3)[int(np.argmin(np.abs(direction)))]
    first = np.cross(direction, helper)
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(direction, first)])


def _carrier(on: Carrier, feature: str) -> Carrier:
    if on is None or isinstance(on, str | MovingFrame):
        return on
    raise InputError(
        f"a {feature} is carried by a frame of the robot (its name), by a MovingFrame "
        f"or by the world (None), not by {shown(on)}: on=..."
    )
