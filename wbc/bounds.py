"""Which inequality rows are at a bound."""

from __future__ import annotations

from wbc.arrays import Array, BoolArray
from wbc.compiled import compiled
from wbc.vectors import dot

__all__ = ["at_bounds"]

AT_BOUND = 1e-7
"""A row this close to a bound, relative to 1 + its value, is at it."""


@compiled
def at_bounds(A: Array, x: Array, lower: Array, upper: Array, found: BoolArray) -> bool:
    """Whether any row of lower <= A x <= upper is at a bound or beyond it.

    Args:
        A: (m, n) rows.
        x: (n,) the point.
        lower: (m,) bounds.
        upper: (m,) bounds.
        found: (m,) is written, row by row; never true for equalities.
    """
    some = False
    for r in range(lower.size):
        value = dot(A[r], x, 0, x.size)
        near = AT_BOUND * (1.0 + abs(value))
        at = value > upper[r] - near or value < lower[r] + near
        found[r] = at and lower[r] < upper[r]
        some = some or found[r]
    return some
