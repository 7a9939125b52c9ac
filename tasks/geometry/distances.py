"""A point at a distance from a point, a line, a plane."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.geometry.constraint import Constraint, as_point, relation
from tasks.geometry.features import Line, Plane, Point
from tasks.geometry.points import carrier_name
from wbc.arrays import number, positive
from wbc.checks import expect, named

__all__ = ["DistanceToLine", "DistanceToPlane", "DistanceToPoint"]


@final
class DistanceToPoint(Constraint):
    """A point at a distance from another: one row [m], rank 1.

    Where the two coincide the row has no slope of its own and one direction is taken.
    For a distance of 0 use `PointOnPoint`, whose three rows are smooth there.

    Args:
        point: the first; a frame's name means its origin.
        target: the second; three numbers mean a point of the world.
        distance: [m], greater than 0.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> distance to point" by default.

    Raises:
        InputError: unusable points, distance or gains.
    """

    ROWS = (("distance", "m"),)

    def __init__(
        self,
        point: str | Point,
        target: Point | ArrayLike,
        distance: float,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        a = as_point(point)
        name = named(name, f"{carrier_name(a.on)} distance to point")
        b = as_point(target, f"target point of '{name}'")
        p = relation(
            point=a.position,
            origin=b.position,
            apart=tuple(np.eye(3)),
            distance=positive(distance, f"distance of '{name}'"),
        )
        super().__init__(a.on, b.on, p, name, stiffness, damping)


@final
class DistanceToLine(Constraint):
    """A point at a distance from a line: one row [m], rank 1.

    On the line the row has no slope of its own and one direction is taken. For a
    distance of 0 use `PointOnLine`, whose two rows are smooth there.

    Args:
        point: the point; a frame's name means its origin.
        line: the line, of any length.
        distance: [m], greater than 0.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> distance to line" by default.

    Raises:
        InputError: unusable features, distance or gains.
    """

    ROWS = (("distance", "m"),)

    def __init__(
        self,
        point: str | Point,
        line: Line,
        distance: float,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        expect(Line, line=line)
        a = as_point(point)
        name = named(name, f"{carrier_name(a.on)} distance to line")
        p = relation(
            point=a.position,
            origin=line.point,
            apart=tuple(line.normals),
            distance=positive(distance, f"distance of '{name}'"),
        )
        super().__init__(a.on, line.on, p, name, stiffness, damping)


@final
class DistanceToPlane(Constraint):
    """A point at a signed distance from a plane: one row [m], rank 1.

    Args:
        point: the point; a frame's name means its origin.
        plane: the plane.
        distance: [m], positive on the normal's side.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> distance to plane" by default.

    Raises:
        InputError: unusable features, distance or gains.
    """

    ROWS = (("distance", "m"),)

    def __init__(
        self,
        point: str | Point,
        plane: Plane,
        distance: float,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        expect(Plane, plane=plane)
        a, n = as_point(point), plane.normal
        name = named(name, f"{carrier_name(a.on)} distance to plane")
        away = number(distance, f"distance of '{name}'")
        origin = plane.point + away * n
        p = relation(point=a.position, origin=origin, along=(n,))
        super().__init__(a.on, plane.on, p, name, stiffness, damping)
