"""One level of a strict hierarchy, in the coordinates that upper levels leave free.

    minimise  1/2 |e - E z|^2 + 1/2 |s|^2
    subject to  lower_i <= I_i z + s_i <= upper_i   (the level's own inequalities)
                lower_j <= C_j z       <= upper_j   (those that upper levels meet)

A working set says which of the two kinds of row sits at a bound, and on which side.
Given the set the level is one linear least-squares problem, so its solution is exact
to round-off; this module poses it and judges the answer.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, final

import numpy as np
from numpy.typing import NDArray

from wbc.arrays import Array, BoolArray
from wbc.linalg import Factor, factorise

__all__ = ["LevelPoint", "LevelProblem", "Sides", "WorkingSet", "faults", "minimise_on"]

Sides = NDArray[np.int8]

FEASIBILITY = 1e-9
"""Rows are compared with their bounds to this, relative to norm and size."""
SIGN = 1e-9
"""A multiplier below this, relative to the level's forces, has no sign."""
NOISE = 1e-12
"""Round-off of the forces, relative to the size of the rows and targets."""


@final
@dataclass(slots=True, eq=False)
class LevelProblem:
    """The matrices above, every row of C and I with its norm.

    Attributes:
        E: (a, r), e: (a,) equality rows.
        I: (b, r), i_lower, i_upper: (b,) inequality rows of the level.
        C: (c, r), c_lower, c_upper: (c,) carried rows, of unit norm in full space.
        scale: norm of the level's rows before projection.
        tolerance: relative rank tolerance.
    """

    E: Array
    e: Array
    I: Array  # noqa: E741 - the letter of the formula above
    i_lower: Array
    i_upper: Array
    C: Array
    c_lower: Array
    c_upper: Array
    scale: float
    tolerance: float


class WorkingSet(NamedTuple):
    """Which rows sit at a bound: +1 upper, -1 lower, 0 neither.

    Attributes:
        carried: (c,) rows held at a bound as constraints.
        violated: (b,) rows of the level that cannot be met.
    """

    carried: Sides
    violated: Sides

    @classmethod
    def empty(cls, problem: LevelProblem) -> WorkingSet:
        """No row at a bound."""
        return cls(
            np.zeros(problem.c_lower.size, np.int8),
            np.zeros(problem.i_lower.size, np.int8),
        )


class LevelPoint(NamedTuple):
    """A level's minimiser for one working set.

    Attributes:
        z: (r,) the point.
        work: the working set.
        multipliers: (c,) of the carried rows, positive at an upper bound.
        pull: |multipliers| below this are round-off.
        rank: independent directions used by the level's rows.
    """

    z: Array
    work: WorkingSet
    multipliers: Array
    pull: float
    rank: int


@final
@dataclass(frozen=True, slots=True, eq=False)
class Faults:
    """What keeps a point from being the level's minimiser.

    Attributes:
        outside: (c,) signed distance of carried rows beyond a bound, 0 within.
        beyond: (b,) the same for the level's rows that are not held as violated.
        wrong: (c,) how much a held row's multiplier pulls instead of pushing.
        met: (b,) rows held as violated although they are met.
    """

    outside: Array
    beyond: Array
    wrong: Array
    met: BoolArray

    @property
    def none(self) -> bool:
        """Whether the point is optimal."""
        return not (
            self.outside.any()
            or self.beyond.any()
            or self.wrong.any()
            or self.met.any()
        )


def minimise_on(problem: LevelProblem, start: Array, work: WorkingSet) -> LevelPoint:
    """Least squares on the working set, moving from `start` as little as possible."""
    on = work.carried != 0
    T, t = _targets(problem, work)
    multipliers = np.zeros(work.carried.size)
    z, Q, held = start, np.eye(start.size), None
    if on.any():
        bound = np.where(work.carried > 0, problem.c_upper, problem.c_lower)[on]
        held = factorise(problem.C[on], 1.0, problem.tolerance)
        z = start + held.solve(bound - problem.C[on] @ start)
        Q = held.V2
    free = factorise(T @ Q, problem.scale, problem.tolerance)
    z = z + Q @ free.solve(t - T @ z)
    slack = t - T @ z
    forces = float(np.linalg.norm(T)) if T.size else 0.0
    round_off = NOISE * (1.0 + float(np.linalg.norm(t)))
    pull = forces * SIGN * float(np.linalg.norm(slack)) + problem.scale * round_off
    rank = free.rank
    if held is not None:
        multipliers[on] = _transpose_solve(held, T.T @ slack)
        whole = factorise(T, problem.scale, problem.tolerance)
        rank = whole.rank
    return LevelPoint(z, work, multipliers, pull, rank)


def faults(problem: LevelProblem, point: LevelPoint) -> Faults:
    """Compare a point with the optimality conditions of the level."""
    carried, violated = point.work
    outside = signed_excess(
        problem.C @ point.z, problem.c_lower, problem.c_upper, np.ones(carried.size)
    )
    value = problem.I @ point.z
    norm = np.linalg.norm(problem.I, axis=1)
    excess = signed_excess(value, problem.i_lower, problem.i_upper, norm)
    signed = point.multipliers * carried
    bound = np.where(violated > 0, problem.i_upper, problem.i_lower)
    inside = np.where(violated > 0, bound - value, value - bound)
    met = (violated != 0) & (inside > FEASIBILITY * (norm + np.abs(value)))
    return Faults(
        outside=outside,
        beyond=np.where(violated != 0, 0.0, excess),
        wrong=np.where(signed < -point.pull, -signed, 0.0),
        met=met,
    )


def signed_excess(value: Array, lower: Array, upper: Array, norm: Array) -> Array:
    """Signed distance outside the bounds per unit of row, 0 within tolerance."""
    size = np.maximum(norm, 1e-300)
    above, below = (value - upper) / size, (lower - value) / size
    bound = np.where(above > below, upper, lower)
    known = np.where(np.isfinite(bound), np.abs(bound), 0.0)
    limit = FEASIBILITY * (1.0 + known / size)
    return np.where(above > limit, above, np.where(below > limit, -below, 0.0))


def _targets(problem: LevelProblem, work: WorkingSet) -> tuple[Array, Array]:
    """Rows and targets of the least-squares problem that `work` defines."""
    on = work.violated != 0
    if not on.any():
        return problem.E, problem.e
    bound = np.where(work.violated > 0, problem.i_upper, problem.i_lower)
    return np.vstack([problem.E, problem.I[on]]), np.concatenate([problem.e, bound[on]])


def _transpose_solve(factor: Factor, g: Array) -> Array:
    """Least-squares solution of A^T x = g for the factorised A."""
    return factor.U @ ((factor.V1.T @ g) / factor.sigma)
