"""Strict hierarchical QP: the resolver, and the solver for people with own matrices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from wbc.arrays import Array, BoolArray
from wbc.cascade import Cascade, LevelRows
from wbc.certificate import Certificate, certify
from wbc.errors import InputError
from wbc.qp import DEFAULT_BACKEND, QpBackend
from wbc.resolver import Answer, Resolver, Solver, Status
from wbc.stack import Stack

__all__ = ["HierarchicalQP", "HierarchyResult", "solve_hierarchy"]


@final
class HierarchicalQP(Resolver):
    """Each level exact in the least-squares sense, all higher ones kept at their best.

    Inequalities may stand at any level. It is never infeasible: what cannot be met
    shows as the slack of its level. Freedom left over minimises vdot^T M vdot.

    Args:
        backend: a QP backend of `wbc.qp.backends()`; ProxQP by default.

    Raises:
        UnknownName: the backend is not installed.
    """

    def __init__(self, backend: str = DEFAULT_BACKEND) -> None:
        self._backend = QpBackend(backend)
        self.name = "hqp" if backend == DEFAULT_BACKEND else f"hqp:{backend}"

    def start(self, stack: Stack) -> Solver:
        """A solver with a warm start of its own."""
        return _Strict(self._backend, stack)


class _Strict(Solver):
    """The cascade at work on a stack, in the coordinates of least kinetic norm."""

    def __init__(self, backend: QpBackend, stack: Stack) -> None:
        self._stack, self._cascade = stack, Cascade(backend)

    def solve(self) -> Answer:
        """Resolve the present rows."""
        stack = self._stack
        levels = [(stack.Ay[k], stack.lower[k], stack.upper[k]) for k in stack.levels]
        result = self._cascade.solve(levels, stack.robot.nv)
        slacks = np.concatenate(result.slacks)
        vdot = stack.L_inv.T @ result.x
        return Answer(vdot, result.ranks, Status.SOLVED, slacks)


@final
@dataclass(frozen=True, slots=True, eq=False)
class HierarchyResult:
    """The lexicographic minimiser of a list of levels.

    Attributes:
        x: (n,) the point, of least norm where it is free.
        slacks: for each level (m_k,) s_k with lower_k <= A_k x + s_k <= upper_k.
        active: for each level (m_k,) whether the row is at a bound or beyond it.
        ranks: for each level, the independent directions it could use.
        status: SOLVED.
    """

    x: Array
    slacks: tuple[Array, ...]
    active: tuple[BoolArray, ...]
    ranks: tuple[int, ...]
    status: Status
    _levels: tuple[LevelRows, ...]

    def certificate(self) -> Certificate:
        """Proof of optimality, from the matrices and x alone."""
        return certify(self._levels, self.x, self.slacks)

    @property
    def multipliers(self) -> tuple[tuple[Array, ...], ...]:
        """For each level, the prices of the rows of every level above."""
        return tuple(proof.multipliers for proof in self.certificate().levels[:-1])


def solve_hierarchy(
    levels: Sequence[tuple[ArrayLike, ArrayLike, ArrayLike]],
    backend: str | None = None,
) -> HierarchyResult:
    """Minimise |s_1|, then |s_2|, ... with lower_k <= A_k x + s_k <= upper_k.

    Args:
        levels: (A (m, n), lower (m,), upper (m,)) from the most important down;
            an equality where lower = upper, +-inf where there is no bound.
        backend: a QP backend; ProxQP by default.

    Raises:
        InputError: no level, shapes that do not fit, NaN, or lower > upper.
        UnknownName: the backend is not installed.
        SolverError: the backend led to no optimal point.

    Example:
        >>> result = solve_hierarchy([([[1.0, 0.0]], [-1.0], [1.0]),
        ...                           ([[1.0, 1.0]], [3.0], [3.0])])
        >>> result.x.round(6).tolist()
        [1.0, 2.0]
    """
    rows = _checked(levels)
    n = rows[0][0].shape[1]
    result = Cascade(QpBackend(backend or DEFAULT_BACKEND)).solve(rows, n)
    active = tuple(
        (np.abs(lower - A @ result.x) < 1e-9 * (1 + np.abs(A @ result.x)))
        | (np.abs(upper - A @ result.x) < 1e-9 * (1 + np.abs(A @ result.x)))
        | (slack != 0.0)
        for (A, lower, upper), slack in zip(rows, result.slacks, strict=True)
    )
    return HierarchyResult(
        result.x, result.slacks, active, result.ranks, Status.SOLVED, tuple(rows)
    )


def _checked(
    levels: Sequence[tuple[ArrayLike, ArrayLike, ArrayLike]],
) -> list[LevelRows]:
    if not levels:
        raise InputError("solve_hierarchy needs at least one level.")
    rows: list[LevelRows] = []
    for k, (A, lower, upper) in enumerate(levels, 1):
        matrix = np.array(A, dtype=np.float64)
        low, high = (np.array(b, dtype=np.float64) for b in (lower, upper))
        n = rows[0][0].shape[1] if rows else matrix.shape[-1] if matrix.ndim else 0
        if matrix.ndim != 2 or matrix.shape[1] != n or n == 0:
            raise InputError(
                f"level {k}: A has shape {matrix.shape}; it must be (m, {n})."
            )
        if low.shape != (matrix.shape[0],) or high.shape != low.shape:
            raise InputError(
                f"level {k}: bounds have shapes {low.shape} and {high.shape}; need "
                f"({matrix.shape[0]},)."
            )
        if not np.isfinite(matrix).all() or np.isnan(low).any() or np.isnan(high).any():
            raise InputError(f"level {k} contains NaN, or an infinite coefficient.")
        if (low > high).any() or (low == np.inf).any() or (high == -np.inf).any():
            row = int(np.argmax((low > high) | (low == np.inf) | (high == -np.inf)))
            raise InputError(
                f"level {k}, row {row}: lower bound {low[row]} and upper bound "
                f"{high[row]} leave no number between them."
            )
        rows.append((matrix, low, high))
    return rows
