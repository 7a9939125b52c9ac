"""Inequalities in a projection law: saturation in the null space (Flacco 2015)."""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array
from wbc.damped import DampedInverse
from wbc.errors import SolverError
from wbc.lexicographic import Lexicographic
from wbc.projection import Projection
from wbc.resolver import Answer, Solver, Status
from wbc.stack import Stack
from wbc.vectors import finite

__all__ = ["Saturation"]

AT_BOUND = 1e-8
"""A row of the strict optimum this close to a bound, relative to its norm and size, is
held."""


class Saturation(Solver):
    """Saturation around the equality recursion of a projection law.

    Args:
        stack: the rows.
        kinetic: project in the metric of the inertia, else in that of vdot.
        alone: solve each level without regard to those above, then project (UF).
        damping: of the levels' inverses; bounds are always inverted exactly.
    """

    def __init__(
        self, stack: Stack, *, kinetic: bool, alone: bool, damping: DampedInverse | None
    ) -> None:
        self._stack, self._damping, self._kinetic = stack, damping, kinetic
        sizes, n = [where.stop - where.start for where in stack.levels], stack.robot.nv
        tasks = np.zeros(stack.lower.size, np.int_)
        for term in stack.terms:
            tasks[term.where] = term.where.start
        self._projection = Projection(sizes, n, damping, alone, tasks.tolist())
        self._exact = Lexicographic(sizes, n)
        self._A = stack.Ay if kinetic else stack.A
        self._nowhere = np.zeros(n)

    def solve(self) -> Answer:
        """Resolve by projection, adding and releasing saturated bounds."""
        stack, projection = self._stack, self._projection
        rest = self._nowhere if self._damping is None else self._rest(self._damping)
        rows = self._A, stack.lower, stack.upper
        status = Status.SOLVED
        if not projection.solve(*rows, rest):
            self._hold_strict()
            if not projection.keep(*rows, rest):
                status = Status.INCOMPLETE
        y = projection.y
        if not finite(y):
            raise SolverError("the projection gave a result that is not finite.")
        vdot = stack.acceleration(y) if self._kinetic else y.copy()
        ranks = projection.ranks.copy()
        return Answer(vdot, ranks, status, kinetic=self._kinetic)

    def _hold_strict(self) -> None:
        """Where saturation goes round in circles: hold what the strict QP holds.

        Laws that are not optimal may want more rows held; then none is released.
        """
        A, stack = self._A, self._stack
        self._exact.solve(A, stack.lower, stack.upper)
        value = A @ self._exact.x
        near = AT_BOUND * (np.linalg.norm(A, axis=1) + np.abs(value))
        above, below = value >= stack.upper - near, value <= stack.lower + near
        free = stack.lower != stack.upper
        self._projection.side[:] = (1 * above - 1 * below) * free

    def _rest(self, damping: DampedInverse) -> Array:
        """What y would be if all motion were to die out at the rate of the damping."""
        stack = self._stack
        rest: Array = -damping.rate * stack.v
        return stack.coordinates(rest) if self._kinetic else rest
