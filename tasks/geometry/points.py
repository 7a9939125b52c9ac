"""A point on a point, a line, a plane, a circle, a cylinder."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.geometry.constraint import Constraint, as_point, relation
from tasks.geometry.features import (
    Carrier,
    Circle,
    Cylinder,
    Line,
    Plane,
    Point,
    perpendicular,
)
from tasks.geometry.moving import MovingFrame
from wbc.checks import expect, named

__all__ = [
    "PointOnCircle",
    "PointOnCylinder",
    "PointOnLine",
    "PointOnPlane",
    "PointOnPoint",
    "carrier_name",
]


@final
class PointOnPoint(Constraint):
    """A point on a point: three rows [m], rank 3; orientation stays free.

    The rows are along the axes of the second point's carrier.

    Args:
        point: the first; a frame's name means its origin.
        target: the second; three numbers mean a point of the world.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> on point" by default.

    Raises:
        InputError: unusable points or gains.
    """

    ROWS = (("x", "m"), ("y", "m"), ("z", "m"))

    def __init__(
        self,
        point: str | Point,
        target: Point | ArrayLike,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        a = as_point(point)
        name = named(name, f"{carrier_name(a.on)} on point")
        b = as_point(target, f"target point of '{name}'")
        p = relation(point=a.position, origin=b.position, along=tuple(np.eye(3)))
        super().__init__(a.on, b.on, p, name, stiffness, damping)


@final
class PointOnLine(Constraint):
    """A point on a line: two rows across it [m], rank 2; along it is free.

    Args:
        point: the point; a frame's name means its origin.
        line: the line; a length, if it has one, does not matter here.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> on line" by default.

    Raises:
        InputError: unusable features or gains.
    """

    ROWS = (("across 1", "m"), ("across 2", "m"))

    def __init__(
        self,
        point: str | Point,
        line: Line,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        expect(Line, line=line)
        a = as_point(point)
        name = named(name, f"{carrier_name(a.on)} on line")
        p = relation(point=a.position, origin=line.point, along=tuple(line.normals))
        super().__init__(a.on, line.on, p, name, stiffness, damping)


@final
class PointOnPlane(Constraint):
    """A point on a plane: one row [m], rank 1; P4 eq. (10) with its sign mended.

    Args:
        point: the point; a frame's name means its origin.
        plane: the plane.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> on plane" by default.

    Raises:
        InputError: unusable features or gains.
    """

    ROWS = (("normal", "m"),)

    def __init__(
        self,
        point: str | Point,
        plane: Plane,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        expect(Plane, plane=plane)
        a = as_point(point)
        name = named(name, f"{carrier_name(a.on)} on plane")
        p = relation(point=a.position, origin=plane.point, along=(plane.normal,))
        super().__init__(a.on, plane.on, p, name, stiffness, damping)


@final
class PointOnCircle(Constraint):
    """A point on a circle: out of its plane and off its radius [m], rank 2.

    On the circle's axis the second row has no slope of its own and one direction is
    taken.

    Args:
        point: the point; a frame's name means its origin.
        circle: the circle.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> on circle" by default.

    Raises:
        InputError: unusable features or gains.
    """

    ROWS = (("normal", "m"), ("radius", "m"))

    def __init__(
        self,
        point: str | Point,
        circle: Circle,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        expect(Circle, circle=circle)
        a, n = as_point(point), circle.normal
        name = named(name, f"{carrier_name(a.on)} on circle")
        p = relation(
            point=a.position,
            origin=circle.centre,
            along=(n,),
            apart=tuple(perpendicular(n)),
            distance=circle.radius,
        )
        super().__init__(a.on, circle.on, p, name, stiffness, damping)


@final
class PointOnCylinder(Constraint):
    """A point on a cylinder's mantle, of any length: one row [m], rank 1.

    On the axis the row has no slope of its own and one direction is taken.

    Args:
        point: the point; a frame's name means its origin.
        cylinder: the cylinder.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> on cylinder" by default.

    Raises:
        InputError: unusable features or gains.
    """

    ROWS = (("radius", "m"),)

    def __init__(
        self,
        point: str | Point,
        cylinder: Cylinder,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        expect(Cylinder, cylinder=cylinder)
        a = as_point(point)
        name = named(name, f"{carrier_name(a.on)} on cylinder")
        p = relation(
            point=a.position,
            origin=cylinder.top,
            apart=tuple(perpendicular(cylinder.direction)),
            distance=cylinder.radius,
        )
        super().__init__(a.on, cylinder.on, p, name, stiffness, damping)


def carrier_name(carrier: Carrier) -> str:
    """What reports call it."""
    if isinstance(carrier, MovingFrame):
        return carrier.name
    return carrier or "world"
