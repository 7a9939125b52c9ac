"""Planes parallel to planes, and on them."""

from __future__ import annotations

from typing import final

from numpy.typing import ArrayLike

from tasks.geometry.constraint import Constraint, Sense, parallel, relation
from tasks.geometry.features import Plane
from tasks.geometry.points import carrier_name
from wbc.checks import expect, named

__all__ = ["ParallelPlanes", "PlaneOnPlane"]


@final
class ParallelPlanes(Constraint):
    """Two planes parallel: two rows of tilt [rad], rank 2.

    Args:
        first: a plane.
        second: another.
        sense: of their normals: "same", "opposite" (faces that meet) or "nearest".
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> parallel planes" by default.

    Raises:
        InputError: unusable features or gains.
        UnknownName: no such sense.
    """

    ROWS = (("tilt 1", "rad"), ("tilt 2", "rad"))

    def __init__(
        self,
        first: Plane,
        second: Plane,
        *,
        sense: Sense = "same",
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        expect(Plane, first=first, second=second)
        name = named(name, f"{carrier_name(first.on)} parallel planes")
        p = relation(direction=parallel(first.normal, second.normal, sense))
        super().__init__(first.on, second.on, p, name, stiffness, damping)


@final
class PlaneOnPlane(Constraint):
    """Two planes coincide: one row along the second's normal [m], two of tilt [rad],
    rank 3.

    Args:
        first: a plane.
        second: another.
        sense: of their normals: "same", "opposite" (faces that meet) or "nearest".
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> plane on plane" by default.

    Raises:
        InputError: unusable features or gains.
        UnknownName: no such sense.
    """

    ROWS = (("normal", "m"), ("tilt 1", "rad"), ("tilt 2", "rad"))

    def __init__(
        self,
        first: Plane,
        second: Plane,
        *,
        sense: Sense = "same",
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        expect(Plane, first=first, second=second)
        name = named(name, f"{carrier_name(first.on)} plane on plane")
        p = relation(
            point=first.point,
            origin=second.point,
            along=(second.normal,),
            direction=parallel(first.normal, second.normal, sense),
        )
        super().__init__(first.on, second.on, p, name, stiffness, damping)
