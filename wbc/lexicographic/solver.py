"""The solver as an object: sizes and arrays fixed, working set kept between calls."""

from __future__ import annotations

from collections.abc import Sequence
from typing import final

import numpy as np

from wbc.arrays import Array, IntArray
from wbc.compiled import announce, compiled, inner
from wbc.lexicographic.descent import descend
from wbc.lexicographic.dual import climb
from wbc.lexicographic.multipliers import ROUND_OFF, fault
from wbc.lexicographic.sweep import sweep, take_point
from wbc.lexicographic.work import (
    DUAL,
    MOST,
    SETTLED,
    WORK,
    Dual,
    Work,
    dual_at,
    set_problem,
    work_at,
)
from wbc.linalg import RANK_TOLERANCE
from wbc.memory import Memory
from wbc.vectors import copy, dot, length

__all__ = ["Lexicographic", "lexicographic"]

GUESSES = 4
"""Sweeps that a remembered working set gets before one is made from nothing."""
CORRECTIONS = 30
"""Sweeps that one made from nothing gets."""


@final
class Lexicographic:
    """Minimises |s_1|, then |s_2|, ..., then |x|, with lower <= A x + s <= upper.

    Deterministic, free of allocation after construction, exact to round-off. One
    instance serves problems of one shape and remembers its last working set.

    A direction that keeps less than `tolerance` of its level's norm does not count,
    nor does a row that is smaller. Near that threshold, roughly from 1e-11 to 1e-7,
    round-off decides what counts, as for every method in double precision: levels keep
    their optimum to 1e-9 of their norm times |x|, but which of several points that are
    equal to that is chosen, and whether it can be proven, is then open.

    Args:
        sizes: number of rows of every level, from the top.
        n: number of unknowns.
        tolerance: as above.
        most: steps of either method from nothing before it gives up; None for many.

    Attributes:
        x: (n,) the minimiser of the last call; overwritten by the next.
        slack: (m,) bound - a x of the rows of its working set, 0 for the others.
        side: (m,) its working set: 1 at upper, -1 at lower, 2 equality, 0 free.
        sweeps: how many sweeps and steps it took.
        address: of its memory, for compiled code.
    """

    def __init__(
        self,
        sizes: Sequence[int],
        n: int,
        tolerance: float = RANK_TOLERANCE,
        most: int | None = None,
    ) -> None:
        self._memory = Memory(sizes, n, WORK, DUAL)
        self.address, memory = self._memory.address, self._memory
        memory["level"][:] = np.repeat(np.arange(len(sizes)), sizes)
        memory["tolerance"][0] = tolerance
        many = 50 + 20 * (int(sum(sizes)) + n)
        self._options, self._first = memory["options"], memory["first"]
        self._options[MOST] = many if most is None else most
        self.x, self.side, self.slack = memory["x"], memory["side"], memory["slack"]
        self.sweeps = 0

    @property
    def ranks(self) -> IntArray:
        """For each level (p,), how many coordinates it took."""
        first = self._first
        ranks: IntArray = first[1:] - first[:-1]
        return ranks

    def reset(self) -> None:
        """Forget the working set."""
        self._options[SETTLED] = 0

    def solve(self, A: Array, lower: Array, upper: Array) -> bool:
        """Solve; whether an optimal working set was found within the iterations.

        If not, x is the best point reached: optimal for the levels above the one that
        could not be finished.

        Args:
            A: (m, n) the levels' rows, stacked; C-contiguous, finite.
            lower: (m,) -inf where there is no bound.
            upper: (m,) +inf where there is no bound; not below `lower`.
        """
        if self.sweeps == 0:
            announce(lexicographic, "the solver")
        self.sweeps = lexicographic(A, lower, upper, self.address)
        return self.sweeps > 0


@compiled
def lexicographic(A: Array, lower: Array, upper: Array, address: int) -> int:
    """Try the last working set, then one from nothing; steps, negative on failure.

    Arguments as for `Lexicographic.solve`, and the address of its `Memory`.
    """
    w, d = work_at(address), dual_at(address)
    set_problem(w, A, lower, upper)
    most, unbounded = w.options[MOST], _prepare(w)
    steps, left = 0, GUESSES if unbounded or w.options[SETTLED] else 0
    w.options[SETTLED] = 0
    for stage in range(3):
        if stage > 0:
            left = CORRECTIONS
            w.stuck[:] = 0
            if stage == 1:
                _find_plain(w, d)
                taken = climb(w, d, most)
            else:
                taken = descend(w, most)
                copy(w.x, d.point)
            steps += abs(taken)
            if taken < 0:
                continue
        taken = _correct(w, left)
        steps += abs(taken)
        if taken > 0:
            _report(w, False)
            w.options[SETTLED] = 1
            return steps
    copy(d.point, w.x)
    _report(w, True)
    return -steps


@inner
def _prepare(w: Work) -> bool:
    """Norms; sides that the present bounds allow. Are there but equalities?"""
    A, lower, upper = w.A, w.lower, w.upper
    side, size, start, n, unbounded = w.side, w.size, w.start, w.x.size, True
    tolerance = w.tolerance[0]
    for k in range(w.count.size):
        square = 0.0
        for r in range(start[k], start[k + 1]):
            size[r] = dot(A[r], A[r], 0, n)
            square += size[r]
        w.scale[k] = np.sqrt(square)
        for r in range(start[k], start[k + 1]):
            lost = size[r] <= tolerance * tolerance * square
            size[r] = 0.0 if lost else np.sqrt(size[r])
            w.stuck[r] = 0
            if lower[r] == upper[r]:
                side[r] = 2
                continue
            unbounded = unbounded and lost
            gone = upper[r] == np.inf if side[r] == 1 else lower[r] == -np.inf
            if lost or gone or side[r] == 2:
                side[r] = 0
    return unbounded


@inner
def _find_plain(w: Work, d: Dual) -> None:
    """Which rows have a single coefficient, and where."""
    A, column = w.A, d.column
    for r in range(column.size):
        column[r] = -1
        for j in range(w.x.size):
            if A[r, j] != 0.0:
                if column[r] >= 0:
                    column[r] = -1
                    break
                column[r] = j


@inner
def _correct(w: Work, most: int) -> int:
    """Sweep and mend the worst fault until there is none; negative if `most` fail."""
    p, x, side, dirty, gone, was = w.count.size, w.x, w.side, 0, -1, 0
    for count in range(most):
        take_point(w, x, sweep(w, dirty, p))
        row, right = fault(w)
        if row < 0:
            return count + 1
        if gone >= 0:
            value = dot(w.A[gone], x, 0, x.size)
            out = value - w.upper[gone] if was == 1 else w.lower[gone] - value
            if out > ROUND_OFF * w.size[gone] * (1.0 + length(x)):
                row, right, w.stuck[gone] = gone, was, 1
        gone, was = row if right == 0 else -1, side[row]
        side[row], dirty = right, w.level[row]
    return -most


@inner
def _report(w: Work, everything: bool) -> None:
    """Slack and side of rows that count as zero, or of all: as x leaves them."""
    side, slack = w.side, w.slack
    for r in range(side.size):
        if everything or w.size[r] == 0.0:
            value = dot(w.A[r], w.x, 0, w.x.size)
            slack[r] = min(max(value, w.lower[r]), w.upper[r]) - value
            if w.size[r] == 0.0 and side[r] != 2:
                side[r] = 1 if slack[r] < 0.0 else -1 if slack[r] > 0.0 else 0
