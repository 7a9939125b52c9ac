"""What can be drawn over a scene: solids and connectors, as plain values."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, Literal, TypeAlias, final

import numpy as np

from wbc.arrays import Array

__all__ = [
    "ACTUAL",
    "AXES",
    "FORCE",
    "MET_ANGLE",
    "MET_LENGTH",
    "TARGET",
    "THIN",
    "Colour",
    "Connector",
    "Mark",
    "Solid",
    "arrow",
    "ball",
    "faint",
    "line",
    "shade",
]

Colour: TypeAlias = tuple[float, float, float, float]

TARGET: Final[Colour] = (0.0, 0.45, 0.80, 1.0)
"""Of what is wanted."""
ACTUAL: Final[Colour] = (0.35, 0.35, 0.38, 1.0)
"""Of what is, where nothing is missed by it."""
FORCE: Final[Colour] = (0.60, 0.20, 0.65, 1.0)
"""Of what a sensor feels."""
AXES: Final[tuple[Colour, Colour, Colour]] = (
    (0.80, 0.20, 0.15, 1.0),
    (0.15, 0.60, 0.20, 1.0),
    (0.10, 0.35, 0.80, 1.0),
)
"""Of x, y and z."""
MET: Final = np.array([0.0, 0.62, 0.35])
MISSED: Final = np.array([0.90, 0.10, 0.0])
MET_LENGTH: Final = 1e-3
"""An error up to here is green [m]."""
MET_ANGLE: Final = 1e-2
"""[rad]"""
RANGE: Final = 20.0
"""So many times larger, it is red."""
THIN, DOT = 0.004, 0.010
"""Radii of a line and of a point [m]."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Solid:
    """A body at a place.

    Attributes:
        shape: "ball" (radius), "box" (half lengths) or "tube" (radius, half length).
        p: (3,) its centre [m].
        size: (3,) as the shape reads it [m].
        colour: red, green, blue, opacity.
        R: (3, 3) its axes; a tube is along z.
        label: text beside it.
    """

    shape: Literal["ball", "box", "tube"]
    p: Array
    size: Array
    colour: Colour
    R: Array = field(default_factory=lambda: np.eye(3))
    label: str = ""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Connector:
    """A line or an arrow.

    Attributes:
        shape: which of the two.
        a: (3,) where it begins [m].
        b: (3,) where it ends [m].
        radius: [m].
        colour: red, green, blue, opacity.
        label: text beside it.
    """

    shape: Literal["line", "arrow"]
    a: Array
    b: Array
    radius: float
    colour: Colour
    label: str = ""

    @property
    def length(self) -> float:
        """From end to end [m]."""
        return float(np.linalg.norm(self.b - self.a))


Mark: TypeAlias = Solid | Connector


def ball(p: Array, colour: Colour, radius: float = DOT) -> Solid:
    """A point, or a sphere."""
    return Solid("ball", p, np.full(3, radius), colour)


def line(a: Array, b: Array, colour: Colour, radius: float = THIN) -> Connector:
    """A straight line between two points."""
    return Connector("line", a, b, radius, colour)


def arrow(
    a: Array, b: Array, colour: Colour, label: str = "", radius: float = 1.5 * THIN
) -> Connector:
    """An arrow from a to b."""
    return Connector("arrow", a, b, radius, colour, label)


def faint(colour: Colour, opacity: float = 0.25) -> Colour:
    """The same colour, to look through."""
    return (*colour[:3], opacity)


def shade(error: float, met: float) -> Colour:
    """Green up to an error that counts as met, red from twenty times that on."""
    share = min(math.log(max(abs(error) / met, 1.0)) / math.log(RANGE), 1.0)
    red, green, blue = ((1.0 - share) * MET + share * MISSED).tolist()
    return (red, green, blue, 1.0)
