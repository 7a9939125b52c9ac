"""A circle from points on it, as they come: least squares that starts from a belief."""

from __future__ import annotations

from typing import Final, final

import numpy as np

from wbc.arrays import Array, frozen, positive

__all__ = ["CircleFit"]

TRUST: Final = 20.0
"""Points that the belief counts for."""


@final
class CircleFit:
    """The circle x^2 + y^2 = 2 a x + 2 b y + c, fitted point by point (Kasa 1976).

    Coordinates are those from the believed centre, over the believed radius, so that
    the three unknowns are of one size and the belief is (0, 0, 1).

    Args:
        centre: (2,) believed [m].
        radius: believed [m].
        spread: by how much either may be wrong [m].

    Raises:
        InputError: a radius or spread that is not positive, a centre that is not (2,).
    """

    def __init__(self, centre: Array, radius: float, spread: float) -> None:
        self._origin = frozen(centre, (2,), "centre")
        self._scale = positive(radius, "radius")
        doubt = positive(spread, "spread") / self._scale
        belief = np.array([0.0, 0.0, 1.0])
        self._information = TRUST * doubt**2 * np.eye(3)
        self._sum = self._information @ belief
        self._found = belief

    def add(self, point: Array) -> None:
        """Take a point (2,) of the circle [m]."""
        u = (point - self._origin) / self._scale
        row = np.array([2.0 * u[0], 2.0 * u[1], 1.0])
        self._information += np.outer(row, row)
        self._sum += (u @ u) * row
        self._found = np.linalg.solve(self._information, self._sum)

    @property
    def centre(self) -> Array:
        """Of the circle, (2,) [m]."""
        centre: Array = self._origin + self._scale * self._found[:2]
        return centre

    @property
    def radius(self) -> float:
        """Of the circle [m]."""
        a, b, c = self._found
        return float(self._scale * np.sqrt(max(c + a * a + b * b, 0.0)))
