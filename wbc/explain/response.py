"""How the optimum of a hierarchy answers to its bounds.

With its active bounds known, a hierarchy is a cascade of equalities, so its optimum y
answers linearly to every bound b_j. The bounds that level k pays for stand just above
its own rows; passing down the levels,

    R <- R + Z (J Z)^+ (E - J R),      Z <- Z null(J Z),

with J the rows of a stage and E their selection, gives R = dy/db and Z, a basis of
what is left free. Hence, for the rows t of a level or of one of its tasks,

    d(1/2 |s_t|^2)/db_j = s_t^T (E_t - A_t R)_j.

For a level these are its multipliers, with all levels in between free to answer as
they would; for one of several tasks of a level they include the answer of its
neighbours. They hold as long as the same bounds stay active.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from wbc.arrays import Array, IntArray
from wbc.certificate import AT_BOUND, slack_of
from wbc.linalg import factorise, norm
from wbc.stack import Stack

__all__ = ["NEGLIGIBLE", "Response", "Tick", "responses"]

NEGLIGIBLE = 1e-7
"""A row that acts less than this, relative to the rows it acts on, is left out."""
GONE = 1e-9
"""A unit row keeping less than this of its norm can no longer be moved."""


class Tick:
    """All rows (m, n) at the solution, weighted, in coordinates of the kinetic metric.

    `side` is +1 or -1 where a row is met at its upper or lower bound; `wish` marks
    what a level minimises: equalities, and bounds that are broken.
    """

    def __init__(self, stack: Stack, vdot: Array) -> None:
        self.stack, self.vdot, self.torque = stack, vdot, stack.torque(vdot)
        A, lower, upper = stack.Ay, stack.lower, stack.upper
        self.y = stack.coordinates(vdot)
        value, self.norm = A @ self.y, np.linalg.norm(A, axis=1)
        size = self.norm * (1.0 + np.linalg.norm(self.y)) + np.abs(value)
        self.A, self.near = A, AT_BOUND * size
        self.slack = slack_of(A, self.y, lower, upper)
        self.missed = np.abs(self.slack) > self.near
        self.equal = lower == upper
        self.wish = self.equal | self.missed
        above, below = upper - value <= self.near, value - lower <= self.near
        self.side = np.where(self.wish, 0, np.where(above, 1, np.where(below, -1, 0)))
        self.unit = A / np.where(self.norm > 0.0, self.norm, 1.0)[:, None]
        self.owner = [(t, i) for t in stack.terms for i in range(len(t.names))]

    def slope(self, rows: slice, R: Array) -> Array:
        """D(1/2 |s_rows|^2)/db (m,), both weighted, where y answers with R (n, m)."""
        slack = self.slack[rows]
        slope = -(slack @ self.A[rows]) @ R
        slope[rows] += np.where(self.wish[rows], slack, 0.0)
        return slope


@dataclass(frozen=True, slots=True, eq=False)
class Response:
    """A level with all above it: R (n, m), its slope (m,), who is held for whom.

    Attributes:
        R: dy/db once the level is resolved.
        slope: d(1/2 |s_k|^2)/db, zero where it is round-off.
        held: (m,) the level, from 1, that first pays for an active bound, else 0.
        unique: whether no active bound so far depends on others.
    """

    R: Array
    slope: Array
    held: IntArray
    unique: bool


def responses(tick: Tick) -> Iterator[Response]:
    """Every level from the top, then the least norm."""
    m, n = tick.A.shape
    R, Z, held, unique = np.zeros((n, m)), np.eye(n), np.zeros(m, dtype=int), True
    index = np.arange(m)
    for k, where in enumerate(tick.stack.levels, 1):
        A, slack = tick.A[where], tick.slack[where]
        pull = A.T @ slack if tick.missed[where].any() else np.zeros(n)
        far = float(tick.near[where].max(initial=0.0))
        tiny = norm(A) * (0.1 * NEGLIGIBLE * float(np.linalg.norm(slack)) + 0.01 * far)
        may = (tick.side != 0) & (index < where.start)
        pushing, clear = _pushing(tick, Z, pull, np.flatnonzero(may), tiny)
        held, unique = held.copy(), unique and clear
        held[pushing] = k
        R, Z = _stage(tick.unit[pushing], pushing, tick.norm[pushing], R, Z)
        own = where.start + np.flatnonzero(tick.wish[where])
        R, Z = _stage(tick.A[own], own, np.ones(own.size), R, Z)
        slope = tick.slope(where, R) * float(tick.missed[where].any())
        yield Response(R, _without_noise(tick, slope, norm(A), slack), held, unique)
    size = 1.0 + float(np.linalg.norm(tick.y))
    sided = np.flatnonzero(tick.side)
    pushing, clear = _pushing(tick, Z, -tick.y, sided, NEGLIGIBLE * size)
    R, Z = _stage(tick.unit[pushing], pushing, tick.norm[pushing], R, Z)
    slope = _without_noise(tick, tick.y @ R, 1.0, tick.y)
    yield Response(R, slope, held, unique and clear)


def _pushing(
    tick: Tick, Z: Array, pull: Array, rows: IntArray, tiny: float
) -> tuple[IntArray, bool]:
    """Which of the rows at a bound a level leans on, and whether no others could."""
    G = (tick.unit[rows] * tick.side[rows, None]) @ Z
    alive = np.linalg.norm(G, axis=1) > GONE
    rows, G = rows[alive], G[alive]
    if rows.size == 0 or not pull.any():
        return rows[:0], True
    pressure, _ = nnls(G.T, Z.T @ pull)
    clear = int(np.linalg.matrix_rank(G, tol=GONE)) == rows.size
    return rows[pressure > tiny], clear


def _stage(
    J: Array, rows: IntArray, length: Array, R: Array, Z: Array
) -> tuple[Array, Array]:
    """Resolve J dy = db / length within Z: the new dy/db (n, m), and the new Z."""
    E = np.zeros((rows.size, R.shape[1]))
    E[np.arange(rows.size), rows] = 1.0 / length
    factor = factorise(J @ Z, norm(J))
    answer = factor.V1 @ ((factor.U.T @ (E - J @ R)) / factor.sigma[:, None])
    return R + Z @ answer, Z @ factor.V2


def _without_noise(tick: Tick, slope: Array, size: float, slack: Array) -> Array:
    least = NEGLIGIBLE * size * float(np.linalg.norm(slack))
    clear: Array = np.where(np.abs(slope) * tick.norm > least, slope, 0.0)
    return clear
