"""The solver as an object: sizes and arrays fixed, working set kept between calls."""

from __future__ import annotations

from collections.abc import Sequence
from typing import final

import numpy as np

from wbc.arrays import Array, IntArray
from wbc.compiled import announce, compiled, inner
from wbc.lexicographic.descent import descend
from wbc.lexicographic.multipliers import fault
from wbc.lexicographic.sweep import sweep
from wbc.lexicographic.vectors import dot, reflect_back
from wbc.lexicographic.work import Memory, Work, unpack
from wbc.linalg import RANK_TOLERANCE

__all__ = ["Lexicographic"]

FEASIBILITY = 1e-10
"""A bound counts as violated beyond this, relative to its row's norm and value."""
GUESSES = 8
"""Sweeps that a remembered working set gets before the descent starts from nothing."""


@final
class Lexicographic:
    """Minimises |s_1|, then |s_2|, ..., then |x|, with lower <= A x + s <= upper.

    Deterministic, free of allocation after construction, exact to round-off. One
    instance serves problems of one shape and remembers its last working set.

    Args:
        sizes: number of rows of every level, from the top.
        n: number of unknowns.
        tolerance: a direction of a level counts if it keeps more than this share of
            the norm of the level's rows.

    Attributes:
        x: (n,) the minimiser of the last call; overwritten by the next.
        slack: (m,) bound - a x of the rows of its working set, 0 for the others.
        side: (m,) its working set: 1 at upper, -1 at lower, 2 equality, 0 free.
        sweeps: how many sweeps it took.
    """

    def __init__(
        self, sizes: Sequence[int], n: int, tolerance: float = RANK_TOLERANCE
    ) -> None:
        memory = Memory(sizes, n)
        self._floats, self._integers = memory.floats, memory.integers
        self._work = memory.views
        self._tolerance = tolerance
        self._most = 50 + 20 * (int(sum(sizes)) + n)
        self.x, self.side = self._work.x, self._work.side
        self.slack = self._work.slack
        self.sweeps = 0
        announce(_solve, "the solver")

    @property
    def ranks(self) -> IntArray:
        """For each level (p,), how many coordinates it took."""
        first = self._work.first
        return first[1:] - first[:-1]

    def reset(self) -> None:
        """Forget the working set."""
        self._work.side[:] = 0

    def solve(self, A: Array, lower: Array, upper: Array) -> bool:
        """Solve; whether an optimal working set was found within the iterations.

        Args:
            A: (m, n) the levels' rows, stacked; C-contiguous, finite.
            lower: (m,) -inf where there is no bound.
            upper: (m,) +inf where there is no bound; not below `lower`.
        """
        self.sweeps = _solve(
            A, lower, upper, self._floats, self._integers, self._tolerance, self._most
        )
        return self.sweeps > 0


@compiled
def _solve(
    A: Array,
    lower: Array,
    upper: Array,
    floats: Array,
    integers: IntArray,
    tolerance: float,
    most: int,
) -> int:
    """Guess from the last working set, then descend; sweeps, negative on failure."""
    w = unpack(floats, integers)
    guessed = _prepare(A, lower, upper, w)
    p, n = w.count.size, w.x.size
    dirty = 0
    w.first[0] = 0
    for guess in range(GUESSES):
        taken = sweep(A, lower, upper, w, tolerance, dirty, p)
        for j in range(n):
            w.x[j] = w.c[j] if j < taken else 0.0
        reflect_back(w.x, w.V, w.beta, taken)
        row, side = fault(A, lower, upper, w, FEASIBILITY)
        if row < 0:
            return guess + 1
        if not guessed:
            break
        w.side[row] = side
        dirty = w.level[row]
    sweeps = descend(A, lower, upper, w, tolerance, FEASIBILITY, most)
    return sweeps + GUESSES if sweeps > 0 else sweeps - GUESSES


@inner
def _prepare(A: Array, lower: Array, upper: Array, w: Work) -> bool:
    """Norms of the rows; sides that the present bounds allow. Is there a guess?"""
    guessed = False
    for r in range(w.side.size):
        w.size[r] = np.sqrt(dot(A[r], A[r], 0, w.x.size))
        if lower[r] == upper[r]:
            w.side[r] = 2
        elif (
            w.side[r] == 2
            or (w.side[r] == 1 and upper[r] == np.inf)
            or (w.side[r] == -1 and lower[r] == -np.inf)
        ):
            w.side[r] = 0
        guessed = guessed or w.side[r] * w.side[r] == 1
    return guessed
