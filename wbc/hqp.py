"""Strict hierarchical QP: the resolver, and the solver for people with own matrices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from wbc.arrays import Array, BoolArray, numbers
from wbc.cascade import Cascade, CascadeResult, LevelRows
from wbc.certificate import Certificate, certify
from wbc.errors import InputError, shown
from wbc.lexicographic import Lexicographic
from wbc.qp import DEFAULT_BACKEND, QpBackend
from wbc.resolver import Answer, Resolver, Solver, Status
from wbc.stack import Stack
from wbc.state import State

__all__ = ["HierarchicalQP", "HierarchyResult", "solve_hierarchy"]

AT_BOUND = 1e-9
"""A row this close to a bound, relative to its value, counts as active."""


@final
class HierarchicalQP(Resolver):
    """Each level exact in the least-squares sense, all higher ones kept at their best.

    Inequalities may stand at any level. It is never infeasible: what cannot be met
    shows as the slack of its level. Freedom left over minimises vdot^T M vdot.

    Args:
        backend: None for the compiled solver of `wbc.lexicographic`; or a QP backend
            of `wbc.qp.backends()`, for a cascade of one small QP a level.

    Raises:
        UnknownName: the backend is not installed.
    """

    def __init__(self, backend: str | None = None) -> None:
        self._backend = None if backend is None else QpBackend(backend)
        self.name = "hqp" if backend is None else f"hqp:{backend}"

    def start(self, stack: Stack) -> Solver:
        """A solver with a warm start of its own."""
        if self._backend is None:
            return _Compiled(stack)
        return _Cascading(self._backend, stack)


class _Compiled(Solver):
    """The compiled solver at work, in the coordinates of least kinetic norm."""

    def __init__(self, stack: Stack) -> None:
        sizes = [where.stop - where.start for where in stack.levels]
        self._stack, self._solver = stack, Lexicographic(sizes, stack.robot.nv)
        self._size = stack.parts.ranks.stop
        stack.connect(self._solver.address)

    def tick(self, stack: Stack, state: State) -> Array:
        """The same in one compiled call."""
        found = np.empty(self._size)
        stack.run(state, found)
        return found

    def solve(self) -> Answer:
        """Resolve the present rows."""
        stack, solver = self._stack, self._solver
        done = solver.solve(stack.Ay, stack.lower, stack.upper)
        status = Status.SOLVED if done else Status.INCOMPLETE
        vdot = stack.acceleration(solver.x)
        return Answer(vdot, solver.ranks, status, solver.slack.copy())


class _Cascading(Solver):
    """The cascade at work, in the same coordinates."""

    def __init__(self, backend: QpBackend, stack: Stack) -> None:
        self._stack, self._cascade = stack, Cascade(backend)

    def solve(self) -> Answer:
        """Resolve the present rows."""
        stack = self._stack
        levels = [(stack.Ay[k], stack.lower[k], stack.upper[k]) for k in stack.levels]
        result = self._cascade.solve(levels, stack.robot.nv)
        slacks = np.concatenate(result.slacks)
        vdot = stack.acceleration(result.x)
        return Answer(vdot, np.array(result.ranks), Status.SOLVED, slacks)


@final
@dataclass(frozen=True, slots=True, eq=False)
class HierarchyResult:
    """The lexicographic minimiser of a list of levels.

    Attributes:
        x: (n,) the point, of least norm where it is free.
        slacks: for each level (m_k,) s_k with lower_k <= A_k x + s_k <= upper_k.
        active: for each level (m_k,) whether the row is at a bound or beyond it.
        ranks: for each level, the independent directions it could use.
        status: SOLVED; INCOMPLETE where the compiled solver ran out of iterations.
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
        backend: None for the compiled solver, or a QP backend for a cascade.

    Raises:
        InputError: no level, shapes that do not fit, NaN, or lower > upper.
        UnknownName: the backend is not installed.
        SolverError: the backend of a cascade led to no optimal point.

    Example:
        >>> result = solve_hierarchy([([[1.0, 0.0]], [-1.0], [1.0]),
        ...                           ([[1.0, 1.0]], [3.0], [3.0])])
        >>> result.x.round(6).tolist()
        [1.0, 2.0]
    """
    rows = _checked(levels)
    result, status = (_alone if backend is None else _cascade)(rows, backend)
    active = tuple(
        _at_bound(A @ result.x, lower, upper) | (slack != 0.0)
        for (A, lower, upper), slack in zip(rows, result.slacks, strict=True)
    )
    return HierarchyResult(
        result.x, result.slacks, active, result.ranks, status, tuple(rows)
    )


def _alone(rows: list[LevelRows], _: str | None) -> tuple[CascadeResult, Status]:
    """By the compiled solver."""
    sizes = [lower.size for _, lower, _ in rows]
    solver = Lexicographic(sizes, rows[0][0].shape[1])
    A, lower, upper = (np.concatenate(arrays) for arrays in zip(*rows, strict=True))
    A = np.ascontiguousarray(A)  # levels by columns are put together by columns
    done = solver.solve(A, lower, upper)
    slacks = tuple(np.split(solver.slack.copy(), np.cumsum(sizes)[:-1]))
    status = Status.SOLVED if done else Status.INCOMPLETE
    ranks = tuple(solver.ranks.tolist())
    return CascadeResult(solver.x.copy(), slacks, ranks), status


def _cascade(rows: list[LevelRows], name: str | None) -> tuple[CascadeResult, Status]:
    """By a cascade over a QP backend."""
    n = rows[0][0].shape[1]
    backend = QpBackend(DEFAULT_BACKEND if name is None else name)
    return Cascade(backend).solve(rows, n), Status.SOLVED


def _at_bound(value: Array, lower: Array, upper: Array) -> BoolArray:
    near = AT_BOUND * (1.0 + np.abs(value))
    return (np.abs(lower - value) < near) | (np.abs(upper - value) < near)


def _checked(
    levels: Sequence[tuple[ArrayLike, ArrayLike, ArrayLike]],
) -> list[LevelRows]:
    try:
        triples = [(A, lower, upper) for A, lower, upper in levels]
    except (TypeError, ValueError) as error:
        raise InputError(
            f"levels must be triples (A, lower, upper), got {shown(levels)}."
        ) from error
    if not triples:
        raise InputError("solve_hierarchy needs at least one level.")
    rows: list[LevelRows] = []
    for k, (A, lower, upper) in enumerate(triples, 1):
        matrix = numbers(A, f"A of level {k}")
        low, high = (numbers(b, f"a bound of level {k}") for b in (lower, upper))
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
