"""The projection's arrays, allocated once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, final

import numpy as np

from wbc.arrays import Array, IntArray
from wbc.compiled import inner, python

__all__ = ["Memory", "Work", "unpack"]

SIZES = 3
"""The integers start with p, m, n."""


class Work(NamedTuple):
    """Everything that a solve writes.

    A block is the held bounds of a level, or its equalities. Direction i is row i of Z;
    block c owns the directions first[c] to first[c + 1].

    Attributes:
        alone: (1,) whether each level is solved without regard to those above (UF).
        start: (p + 1,) first row of every level, and the number of rows.
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

    alone: IntArray
    start: IntArray
    side: IntArray
    undecided: IntArray
    order: IntArray
    blocks: IntArray
    block: IntArray
    first: IntArray
    ranks: IntArray
    damping: Array
    y: Array
    Z: Array
    B: Array
    sigma: Array
    V: Array
    C: Array
    gain: Array
    missing: Array
    push: Array
    pull: Array
    way: Array
    spare: Array


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
        self.floats = np.zeros(2 + n * (2 * n + 2 * m + 7) + 2 * m)
        self.integers = np.zeros(SIZES + 6 * p + 5 + 3 * m, np.int_)
        self.integers[:3] = p, m, n
        self.views = python(unpack)(self.floats, self.integers)
        self.views.start[1:] = np.cumsum(np.array(sizes, np.int_))


@inner
def unpack(floats: Array, integers: IntArray) -> Work:
    """The arrays of `Work` in a `Memory`, as views."""
    p, m, n = integers[0], integers[1], integers[2]
    alone, i = integers[SIZES : SIZES + 1], SIZES + 1
    start, i = integers[i : i + p + 1], i + p + 1
    side, i = integers[i : i + m], i + m
    undecided, i = integers[i : i + m], i + m
    order, i = integers[i : i + m], i + m
    blocks, i = integers[i : i + 1], i + 1
    block, i = integers[i : i + 2 * p + 1], i + 2 * p + 1
    first, i = integers[i : i + 2 * p + 1], i + 2 * p + 1
    ranks = integers[i : i + p]
    damping, y, f = floats[:2], floats[2 : 2 + n], 2 + n
    Z, f = floats[f : f + n * n].reshape((n, n)), f + n * n
    B, f = floats[f : f + n * m].reshape((n, m)), f + n * m
    sigma, f = floats[f : f + n], f + n
    V, f = floats[f : f + n * n].reshape((n, n)), f + n * n
    C, f = floats[f : f + n * m].reshape((n, m)), f + n * m
    gain, f = floats[f : f + n], f + n
    missing, f = floats[f : f + m], f + m
    push, f = floats[f : f + m], f + m
    pull, f = floats[f : f + n], f + n
    way, f = floats[f : f + n], f + n
    spare = floats[f : f + 2 * n].reshape((2, n))
    return Work(
        alone, start, side, undecided, order, blocks, block, first, ranks,
        damping, y, Z, B, sigma, V, C, gain, missing, push, pull, way, spare,
    )  # fmt: skip
