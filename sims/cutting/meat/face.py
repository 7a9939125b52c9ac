"""Where the face of a muscle is now, and how deep a knife has left it for the flesh."""

from __future__ import annotations

from typing import NamedTuple, final

import numpy as np

from wbc.arrays import Array
from wbc.compiled import compiled, inner

__all__ = ["Face", "Wound"]


class Wound(NamedTuple):
    """The knife in a muscle.

    Attributes:
        inside: how far the tip is behind the muscle's face, along y [m].
        depth: of the tip below the muscle's top [m].
        nearest: index of the material point next to it.
        above: number of material points in line above that one.
    """

    inside: float
    depth: float
    nearest: int
    above: int


@final
class Face:
    """The face that a muscle turns to the seam, through the ends of the links.

    Args:
        grid: (nu, nw) of the points.
        thickness: (N,) of the muscle behind them, along y [m].
        sign: +1 if the muscle lies at greater y, -1 if at lesser.
    """

    def __init__(self, grid: tuple[int, int], thickness: Array, sign: int) -> None:
        self._grid, self._thickness, self._sign = grid, thickness, sign

    def wound(self, points: Array, tip: Array) -> Wound | None:
        """How the tip (3,) is in the muscle with face points (N, 3); None if it is not.

        The face is taken as flat between a point and its neighbours.
        """
        within, beyond, depth, nearest = below(points, self._grid, tip)
        inside = self._sign * beyond
        if not (within and 0.0 < inside < self._thickness[nearest]):
            return None
        above = self._grid[1] - 1 - nearest % self._grid[1]
        return Wound(inside, depth, nearest, above)


@compiled
def below(
    points: Array, grid: tuple[int, int], tip: Array
) -> tuple[bool, float, float, int]:
    """Place of a tip (3,) on a face through points (N, 3) in a grid.

    Returns:
        Whether it is between the ends and below the top of the face, how far it is
        beyond the face along y [m], its depth below the top [m], and the index of the
        point next to it.
    """
    nu, nw = grid
    nearest, least = 0, np.inf
    for k in range(points.shape[0]):
        away = (points[k, 0] - tip[0]) ** 2 + (points[k, 2] - tip[2]) ** 2
        if away < least:
            nearest, least = k, away
    i, j = nearest // nw, nearest % nw
    low, high = max(i - 1, 0), min(i + 1, nu - 1)
    down, up = max(j - 1, 0), min(j + 1, nw - 1)
    along0, along1, along2 = _slope(points, high * nw + j, low * nw + j, high - low)
    upward0, upward1, upward2 = _slope(points, i * nw + up, i * nw + down, up - down)
    dx, dz = tip[0] - points[nearest, 0], tip[2] - points[nearest, 2]
    determinant = along0 * upward2 - along2 * upward0
    a = (dx * upward2 - dz * upward0) / determinant
    b = (dz * along0 - dx * along2) / determinant
    within = -0.5 <= i + a <= nu - 0.5 and j + b <= nw - 0.5
    face = points[nearest, 1] + a * along1 + b * upward1
    top = points[i * nw + nw - 1, 2] + 0.5 * upward2
    return within, tip[1] - face, top - tip[2], nearest


@inner
def _slope(points: Array, i: int, j: int, steps: int) -> tuple[float, float, float]:
    """From one point to another, per step."""
    return (
        (points[i, 0] - points[j, 0]) / steps,
        (points[i, 1] - points[j, 1]) / steps,
        (points[i, 2] - points[j, 2]) / steps,
    )
