"""One QP with weights for priorities: what most people run, as a comparison."""

from __future__ import annotations

from typing import final

import numpy as np

from wbc.arrays import positive
from wbc.cascade import Cascade
from wbc.qp import DEFAULT_BACKEND, QpBackend
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
        backend: a QP backend of `wbc.qp.backends()`.

    Raises:
        InputError: the ratio is not a number greater than 0.
        UnknownName: the backend is not installed.
    """

    name = "weighted"

    def __init__(self, ratio: float = 100.0, backend: str = DEFAULT_BACKEND) -> None:
        self.ratio = positive(ratio, "ratio")
        self._backend = QpBackend(backend)

    def start(self, stack: Stack) -> Solver:
        """A solver with a warm start of its own."""
        return _Weighted(self, self._backend, stack)


class _Weighted(Solver):
    """Two levels: the hard limits, and everything else in one weighted sum."""

    def __init__(self, resolver: WeightedQP, backend: QpBackend, stack: Stack) -> None:
        self._stack, self._cascade = stack, Cascade(backend)
        self._factor = np.ones(stack.lower.size)
        for k, where in enumerate(stack.levels):
            self._factor[where] = np.sqrt(resolver.ratio) ** -k

    def solve(self) -> Answer:
        """Resolve the present rows."""
        stack, factor = self._stack, self._factor
        hard = 0
        for where in stack.levels:
            if (stack.lower[where] == stack.upper[where]).any():
                break
            hard = where.stop
        levels = [
            (stack.Ay[rows] * f[:, None], stack.lower[rows] * f, stack.upper[rows] * f)
            for rows in (slice(0, hard), slice(hard, None))
            for f in (factor[rows],)
        ]
        result = self._cascade.solve(levels, stack.robot.nv)
        ranks = tuple(
            int(np.linalg.matrix_rank(stack.Ay[where])) for where in stack.levels
        )
        return Answer(stack.L_inv.T @ result.x, ranks, Status.SOLVED)
