"""Proof of lexicographic optimality: the KKT conditions of every level, re-derived.

A point x is optimal for a hierarchy exactly when, for every level k, multipliers
exist with

    A_k^T s_k = sum over rows j above k of lambda_j a_j,

lambda_j >= 0 where row j is met at its upper bound, <= 0 at its lower bound, free
where it is an equality or cannot be met, and 0 where it is met away from its bounds.
Everything is computed from the rows and x alone, by non-negative least squares; no
solver is asked or believed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from scipy.optimize import nnls

from wbc.arrays import Array, positive
from wbc.cascade import LevelRows
from wbc.errors import SolverError

__all__ = ["Certificate", "LevelProof", "certify", "slack_of"]

INDEPENDENT = 1e-13
"""Rows above that keep more than this of their norm count as independent."""
BEYOND = 1e-11
"""A row this far beyond a bound, relative to its norm and |x|, is violated: its level
pushes it already, so levels below may push or pull."""
AT_BOUND = 1e-7
"""A row this close to a bound, relative to norm and size, may push back there."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class LevelProof:
    """The conditions of one level.

    Attributes:
        slack: (m_k,) s_k.
        multipliers: one (m_j,) array for each level j above: the price, in this
            level's squared residual, per unit of that row's bound.
        residual: |A_k^T s_k - sum lambda_j a_j|, relative to |A_k| and |s_k| (or 1).
        complementarity: largest |multiplier| times distance from its bound, relative
            in the same way.
        disturbed: largest change of the slack since the level was solved, in units of
            the row (0 where the resolver does not tell).
    """

    slack: Array
    multipliers: tuple[Array, ...]
    residual: float
    complementarity: float
    disturbed: float


@final
@dataclass(frozen=True, slots=True, eq=False)
class Certificate:
    """One proof a level, from the top.

    Attributes:
        levels: the proofs; the last one is that of the least norm.
    """

    levels: tuple[LevelProof, ...]

    @property
    def worst(self) -> float:
        """Largest residual, complementarity or disturbance; 0 is a perfect proof."""
        return max(max(p.residual, p.complementarity, p.disturbed) for p in self.levels)

    def holds(self, tolerance: float = 1e-8) -> bool:
        """Whether every condition of every level holds to the tolerance.

        Raises:
            InputError: the tolerance is not a number of at least 0.
        """
        return bool(self.worst <= positive(tolerance, "tolerance", zero=True))

    def __repr__(self) -> str:
        rows = [
            f"  level {k}: residual {p.residual:.1e}, complementarity "
            f"{p.complementarity:.1e}, disturbed {p.disturbed:.1e}"
            for k, p in enumerate(self.levels, 1)
        ]
        return "\n".join([f"Certificate(worst {self.worst:.1e})", *rows])


def slack_of(A: Array, x: Array, lower: Array, upper: Array) -> Array:
    """The least s (m,) with lower <= A x + s <= upper."""
    value = A @ x
    return np.clip(value, lower, upper) - value


def certify(
    levels: Sequence[LevelRows], x: Array, solved: Sequence[Array] | None = None
) -> Certificate:
    """Check that x (n,) is the lexicographic minimiser of the levels, of least norm.

    Args:
        levels: (A, lower, upper) from the top.
        x: the point, in coordinates in which least norm is the last wish.
        solved: each level's slack at the time it was solved.

    Raises:
        SolverError: numbers too large to calculate with, or no multipliers found.
    """
    n = x.size
    least = (np.eye(n), np.zeros(n), np.zeros(n))
    proofs = []
    above: list[_Above] = []
    for k, (A, lower, upper) in enumerate([*levels, least]):
        slack = slack_of(A, x, lower, upper)
        then = solved[k] if solved is not None and k < len(levels) else slack
        try:
            with np.errstate(over="ignore", invalid="ignore"):  # the error says it
                proofs.append(_prove(A, slack, then, above))
        except (ValueError, RuntimeError) as error:  # of numpy and scipy
            raise SolverError(
                f"optimality of level {k} cannot be proven ({error}): it pulls with "
                f"{np.abs(slack).max():.1e}. Look for an absurd measurement or target.",
                k,
            ) from error
        above.append(_Above.at(A, x, lower, upper))
    return Certificate(tuple(proofs))


@dataclass(frozen=True, slots=True, eq=False)
class _Above:
    """A level seen from below: which of its rows may push, and which way."""

    A: Array
    free: Array
    side: Array
    distance: Array

    @classmethod
    def at(cls, A: Array, x: Array, lower: Array, upper: Array) -> _Above:
        value = A @ x
        norm = np.linalg.norm(A, axis=1)
        near = AT_BOUND * (norm * (1.0 + np.linalg.norm(x)) + np.abs(value))
        to_upper, to_lower = upper - value, value - lower
        beyond = near * (BEYOND / AT_BOUND)
        free = (lower == upper) | (to_upper < -beyond) | (to_lower < -beyond)
        nearer = np.where(to_upper <= to_lower, 1, -1)
        side = np.where(np.minimum(to_upper, to_lower) <= near, nearer, 0)
        distance = np.where(side > 0, to_upper, np.where(side < 0, to_lower, 0.0))
        return cls(A, free, np.where(free, 0, side), np.where(free, 0.0, distance))


def _prove(A: Array, slack: Array, then: Array, above: list[_Above]) -> LevelProof:
    pull = A.T @ slack
    size = float(np.linalg.norm(A)) * max(1.0, float(np.linalg.norm(slack))) or 1.0
    flat, rest = _multipliers(above, pull)
    distance = np.concatenate([a.distance for a in above]) if above else np.zeros(0)
    sizes = [a.free.size for a in above]
    return LevelProof(
        slack=slack,
        multipliers=tuple(np.split(flat, np.cumsum(sizes)[:-1])) if above else (),
        residual=float(np.linalg.norm(rest)) / size,
        complementarity=float(np.abs(flat * distance).max(initial=0.0)) / size,
        disturbed=float(np.abs(slack - then).max(initial=0.0)),
    )


def _multipliers(above: list[_Above], pull: Array) -> tuple[Array, Array]:
    """Multipliers of all rows above, and what of the pull they leave over."""
    if not above:
        return np.zeros(0), pull
    A = np.vstack([a.A for a in above])
    norm = np.linalg.norm(A, axis=1)
    unit = A / np.where(norm > 0.0, norm, 1.0)[:, None]
    free = np.concatenate([a.free for a in above]) & (norm > 0.0)
    side = np.concatenate([a.side for a in above]) * (norm > 0.0)
    Q = _range(unit[free])
    across = (unit - unit @ Q @ Q.T) * side[:, None]
    length = np.linalg.norm(across, axis=1)
    signed = np.flatnonzero(length > INDEPENDENT)  # the others push like free rows
    flat = np.zeros(norm.size)
    if signed.size:
        towards = (across[signed] / length[signed, None]).T  # nnls overlooks short ones
        found = nnls(towards, pull - Q @ (Q.T @ pull))[0]
        flat[signed] = found / length[signed] * side[signed]
    left = pull - unit.T @ flat
    flat[free] = np.linalg.lstsq(unit[free].T, left, rcond=INDEPENDENT)[0]
    rest = pull - unit.T @ flat
    return flat / np.where(norm > 0.0, norm, 1.0), rest


def _range(rows: Array) -> Array:
    """Orthonormal basis (n, r) of the span of the rows."""
    if rows.shape[0] == 0:
        return np.zeros((rows.shape[1], 0))
    _, sigma, Vt = np.linalg.svd(rows, full_matrices=False)
    return Vt[sigma > INDEPENDENT * max(1.0, float(sigma[0]))].T
