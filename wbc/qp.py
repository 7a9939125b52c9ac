"""The only door to the QP backends: one small dense QP in, its minimiser out."""

from __future__ import annotations

import warnings
from typing import Any, final

import numpy as np
import qpsolvers

from wbc.arrays import Array
from wbc.checks import known
from wbc.errors import SolverError

__all__ = ["DEFAULT_BACKEND", "QpBackend", "backends"]

DEFAULT_BACKEND = "proxqp"
"""Of the cascade, where a backend is not named."""

OPTIONS: dict[str, dict[str, Any]] = {
    "proxqp": {"eps_abs": 1e-10, "eps_rel": 0.0, "backend": "dense"},
    "daqp": {"dual_tol": 1e-11, "primal_tol": 1e-10},
    "clarabel": {"tol_feas": 1e-10, "tol_gap_abs": 1e-10, "tol_gap_rel": 1e-10},
    "osqp": {"eps_abs": 1e-9, "eps_rel": 1e-9, "max_iter": 50_000, "polishing": True},
    "piqp": {"eps_abs": 1e-10, "eps_rel": 1e-10},
    "scs": {"eps_abs": 1e-9, "eps_rel": 1e-9, "max_iters": 100_000},
    "qpax": {"solver_tol": 1e-9},
}
"""Tolerances, because the defaults (1e-5 for ProxQP) are looser than a level's
bounds may be disturbed. A backend that is not listed keeps its own."""


def backends() -> list[str]:
    """Names of the installed backends that take dense problems."""
    return list(qpsolvers.available_solvers)


@final
class QpBackend:
    """minimise 1/2 x^T P x + q^T x subject to lower <= G x <= upper.

    Args:
        name: one of `backends()`.

    Raises:
        UnknownName: not installed, or unknown to qpsolvers.
    """

    def __init__(self, name: str = DEFAULT_BACKEND) -> None:
        self.name = known("QP backend", name, backends())
        self._options = OPTIONS.get(name, {})

    def solve(
        self, P: Array, q: Array, G: Array, lower: Array, upper: Array, start: Array
    ) -> tuple[Array, Array]:
        """The minimiser (n,) and the multipliers of G's rows, positive at the upper.

        `start` (n,) is a feasible point, handed to backends that can begin at one.

        Raises:
            SolverError: the backend found none; its own exceptions never leak.
        """
        below, above = np.isfinite(lower), np.isfinite(upper)
        rows = np.vstack([G[above], -G[below]])
        bounds = np.concatenate([upper[above], -lower[below]])
        problem = qpsolvers.Problem(
            P, q, rows if rows.size else None, bounds if rows.size else None
        )
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # sparse conversions, inexact status
                found = qpsolvers.solve_problem(
                    problem, self.name, initvals=start, **self._options
                )
        except Exception as error:  # each backend raises its own kinds
            raise SolverError(f"QP backend '{self.name}' raised: {error}") from error
        x = found.x
        if x is None or not np.isfinite(x).all():
            raise SolverError(f"QP backend '{self.name}' found no solution.")
        duals = np.zeros(lower.size)
        if found.z is not None and found.z.size == bounds.size:
            duals[above] = found.z[: above.sum()]
            duals[below] -= found.z[above.sum() :]
        return np.asarray(x, dtype=np.float64), duals
