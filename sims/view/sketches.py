"""Marks that belong together: an error, a direction, axes, a plane, a circle, a way."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import numpy as np

from sims.view.marks import (
    AXES,
    DOT,
    MET_ANGLE,
    MET_LENGTH,
    TARGET,
    THIN,
    Colour,
    Connector,
    Mark,
    Solid,
    arrow,
    ball,
    faint,
    line,
    shade,
)
from tasks.geometry.features import perpendicular
from wbc.arrays import Array

__all__ = [
    "angle_of",
    "chain",
    "long_line",
    "missed",
    "pointing",
    "ring",
    "sheet",
    "triad",
    "tube",
]

LONG: Final = 0.25
"""Half of what is shown of an endless line [m]."""
PIECE: Final = 0.10
"""Half of what is shown of an endless plane, and of a cylinder's length [m]."""
SHAFT: Final = 0.14
"""Half the length of an arrow that shows a direction [m]."""
AXIS: Final = 0.12
"""Length of the axes of a frame [m]."""
SIDES: Final = 40
"""Of a circle."""


def missed(actual: Array, wanted: Array) -> list[Mark]:
    """An error: from where a point is to where it should be, both (3,) [m]."""
    colour = shade(float(np.linalg.norm(wanted - actual)), MET_LENGTH)
    return [line(actual, wanted, colour, 1.2 * THIN), ball(actual, colour, 1.2 * DOT)]


def pointing(p: Array, actual: Array, wanted: Array, error: float) -> list[Mark]:
    """Two directions (3,) at p (3,), the actual one coloured by an error [rad].

    Their arrows go through the point, so that one end is out of the tool.
    """
    return [
        arrow(p - SHAFT * wanted, p + SHAFT * wanted, TARGET, radius=THIN),
        arrow(
            p - SHAFT * actual, p + SHAFT * actual, shade(error, MET_ANGLE), radius=THIN
        ),
    ]


def triad(p: Array, R: Array, opacity: float = 1.0) -> list[Mark]:
    """The axes R (3, 3) of a frame at p (3,)."""
    return [arrow(p, p + AXIS * R[:, i], faint(AXES[i], opacity)) for i in range(3)]


def long_line(p: Array, direction: Array) -> Connector:
    """A piece around p (3,) of an endless line that is wanted."""
    return line(p - LONG * direction, p + LONG * direction, TARGET)


def sheet(p: Array, normal: Array) -> Solid:
    """A piece around p (3,) of a plane that is wanted."""
    size = np.array([PIECE, PIECE, 5e-4])
    return Solid("box", p, size, faint(TARGET), _upright(normal))


def tube(p: Array, axis: Array, radius: float) -> Solid:
    """A piece around p (3,), on its axis, of a cylinder that is wanted."""
    size = np.array([radius, PIECE, 0.0])
    return Solid("tube", p, size, faint(TARGET), _upright(axis))


def ring(centre: Array, normal: Array, radius: float) -> list[Mark]:
    """A circle that is wanted."""
    angle = np.linspace(0.0, 2.0 * np.pi, SIDES + 1)
    u, v = perpendicular(normal)
    way = np.outer(np.cos(angle), u) + np.outer(np.sin(angle), v)
    return chain(centre + radius * way, TARGET)


def chain(points: Array, colour: Colour, radius: float = THIN) -> list[Mark]:
    """A line through points (k, 3)."""
    return [line(a, b, colour, radius) for a, b in pairwise(points)]


def angle_of(a: Array, b: Array) -> float:
    """Between two unit vectors (3,) [rad]."""
    return float(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))


def _upright(axis: Array) -> Array:
    """A rotation (3, 3) whose z axis is a unit vector (3,)."""
    return np.column_stack([*perpendicular(axis), axis])
