"""Lines on lines, in planes, and at angles to each other."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.geometry.constraint import (
    Constraint,
    Sense,
    angle_between,
    parallel,
    relation,
)
from tasks.geometry.features import Line, Plane
from tasks.geometry.points import carrier_name
from wbc.arrays import number
from wbc.checks import expect, named
from wbc.errors import InputError

__all__ = [
    "AngleBetweenLines",
    "LineInPlane",
    "LineOnLine",
    "ParallelLines",
    "PerpendicularLines",
]


@final
class LineOnLine(Constraint):
    """Two lines coincide: two rows across the second [m], two of tilt [rad], rank 4.

    Turning about the line and shifting along it stay free.

    Args:
        first: a line.
        second: another.
        sense: of their directions: "same", "opposite" or "nearest".
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> line on line" by default.

    Raises:
        InputError: unusable features or gains.
        UnknownName: no such sense.
    """

    ROWS = (("across 1", "m"), ("across 2", "m"), ("tilt 1", "rad"), ("tilt 2", "rad"))

    def __init__(
        self,
        first: Line,
        second: Line,
        *,
        sense: Sense = "same",
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        expect(Line, first=first, second=second)
        name = named(name, f"{carrier_name(first.on)} line on line")
        p = relation(
            point=first.point,
            origin=second.point,
            along=tuple(second.normals),
            direction=parallel(first.direction, second.direction, sense),
        )
        super().__init__(first.on, second.on, p, name, stiffness, damping)


@final
class ParallelLines(Constraint):
    """Two lines parallel: two rows of tilt [rad], rank 2.

    The error is the rotation vector between the two, on directions across the first:
    smooth at every angle but half a turn, where one way round is taken.

    Args:
        first: a line.
        second: another.
        sense: of their directions: "same", "opposite" or "nearest".
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> parallel" by default.

    Raises:
        InputError: unusable features or gains.
        UnknownName: no such sense.
    """

    ROWS = (("tilt 1", "rad"), ("tilt 2", "rad"))

    def __init__(
        self,
        first: Line,
        second: Line,
        *,
        sense: Sense = "same",
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        expect(Line, first=first, second=second)
        name = named(name, f"{carrier_name(first.on)} parallel")
        p = relation(direction=parallel(first.direction, second.direction, sense))
        super().__init__(first.on, second.on, p, name, stiffness, damping)


@final
class PerpendicularLines(Constraint):
    """Directions of two lines at a right angle: one row [rad], rank 1.

    Args:
        first: a line.
        second: another; the two need not meet.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> perpendicular" by default.

    Raises:
        InputError: unusable features or gains.
    """

    ROWS = (("angle", "rad"),)

    def __init__(
        self,
        first: Line,
        second: Line,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        expect(Line, first=first, second=second)
        name = named(name, f"{carrier_name(first.on)} perpendicular")
        turn = angle_between(first.direction, second.direction, 0.5 * np.pi)
        p = relation(direction=turn)
        super().__init__(first.on, second.on, p, name, stiffness, damping)


@final
class AngleBetweenLines(Constraint):
    """Directions of two lines at an angle: one row [rad], rank 1.

    Where they are parallel the row has no slope of its own and one direction is taken.

    Args:
        first: a line.
        second: another; the two need not meet.
        angle: [rad], between 0 and pi; for these two themselves use `ParallelLines`,
            whose two rows are smooth there.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> angle" by default.

    Raises:
        InputError: an angle out of range, unusable features or gains.
    """

    ROWS = (("angle", "rad"),)

    def __init__(
        self,
        first: Line,
        second: Line,
        angle: float,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        expect(Line, first=first, second=second)
        name = named(name, f"{carrier_name(first.on)} angle")
        wanted = number(angle, f"angle of '{name}'")
        if not 0.0 < wanted < np.pi:
            raise InputError(
                f"angle of '{name}' must lie between 0 and pi, got {wanted}: for lines "
                "along each other use ParallelLines, with its sense."
            )
        turn = angle_between(first.direction, second.direction, wanted)
        p = relation(direction=turn)
        super().__init__(first.on, second.on, p, name, stiffness, damping)


@final
class LineInPlane(Constraint):
    """A line in a plane: one row of its point [m], one of its angle [rad], rank 2.

    Args:
        line: the line.
        plane: the plane.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> line in plane" by default.

    Raises:
        InputError: unusable features or gains.
    """

    ROWS = (("normal", "m"), ("angle", "rad"))

    def __init__(
        self,
        line: Line,
        plane: Plane,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        expect(Line, line=line)
        expect(Plane, plane=plane)
        name = named(name, f"{carrier_name(line.on)} line in plane")
        p = relation(
            point=line.point,
            origin=plane.point,
            along=(plane.normal,),
            direction=angle_between(line.direction, plane.normal, 0.5 * np.pi),
        )
        super().__init__(line.on, plane.on, p, name, stiffness, damping)
