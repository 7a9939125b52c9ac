"""Inequalities in a projection law: saturation in the null space (Flacco 2015)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

import numpy as np

from wbc.arrays import Array, IntArray
from wbc.damped import DampedInverse
from wbc.errors import SolverError
from wbc.lexicographic import Lexicographic
from wbc.linalg import RANK_TOLERANCE, Factor, factorise, norm
from wbc.resolver import Answer, Solver, Status
from wbc.stack import Stack

__all__ = ["Saturation"]

FEASIBILITY = 1e-9
"""A bound counts as violated beyond this, relative to its row's norm and size."""
AT_BOUND = 1e-8
"""A row of the strict optimum this close to a bound, relative likewise, is held."""
MULTIPLIER = 1e-9
"""A multiplier below this, relative to the forces at play, has no sign."""

_Found: TypeAlias = tuple[Array, tuple[int, ...], Status]


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
        self._stack, self._damping = stack, damping
        self._kinetic, self._alone = kinetic, alone
        self._active: dict[int, int] = {}
        sizes = [where.stop - where.start for where in stack.levels]
        self._exact = Lexicographic(sizes, stack.robot.nv)
        m = stack.lower.size
        self._level = np.zeros(m, dtype=int)
        for k, where in enumerate(stack.levels):
            self._level[where] = k

    def solve(self) -> Answer:
        """Resolve by projection, adding and releasing saturated bounds."""
        stack = self._stack
        A = stack.Ay if self._kinetic else stack.A
        self._free = stack.lower != stack.upper
        for row in [r for r in self._active if not self._free[r]]:
            del self._active[row]
        y, ranks, status = self._saturate(A) or self._strict(A)
        if not np.isfinite(y).all():
            raise SolverError("the projection gave a result that is not finite.")
        vdot = stack.acceleration(y) if self._kinetic else y
        return Answer(vdot, np.array(ranks), status)

    def _saturate(self, A: Array) -> _Found | None:
        """Hold the worst violated row, let go of one that pulls, until neither is."""
        for _ in range(2 * A.shape[1] + 4):
            y, ranks = self._project(A)
            if not self._add_worst(A, y) and not self._release_one(A, y):
                return y, ranks, Status.SOLVED
        return None

    def _strict(self, A: Array) -> _Found:
        """Where saturation goes round in circles: the set that the strict QP holds.

        Laws that are not optimal may want more rows held; then none is released.

        Raises:
            SolverError: there is no such set.
        """
        stack, status = self._stack, Status.SOLVED
        self._exact.solve(A, stack.lower, stack.upper)
        value = A @ self._exact.x
        near = AT_BOUND * (np.linalg.norm(A, axis=1) + np.abs(value))
        side = 1 * (value >= stack.upper - near) - 1 * (value <= stack.lower + near)
        self._active = {
            int(row): int(side[row]) for row in np.flatnonzero(side * self._free)
        }
        y, ranks = self._project(A)
        while self._add_worst(A, y):
            y, ranks = self._project(A)
            status = Status.INCOMPLETE
        return y, ranks, status

    def _blocks(self) -> Iterator[tuple[int, IntArray, Array]]:
        """(level, row indices, targets): saturated rows first, then equalities."""
        stack = self._stack
        for k, where in enumerate(stack.levels):
            held = [r for r in self._active if self._level[r] == k]
            if held:
                sides = [self._active[r] for r in held]
                bounds = [
                    stack.upper[r] if side > 0 else stack.lower[r]
                    for r, side in zip(held, sides, strict=True)
                ]
                yield k, np.array(held), np.array(bounds)
            rows = where.start + np.flatnonzero(~self._free[where])
            if rows.size:
                yield k, rows, stack.lower[rows]

    def _project(self, A: Array) -> tuple[Array, tuple[int, ...]]:
        n = A.shape[1]
        y, Z = np.zeros(n), np.eye(n)
        ranks, rest = [0] * len(self._stack.levels), self._rest()
        for level, rows, b in self._blocks():
            J = A[rows]
            scale = norm(J)
            factor = factorise(J @ Z, scale, RANK_TOLERANCE)
            if self._free[rows[0]]:  # a bound is met exactly, whatever the law
                y = y + Z @ factor.solve(b - J @ y)
            elif self._alone:
                alone = factorise(J, scale, RANK_TOLERANCE)
                y = y + Z @ (Z.T @ self._invert(alone, b, scale, rest))
            else:
                y = y + Z @ self._invert(factor, b - J @ y, scale, Z.T @ (rest - y))
            Z = Z @ factor.V2
            ranks[level] += factor.rank
        return y, tuple(ranks)

    def _invert(self, factor: Factor, b: Array, scale: float, rest: Array) -> Array:
        if self._damping is None:
            return factor.solve(b)
        return self._damping.solve(factor, b, scale, rest)

    def _rest(self) -> Array:
        """What y would be if all motion were to die out at the rate of the damping."""
        stack = self._stack
        if self._damping is None:
            return np.zeros(stack.v.size)
        rest: Array = -self._damping.rate * stack.v
        return np.array(np.linalg.solve(stack.L_inv.T, rest)) if self._kinetic else rest

    def _add_worst(self, A: Array, y: Array) -> bool:
        """Saturate the row that is violated most, relative to its norm."""
        stack = self._stack
        value = A @ y
        above, below = value - stack.upper, stack.lower - value
        excess = np.where(self._free, np.maximum(above, below), -np.inf)
        excess[list(self._active)] = -np.inf
        if not (excess > 0.0).any():
            return False
        size = np.linalg.norm(A, axis=1)
        slack = FEASIBILITY * (size + np.abs(value))
        relative = np.where(excess > slack, excess / np.maximum(size, 1e-300), 0.0)
        worst = int(np.argmax(relative))
        if relative[worst] <= 0.0:
            return False
        self._active[worst] = 1 if above[worst] > below[worst] else -1
        return True

    def _release_one(self, A: Array, y: Array) -> bool:
        """Let go of a saturated row that the tasks below would leave by themselves.

        The sign of the first level that pulls at a row decides (lexicographic).
        """
        if not self._active:
            return False
        above: list[Array] = []
        held: list[int] = []
        undecided = set(self._active)
        blocks = [(A[rows], rows, b) for _, rows, b in self._blocks()]
        n = y.size
        for J, rows, b in [*blocks, (np.eye(n), np.zeros(0, int), np.zeros(n))]:
            slack = b - J @ y
            row = self._would_leave(rows, slack, undecided) if rows.size else None
            if row is None:
                row = self._wrong_sign(above, held, J.T @ slack, undecided)
            if row is not None:
                del self._active[row]
                return True
            above.append(J)
            held.extend(int(r) for r in rows)
        return False

    def _would_leave(
        self, rows: IntArray, slack: Array, undecided: set[int]
    ) -> int | None:
        """A held row that others hold inside its bound; those beyond it stay."""
        floor = MULTIPLIER * (1.0 + float(np.abs(slack).max(initial=0.0)))
        for row, s in zip(rows, slack, strict=True):
            if row in undecided and abs(s) > floor:
                if s * self._active[row] > 0.0:
                    return int(row)
                undecided.discard(int(row))
        return None

    def _wrong_sign(
        self, above: list[Array], held: list[int], pull: Array, undecided: set[int]
    ) -> int | None:
        if not above or not undecided:
            return None
        G = np.vstack(above)
        multipliers = np.linalg.lstsq(G.T, pull, rcond=RANK_TOLERANCE)[0]
        scale = MULTIPLIER * (1.0 + float(np.abs(multipliers).max(initial=0.0)))
        for row, multiplier in zip(held, multipliers, strict=True):
            if row in undecided and abs(multiplier) > scale:
                if multiplier * self._active[row] < 0:
                    return row
                undecided.discard(row)
        return None
