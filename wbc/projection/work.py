"""The projection's arrays, allocated once and found through one table."""

from __future__ import annotations

from typing import Annotated, Any, Final, NamedTuple

from wbc.arrays import Array, IntArray
from wbc.compiled import inner
from wbc.structure import ENTRIES, Structure

__all__ = ["WORK", "Work", "set_problem", "work_at"]


class Work(NamedTuple):
    """A problem, the law, and everything that a solve writes.

    A block is the held bounds of a level, or its equalities. A bound that has closed to
    a point is held, and no equality. Direction i is row i of Z;
    block c owns the directions first[c] to first[c + 1].

    Attributes:
        A: (m, n) the levels' rows, stacked; not ours, no more than the next three.
        lower: (m,) their lower bounds.
        upper: (m,) and upper ones.
        rest: (n,) what y would be if all motion were to die out.
        table: where these four lie, as `Structure` has it.
        alone: (1,) whether each level is solved without regard to those above (UF).
        start: (p + 1,) first row of every level, and the number of rows.
        task: (m,) first row of the task that each row belongs to.
        bounding: (m,) at these, whether the task has rows whose bounds leave room.
        side: (m,) bounds that are held: 1 at upper, -1 at lower, 0 for other rows.
        undecided: (m,) held bounds that no level has pulled at yet.
        order: (m,) rows of the blocks, one block after the other.
        blocks: (1,) number of blocks.
        block: (2 p + 1,) where in `order` each begins.
        first: (2 p + 1,) directions taken by the blocks before.
        ranks: (p,) directions taken by every level.
        damping: (2,) of the levels' inverses: singular value, relative to the norm of
            the block, below which there is some, and the largest; 0 for none.
        y: (n,) the result.
        Z: (n, n) orthonormal directions, those that are taken first.
        B: (n, m) image of every direction in the rows of its block, J z.
        sigma: (n,) norm of that image.
        V, C, gain: the same three for a level that is solved alone.
        missing: (m,) b - J y of the rows in `order`.
        push: (m,) force of each row in `order`: its multiplier times its norm.
        pull: (n,) force that pushes at the rows above.
        way: (n,) what a level adds when it is solved alone, or what is left to rest.
        spare: (2, n) numbers on the way.
    """

    A: Annotated[Array, "m, n"]
    lower: Annotated[Array, "m"]
    upper: Annotated[Array, "m"]
    rest: Annotated[Array, "n"]
    table: Annotated[IntArray, "table"]
    alone: Annotated[IntArray, "1"]
    damping: Annotated[Array, "2"]
    start: Annotated[IntArray, "p + 1"]
    task: Annotated[IntArray, "m"]
    bounding: Annotated[IntArray, "m"]
    side: Annotated[IntArray, "m"]
    undecided: Annotated[IntArray, "m"]
    order: Annotated[IntArray, "m"]
    blocks: Annotated[IntArray, "1"]
    block: Annotated[IntArray, "2 p + 1"]
    first: Annotated[IntArray, "2 p + 1"]
    ranks: Annotated[IntArray, "p"]
    y: Annotated[Array, "n"]
    Z: Annotated[Array, "n, n"]
    B: Annotated[Array, "n, m"]
    sigma: Annotated[Array, "n"]
    V: Annotated[Array, "n, n"]
    C: Annotated[Array, "n, m"]
    gain: Annotated[Array, "n"]
    missing: Annotated[Array, "m"]
    push: Annotated[Array, "m"]
    pull: Annotated[Array, "n"]
    way: Annotated[Array, "n"]
    spare: Annotated[Array, "2, n"]


WORK: Final = Structure(Work)
work_at: Final[Any] = WORK.at


@inner
def set_problem(w: Work, A: Array, lower: Array, upper: Array, rest: Array) -> None:
    """Let the structure's problem be these arrays."""
    w.table[0] = A.ctypes.data
    w.table[ENTRIES] = lower.ctypes.data
    w.table[2 * ENTRIES] = upper.ctypes.data
    w.table[3 * ENTRIES] = rest.ctypes.data
