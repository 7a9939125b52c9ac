"""The solver's arrays, allocated once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, final

import numpy as np

from wbc.arrays import Array, IntArray
from wbc.compiled import compiled

__all__ = ["EQUALITY", "FREE", "LOWER", "UPPER", "Memory", "Work", "unpack"]

FREE, UPPER, LOWER, EQUALITY = 0, 1, -1, 2
"""Where a row stands: at no bound, at one of them, or both bounds are one."""


class Work(NamedTuple):
    """Everything that a solve writes.

    With Q the product of the reflectors so far, x = Q c; level k owns the coordinates
    c[first[k] : first[k + 1]].

    Attributes:
        start: (p + 1,) first row of every level, and the number of rows.
        level: (m,) level of every row.
        side: (m,) FREE, UPPER, LOWER or EQUALITY: the working set.
        fixed: (m,) rows whose side can no longer change.
        order: (m,) rows of the working set, level by level, pivots first.
        count: (p,) how many of a level's rows are in the working set.
        first: (p + 1,) coordinates taken by the levels before.
        W: (m, n) working rows in the coordinates c.
        V: (n, n) the reflectors' vectors, one a row.
        beta: (n,) and their factors: I - beta v v^T.
        c: (n,) coordinates of the solution.
        x: (n,) the solution.
        target: (n,) where a descent heads.
        slack: (m,) bound - a x of the working rows, 0 for the others.
        bound: (m,) the bound that a working row is held to.
        multiplier: (m,) of the rows above the level that was asked about.
        pull: (n,) force of that level.
        size: (m,) norm of every row.
        rest: (m,) square norm of a row outside the coordinates taken so far.
        square: (m, n + 1) a level's factor, for its least squares.
    """

    start: IntArray
    level: IntArray
    side: IntArray
    fixed: IntArray
    order: IntArray
    count: IntArray  # type: ignore[assignment]  # hides tuple.count
    first: IntArray
    W: Array
    V: Array
    beta: Array
    c: Array
    x: Array
    target: Array
    slack: Array
    bound: Array
    multiplier: Array
    pull: Array
    size: Array
    rest: Array
    square: Array


@final
class Memory:
    """The same arrays end to end in two, because a call is as fast as it is short.

    Args:
        sizes: number of rows of every level.
        n: number of unknowns.

    Attributes:
        floats, integers: everything, in the order of `Work`.
        views: the arrays by name.
    """

    __slots__ = ("floats", "integers", "views")

    def __init__(self, sizes: Sequence[int], n: int) -> None:
        p, m = len(sizes), int(sum(sizes))
        self.floats = np.zeros(2 * m * n + n * n + 5 * n + 6 * m)
        self.integers = np.zeros(2 * (p + 1) + p + 4 * m + 3, np.int_)
        self.integers[:3] = p, m, n
        self.views = unpack(self.floats, self.integers)
        self.views.start[1:] = np.cumsum(np.array(sizes, np.int_))
        self.views.level[:] = np.repeat(np.arange(p), sizes)


@compiled
def unpack(floats: Array, integers: IntArray) -> Work:
    """The arrays of a `Memory`, as views."""
    p, m, n = integers[0], integers[1], integers[2]
    i = 3
    start, i = integers[i : i + p + 1], i + p + 1
    first, i = integers[i : i + p + 1], i + p + 1
    count, i = integers[i : i + p], i + p
    level, i = integers[i : i + m], i + m
    side, i = integers[i : i + m], i + m
    fixed, i = integers[i : i + m], i + m
    order = integers[i : i + m]
    f = 0
    W, f = floats[f : f + m * n].reshape((m, n)), f + m * n
    V, f = floats[f : f + n * n].reshape((n, n)), f + n * n
    square, f = floats[f : f + m * (n + 1)].reshape((m, n + 1)), f + m * (n + 1)
    beta, f = floats[f : f + n], f + n
    c, f = floats[f : f + n], f + n
    x, f = floats[f : f + n], f + n
    target, f = floats[f : f + n], f + n
    pull, f = floats[f : f + n], f + n
    slack, f = floats[f : f + m], f + m
    bound, f = floats[f : f + m], f + m
    multiplier, f = floats[f : f + m], f + m
    size, f = floats[f : f + m], f + m
    rest = floats[f : f + m]
    return Work(
        start, level, side, fixed, order, count, first,
        W, V, beta, c, x, target, slack, bound, multiplier, pull, size, rest, square,
    )  # fmt: skip
