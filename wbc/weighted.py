"""One QP with weights for priorities: what most people run, as a comparison."""

from __future__ import annotations

from typing import final

import numpy as np

from wbc.arrays import positive
from wbc.errors import InputError
from wbc.lexicographic import Lexicographic
from wbc.resolver import Answer, Resolver, Solver, Status
from wbc.stack import Stack

__all__ = ["WeightedQP"]


@final
class WeightedQP(Resolver):
    """Soft priorities: leading levels of pure inequalities are hard, the rest a sum.

    Level k below the hard ones weighs `ratio` times its successor in the squared
    residual, so it is neither sound nor optimal: lower tasks leak upwards by about
    1 / ratio. That is the point of comparing it.

    Args:
        ratio: weight of a level relative to the next one.

    Raises:
        InputError: the ratio is not a number of at least 1.
    """

    name = "weighted"

    def __init__(self, ratio: float = 100.0) -> None:
        self.ratio = positive(ratio, "ratio")
        if self.ratio < 1.0:
            raise InputError(
                f"ratio is {ratio}: lower levels would weigh more. Give at least 1."
            )

    def start(self, stack: Stack) -> Solver:
        """A solver with a warm start of its own."""
        return _Weighted(self, stack)


class _Weighted(Solver):
    """Two levels: the hard limits, and everything else in one weighted sum."""

    def __init__(self, resolver: WeightedQP, stack: Stack) -> None:
        self._stack, self._hard = stack, -1
        self._factor = np.ones(stack.lower.size)
        for k, where in enumerate(stack.levels):
            self._factor[where] = np.sqrt(resolver.ratio) ** -k

    def solve(self) -> Answer:
        """Resolve the present rows; ranks are the levels' sizes, none is projected."""
        stack, factor = self._stack, self._factor
        n, m = stack.robot.nv, stack.lower.size
        hard = self._leading_inequalities()
        if hard != self._hard:
            self._hard, self._solver = hard, Lexicographic([hard, m - hard], n)
        done = self._solver.solve(
            stack.Ay * factor[:, None], stack.lower * factor, stack.upper * factor
        )
        ranks = np.array([min(k.stop - k.start, n) for k in stack.levels])
        status = Status.SOLVED if done else Status.INCOMPLETE
        return Answer(stack.acceleration(self._solver.x), ranks, status)

    def _leading_inequalities(self) -> int:
        """How many rows the levels above the first equality have."""
        stack, hard = self._stack, 0
        for where in stack.levels:
            if (stack.lower[where] == stack.upper[where]).any():
                break
            hard = where.stop
        return hard
