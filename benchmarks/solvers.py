"""Solvers of strict hierarchies behind one interface.

`contenders` is the list; a solver of one's own is one class and one line there.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
import qpsolvers
from numpy.typing import NDArray

from benchmarks.problems import Problem
from wbc import WbcError, solve_hierarchy
from wbc.lexicographic import Lexicographic
from wbc.qp import OPTIONS

__all__ = ["BASELINE", "OURS", "Failed", "Solver", "contenders"]

Array = NDArray[np.float64]

OURS, PUBLIC = "wbc", "wbc.solve_hierarchy"
BASELINE = "daqp hierarchical"
REGULAR = 1e-7
"""Weight of |x|^2 in a cascade's QPs: less and they fail, more and they leak."""


class Failed(RuntimeError):
    """A solver gave no answer."""


class Solver(Protocol):
    """A solver prepared for problems of one shape.

    Attributes:
        name: what the table calls it.
        remembers: whether a second call profits from the first.
    """

    name: str
    remembers: bool

    def reset(self) -> None:
        """Forget the last call."""

    def solve(self, problem: Problem) -> Array:
        """The minimiser (n,); what is timed."""


class Native:
    """Our compiled solver, as an object that keeps its working set."""

    name, remembers = OURS, True

    def __init__(self, problem: Problem) -> None:
        self._solver = Lexicographic(problem.sizes, problem.n)

    def reset(self) -> None:
        """Forget the working set."""
        self._solver.reset()

    def solve(self, problem: Problem) -> Array:
        """The minimiser, a view that the next call overwrites."""
        if not self._solver.solve(problem.A, problem.lower, problem.upper):
            raise Failed
        return self._solver.x


class Public:
    """`wbc.solve_hierarchy`: checks its input, builds a result, remembers nothing.

    With a backend it is our null-space cascade; without, the compiled solver.
    """

    remembers = False

    def __init__(self, problem: Problem, backend: str | None = None) -> None:
        self.name = f"wbc.solve_hierarchy, {backend}" if backend else PUBLIC
        self._backend = backend

    def reset(self) -> None:
        """Nothing to forget."""

    def solve(self, problem: Problem) -> Array:
        """The minimiser."""
        try:
            return solve_hierarchy(problem.levels(), self._backend).x
        except WbcError as error:
            raise Failed from error


class Daqp:
    """DAQP's hierarchical mode; a box goes in as simple bounds, all levels are soft.

    It has no warm start for hierarchies.
    """

    name, remembers = BASELINE, False

    def __init__(self, problem: Problem) -> None:
        import daqp

        self._solve = daqp.solve
        self._sense = np.zeros(problem.lower.size, dtype=np.int32)
        # The first entry counts hard rows: none.
        self._ends = np.cumsum([0, *problem.sizes]).astype(np.int32)

    def reset(self) -> None:
        """Nothing to forget."""

    def solve(self, problem: Problem) -> Array:
        """The minimiser; f is None, since zeros of the documented call fail."""
        x, _, flag, _ = self._solve(
            None, None, problem.general, problem.upper, problem.lower,
            self._sense, self._ends,
        )  # fmt: skip
        if flag not in (1, 2):  # 3: gave up in a level and restored the last point
            raise Failed
        return x


class TextbookCascade:
    """One QP a level with slack variables, higher levels frozen (Kanoun 2011).

    What people write around a QP solver; matrices are assembled with numpy.
    """

    remembers = False

    def __init__(self, problem: Problem, backend: str) -> None:
        self.name, self._backend = f"cascade of {backend} QPs", backend
        self._options = OPTIONS.get(backend, {})

    def reset(self) -> None:
        """Nothing to forget."""

    def solve(self, problem: Problem) -> Array:
        """The minimiser of the last level."""
        n, x = problem.n, np.zeros(problem.n)
        frozen = _Rows(np.zeros((0, n)), np.zeros(0), np.zeros(0))
        for A, lower, upper in problem.levels():
            z = self._level(n, frozen, A, lower, upper)
            x, w = z[:n], z[n:]
            frozen = _Rows(
                np.vstack([frozen.A, A]),
                np.concatenate([frozen.lower, lower - w]),
                np.concatenate([frozen.upper, upper - w]),
            )
        return x

    def _level(
        self, n: int, frozen: _Rows, A: Array, lower: Array, upper: Array
    ) -> Array:
        """(x, w): least |w|^2 with lower <= A x + w <= upper under what is frozen."""
        m, f = lower.size, frozen.lower.size
        P = np.diag(np.concatenate([np.full(n, REGULAR), np.ones(m)]))
        rows = np.block([[frozen.A, np.zeros((f, m))], [A, np.eye(m)]])
        low = np.concatenate([frozen.lower, lower])
        high = np.concatenate([frozen.upper, upper])
        equal = low == high
        G = np.vstack([rows[~equal], -rows[~equal]])
        h = np.concatenate([high[~equal], -low[~equal]])
        qp = qpsolvers.Problem(P, np.zeros(n + m), G, h, rows[equal], low[equal])
        try:
            found = qpsolvers.solve_problem(qp, self._backend, **self._options).x
        except Exception as error:  # each backend raises its own kinds
            raise Failed from error
        if found is None:
            raise Failed
        return found


class _Rows:
    """Rows of higher levels, kept where their optimum left them."""

    def __init__(self, A: Array, lower: Array, upper: Array) -> None:
        self.A, self.lower, self.upper = A, lower, upper


def contenders(problem: Problem, *, cascades: bool = True) -> list[Solver]:
    """Every solver on this machine, prepared for problems of this shape."""
    installed = qpsolvers.available_solvers
    solvers: list[Solver] = [Native(problem), Public(problem)]
    if "daqp" in installed:
        solvers.append(Daqp(problem))
    if cascades:
        solvers += [Public(problem, name) for name in installed]
        solvers += [TextbookCascade(problem, name) for name in installed]
    return solvers
