"""The solver's arrays, allocated once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, final

import numpy as np

from wbc.arrays import Array, IntArray
from wbc.compiled import inner, python

__all__ = [
    "MOST", "SOLVED", "TOLERANCE", "Dual", "Memory", "Work", "unpack", "unpack_dual",
]  # fmt: skip

SOLVED, MOST, SIZES = 3, 4, 5
"""The integers start with p, m, n, whether the working set is a solution's, and how
many steps a method may take from nothing."""
TOLERANCE, HEAD = 0, 1
"""The floats start with the share of a level's norm below which nothing counts."""


class Work(NamedTuple):
    """Everything that a solve writes, but for the dual method.

    With Q the product of the reflectors so far, x = Q c; level k owns the coordinates
    c[first[k] : first[k + 1]].

    Attributes:
        start: (p + 1,) first row of every level, and the number of rows.
        first: (p + 1,) coordinates taken by the levels before.
        count: (p,) how many of a level's rows are in the working set.
        level: (m,) level of every row.
        side: (m,) the working set: 1 at upper, -1 at lower, 2 equality, 0 free.
        order: (m,) rows of the working set, level by level, pivots first.
        fixed: (m,) rows whose side can no longer change.
        released: (m,) how often the level of a descent let a row go.
        stuck: (m,) rows that went straight out again when they were let go.
        scale: (p,) norm of every level.
        size: (m,) norm of every row; 0 where its level's scale drowns it.
        W: (m, n) working rows in the coordinates c.
        V: (n, n) the reflectors' vectors, one a row.
        factor: (n + 1, m) QR of a level's factor, transposed, and its slack.
        beta: (n,) factors of the reflectors: I - beta v v^T.
        c: (n,) coordinates of the solution.
        x: (n,) the solution.
        target: (n,) where a descent heads.
        pull: (n,) force of the level whose multipliers were asked for.
        slack: (m,) bound - a x of the working rows, 0 for the others.
        multiplier: (m,) of the rows above that level.
        rest: (m,) square norm of a row outside the coordinates taken so far.
    """

    start: IntArray
    first: IntArray
    count: IntArray  # type: ignore[assignment]  # hides tuple.count
    level: IntArray
    side: IntArray
    order: IntArray
    fixed: IntArray
    released: IntArray
    stuck: IntArray
    scale: Array
    size: Array
    W: Array
    V: Array
    factor: Array
    beta: Array
    c: Array
    x: Array
    target: Array
    pull: Array
    slack: Array
    multiplier: Array
    rest: Array


class Dual(NamedTuple):
    """What the dual method writes besides.

    Attributes:
        number: (1,) how many rows it holds.
        chosen: (m,) these rows, in the order of their factor.
        held: (m,) their sides, `IGNORED` for rows that nothing moves, 0 for others.
        known: (m,) whether a row's move is up to date.
        pushing: (m,) rows of higher levels that the level leaves pushing.
        column: (m,) the unknown that a row bounds; -1 if it has not just one.
        P: (m, n) moves: how x answers to a force along a row.
        Z: (n, n) columns of Q, as rows, where a level determines all that was left.
        L: (m, m) Cholesky factor of the rows held, in the level's metric.
        point: (n,) its x.
        way: (n,) direction of a step.
        multiplier: (m,) of the rows.
        rate: (m,) how fast a step uses up those held.
    """

    number: IntArray
    chosen: IntArray
    held: IntArray
    known: IntArray
    pushing: IntArray
    column: IntArray
    P: Array
    Z: Array
    L: Array
    point: Array
    way: Array
    multiplier: Array
    rate: Array


@final
class Memory:
    """The same arrays end to end in two, because a call is as fast as it is short.

    Args:
        sizes: number of rows of every level.
        n: number of unknowns.

    Attributes:
        floats, integers: everything, in the order of `Work` and `Dual`.
        views: the arrays of `Work` by name.
    """

    __slots__ = ("floats", "integers", "views")

    def __init__(self, sizes: Sequence[int], n: int) -> None:
        p, m = len(sizes), int(sum(sizes))
        self.floats = np.zeros(HEAD + m * (3 * n + m + 7) + n * (2 * n + 7) + p)
        self.integers = np.zeros(SIZES + 3 * p + 2 + 11 * m + 1, np.int_)
        self.integers[:3] = p, m, n
        self.views = python(unpack)(self.floats, self.integers)
        self.views.start[1:] = np.cumsum(np.array(sizes, np.int_))
        self.views.level[:] = np.repeat(np.arange(p), sizes)


@inner
def unpack(floats: Array, integers: IntArray) -> Work:
    """The arrays of `Work` in a `Memory`, as views."""
    p, m, n = integers[0], integers[1], integers[2]
    i = SIZES
    start, i = integers[i : i + p + 1], i + p + 1
    first, i = integers[i : i + p + 1], i + p + 1
    count, i = integers[i : i + p], i + p
    level, i = integers[i : i + m], i + m
    side, i = integers[i : i + m], i + m
    order, i = integers[i : i + m], i + m
    fixed, i = integers[i : i + m], i + m
    released, i = integers[i : i + m], i + m
    stuck = integers[i : i + m]
    scale, f = floats[HEAD : HEAD + p], HEAD + p
    size, f = floats[f : f + m], f + m
    W, f = floats[f : f + m * n].reshape((m, n)), f + m * n
    V, f = floats[f : f + n * n].reshape((n, n)), f + n * n
    factor, f = floats[f : f + (n + 1) * m].reshape((n + 1, m)), f + (n + 1) * m
    beta, f = floats[f : f + n], f + n
    c, f = floats[f : f + n], f + n
    x, f = floats[f : f + n], f + n
    target, f = floats[f : f + n], f + n
    pull, f = floats[f : f + n], f + n
    slack, f = floats[f : f + m], f + m
    multiplier, f = floats[f : f + m], f + m
    rest = floats[f : f + m]
    return Work(
        start, first, count, level, side, order, fixed, released, stuck, scale, size,
        W, V, factor, beta, c, x, target, pull, slack, multiplier, rest,
    )  # fmt: skip


@inner
def unpack_dual(floats: Array, integers: IntArray) -> Dual:
    """Those of `Dual`, behind them."""
    p, m, n = integers[0], integers[1], integers[2]
    i = SIZES + 3 * p + 2 + 6 * m
    number, i = integers[i : i + 1], i + 1
    chosen, i = integers[i : i + m], i + m
    held, i = integers[i : i + m], i + m
    known, i = integers[i : i + m], i + m
    pushing, i = integers[i : i + m], i + m
    column = integers[i : i + m]
    f = HEAD + p + m * (2 * n + 5) + n * (n + 5)
    P, f = floats[f : f + m * n].reshape((m, n)), f + m * n
    Z, f = floats[f : f + n * n].reshape((n, n)), f + n * n
    L, f = floats[f : f + m * m].reshape((m, m)), f + m * m
    point, f = floats[f : f + n], f + n
    way, f = floats[f : f + n], f + n
    multiplier, f = floats[f : f + m], f + m
    rate = floats[f : f + m]
    return Dual(
        number, chosen, held, known, pushing, column,
        P, Z, L, point, way, multiplier, rate,
    )  # fmt: skip
