"""Strict hierarchy by a cascade of small problems, each inside what is left free.

Levels k = 1..p in order minimise |s_k|^2 with lower_k <= A_k x + s_k <= upper_k, all
higher levels kept at their optimum. What a level fixes (its equalities, the bounds
that it cannot meet, the carried bounds that push back) leaves the problem through a
rank-revealing null-space basis, so the next one has an interior: freezing it as
constraints instead makes QP solvers fail (Kanoun 2011; Escande, Mansard and Wieber
2014 on the same point).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias, final

import numpy as np

from wbc.activeset import solve_level
from wbc.arrays import Array, BoolArray, IntArray
from wbc.errors import SolverError
from wbc.levelqp import FEASIBILITY, LevelPoint, LevelProblem, WorkingSet
from wbc.linalg import RANK_TOLERANCE, factorise, norm, recursion
from wbc.qp import QpBackend

__all__ = ["Cascade", "CascadeResult", "LevelRows"]

LevelRows: TypeAlias = tuple[Array, Array, Array]
"""A (m, n), lower (m,), upper (m,)."""

GONE = 1e-9
"""A carried row keeping less than this of its norm can no longer be moved."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class CascadeResult:
    """Outcome of `Cascade.solve`.

    Attributes:
        x: (n,) the lexicographic minimiser, of least norm where free.
        slacks: for each level (m_k,) s_k when the level was solved.
        ranks: for each level, the independent directions it could use.
    """

    x: Array
    slacks: tuple[Array, ...]
    ranks: tuple[int, ...]


@dataclass(slots=True, eq=False)
class _Left:
    """What the levels so far have left: x = x0 + Z z, and the bounds they meet."""

    x: Array
    Z: Array
    C: Array
    lower: Array
    upper: Array
    ids: IntArray


@final
class Cascade:
    """A solver that remembers the working sets of its last call as a guess.

    Args:
        backend: asked for a working set where guess and empty set both fail.
        tolerance: relative rank tolerance (`wbc.linalg.RANK_TOLERANCE`).
    """

    def __init__(self, backend: QpBackend, tolerance: float = RANK_TOLERANCE) -> None:
        self._backend, self._tolerance = backend, tolerance
        self._memory: dict[int, tuple[dict[int, int], dict[int, int]]] = {}
        self.calls = 0

    def solve(self, levels: Sequence[LevelRows], n: int) -> CascadeResult:
        """Resolve the levels, then the least norm.

        Raises:
            SolverError: a level has no point that passes its optimality conditions.
        """
        quick = self._unbounded(levels, n)
        if quick is not None:
            return quick
        left = _Left(
            np.zeros(n), np.eye(n), np.zeros((0, n)), np.zeros(0), np.zeros(0),
            np.zeros(0, dtype=int),
        )  # fmt: skip
        slacks, ranks, first = [], [], 0
        for k, (A, lower, upper) in enumerate(levels):
            slack, rank = self._level(k, left, A, lower, upper, first)
            slacks.append(slack)
            ranks.append(rank)
            first += lower.size
        zero = np.zeros(n)
        self._level(len(levels), left, np.eye(n), zero, zero, first)
        return CascadeResult(left.x, tuple(slacks), tuple(ranks))

    def _unbounded(self, levels: Sequence[LevelRows], n: int) -> CascadeResult | None:
        """The optimum where no bound matters, which is nearly every tick of a robot.

        What is lexicographically optimal without the inequalities, and happens to
        meet them all, is optimal with them.
        """
        equal = [lower == upper for _, lower, upper in levels]
        x, ranks = recursion(
            ((A[e], lower[e]) for (A, lower, _), e in zip(levels, equal, strict=True)),
            n,
            self._tolerance,
        )
        slacks = []
        for (A, lower, upper), e in zip(levels, equal, strict=True):
            value = A @ x
            slack = np.where(e, lower - value, 0.0)
            if not e.all() and ((value > upper) | (value < lower))[~e].any():
                return None
            slacks.append(slack)
        return CascadeResult(x, tuple(slacks), tuple(ranks))

    def _level(
        self, k: int, left: _Left, A: Array, lower: Array, upper: Array, first: int
    ) -> tuple[Array, int]:
        equal = lower == upper
        problem = self._problem(left, A, lower, upper, equal)
        ids = first + np.flatnonzero(~equal)
        try:
            point = solve_level(problem, self._guess(k, left.ids, ids), self._backend)
        except SolverError as error:
            self._memory.clear()
            raise SolverError(f"level {k + 1}: {error}", k) from error
        self._remember(k, left.ids, ids, point.work)
        left.x = left.x + left.Z @ point.z
        slack = _slack(A, left.x, lower, upper, equal, point)
        self._fix(left, A, lower, upper, slack, ids, point)
        return slack, point.rank

    def _problem(
        self, left: _Left, A: Array, lower: Array, upper: Array, equal: BoolArray
    ) -> LevelProblem:
        AZ, value, carried = A @ left.Z, A @ left.x, left.C @ left.x
        free = ~equal
        return LevelProblem(
            E=AZ[equal],
            e=lower[equal] - value[equal],
            I=AZ[free],
            i_lower=lower[free] - value[free],
            i_upper=upper[free] - value[free],
            C=left.C @ left.Z,
            c_lower=left.lower - carried,
            c_upper=left.upper - carried,
            scale=norm(A),
            tolerance=self._tolerance,
        )

    def _fix(
        self, left: _Left, A: Array, lower: Array, upper: Array, slack: Array,
        ids: IntArray, point: LevelPoint,
    ) -> None:  # fmt: skip
        """Take out what the level has fixed; carry on what it meets."""
        equal = lower == upper
        fixed = equal | (slack != 0.0)
        pushing = np.abs(point.multipliers) > point.pull
        scale = norm(A)
        rows = np.vstack([A[fixed] / scale, left.C[pushing]]) @ left.Z
        left.Z = left.Z @ factorise(rows, 1.0, self._tolerance).V2
        length = np.linalg.norm(A, axis=1)
        met = ~fixed & (length > 0.0) & (np.isfinite(lower) | np.isfinite(upper))
        unit, size, keep = A[met] / length[met, None], 1.0 / length[met], ~pushing
        value = unit @ left.x
        left.C = np.vstack([left.C[keep], unit])
        left.lower = np.append(left.lower[keep], np.minimum(lower[met] * size, value))
        left.upper = np.append(left.upper[keep], np.maximum(upper[met] * size, value))
        left.ids = np.append(left.ids[keep], ids[met[~equal]])
        movable = np.linalg.norm(left.C @ left.Z, axis=1) > GONE
        if not movable.all():
            left.C, left.ids = left.C[movable], left.ids[movable]
            left.lower, left.upper = left.lower[movable], left.upper[movable]

    def _guess(self, k: int, carried: IntArray, own: IntArray) -> WorkingSet | None:
        """The sides that the same rows had in this level at the last call."""
        if k not in self._memory:
            return None
        held, broken = self._memory[k]
        if not held and not broken:
            return None
        return WorkingSet(
            np.array([held.get(int(i), 0) for i in carried], np.int8),
            np.array([broken.get(int(i), 0) for i in own], np.int8),
        )

    def _remember(
        self, k: int, carried: IntArray, own: IntArray, work: WorkingSet
    ) -> None:
        self._memory[k] = tuple(  # type: ignore[assignment]
            {
                int(i): int(s)
                for i, s in zip(ids[sides != 0], sides[sides != 0], strict=True)
            }
            for ids, sides in ((carried, work.carried), (own, work.violated))
        )


def _slack(
    A: Array, x: Array, lower: Array, upper: Array, equal: BoolArray, point: LevelPoint
) -> Array:
    """S with lower <= A x + s <= upper: exactly zero for the inequalities met."""
    value = A @ x
    slack = lower - value
    side = np.zeros(value.size)
    side[~equal] = point.work.violated
    bound = np.where(side > 0.0, upper, lower)
    size = np.linalg.norm(A, axis=1) + np.abs(value)
    with np.errstate(invalid="ignore"):
        beyond = side * (value - bound) > FEASIBILITY * size
    return np.where(equal, slack, np.where(beyond, bound - value, 0.0))
