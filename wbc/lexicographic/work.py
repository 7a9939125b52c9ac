"""The solver's arrays, allocated once and found through one table."""

from __future__ import annotations

from typing import Annotated, Any, Final, NamedTuple

from wbc.arrays import Array, IntArray
from wbc.compiled import inner
from wbc.structure import ENTRIES, Structure

__all__ = [
    "DUAL", "MOST", "SETTLED", "WORK", "Dual", "Work", "dual_at",
    "set_problem", "work_at",
]  # fmt: skip

SETTLED, MOST = 0, 1
"""The options: whether the working set is a solution's, and how many steps a method
may take from nothing."""


class Work(NamedTuple):
    """A problem, and everything that a solve writes but for the dual method.

    With Q the product of the reflectors so far, x = Q c; level k owns the coordinates
    c[first[k] : first[k + 1]].

    Attributes:
        A: (m, n) the levels' rows, stacked; not ours, no more than the next two.
        lower: (m,) their lower bounds.
        upper: (m,) and upper ones.
        table: where these three lie, as `Structure` has it.
        options: (2,) as `SETTLED` and `MOST` list.
        tolerance: (1,) the share of a level's norm below which nothing counts.
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
        factor: (n + 1, m) QR of a level's factor, transposed, reciprocals on its
            diagonal, and its slack.
        beta: (n,) factors of the reflectors: I - beta v v^T.
        c: (n,) coordinates of the solution.
        x: (n,) the solution.
        target: (n,) where a descent heads.
        pull: (n,) force of the level whose multipliers were asked for.
        slack: (m,) bound - a x of the working rows, 0 for the others.
        multiplier: (m,) of the rows above that level.
        rest: (m,) square norm of a row outside the coordinates taken so far.
    """

    A: Annotated[Array, "m, n"]
    lower: Annotated[Array, "m"]
    upper: Annotated[Array, "m"]
    table: Annotated[IntArray, "table"]
    options: Annotated[IntArray, "2"]
    tolerance: Annotated[Array, "1"]
    start: Annotated[IntArray, "p + 1"]
    first: Annotated[IntArray, "p + 1"]
    count: Annotated[IntArray, "p"]  # type: ignore[assignment]  # hides tuple.count
    level: Annotated[IntArray, "m"]
    side: Annotated[IntArray, "m"]
    order: Annotated[IntArray, "m"]
    fixed: Annotated[IntArray, "m"]
    released: Annotated[IntArray, "m"]
    stuck: Annotated[IntArray, "m"]
    scale: Annotated[Array, "p"]
    size: Annotated[Array, "m"]
    W: Annotated[Array, "m, n"]
    V: Annotated[Array, "n, n"]
    factor: Annotated[Array, "n + 1, m"]
    beta: Annotated[Array, "n"]
    c: Annotated[Array, "n"]
    x: Annotated[Array, "n"]
    target: Annotated[Array, "n"]
    pull: Annotated[Array, "n"]
    slack: Annotated[Array, "m"]
    multiplier: Annotated[Array, "m"]
    rest: Annotated[Array, "m"]


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
        L: (m, m) Cholesky factor of the rows held, in the level's metric, with the
            reciprocals of its diagonal.
        point: (n,) its x.
        way: (n,) direction of a step.
        multiplier: (m,) of the rows.
        rate: (m,) how fast a step uses up those held.
    """

    number: Annotated[IntArray, "1"]
    chosen: Annotated[IntArray, "m"]
    held: Annotated[IntArray, "m"]
    known: Annotated[IntArray, "m"]
    pushing: Annotated[IntArray, "m"]
    column: Annotated[IntArray, "m"]
    P: Annotated[Array, "m, n"]
    Z: Annotated[Array, "n, n"]
    L: Annotated[Array, "m, m"]
    point: Annotated[Array, "n"]
    way: Annotated[Array, "n"]
    multiplier: Annotated[Array, "m"]
    rate: Annotated[Array, "m"]


WORK: Final = Structure(Work)
DUAL: Final = Structure(Dual, after=WORK)
work_at: Final[Any] = WORK.at
dual_at: Final[Any] = DUAL.at


@inner
def set_problem(w: Work, A: Array, lower: Array, upper: Array) -> None:
    """Let the structure's problem be these arrays."""
    w.table[0] = A.ctypes.data
    w.table[ENTRIES] = lower.ctypes.data
    w.table[2 * ENTRIES] = upper.ctypes.data
