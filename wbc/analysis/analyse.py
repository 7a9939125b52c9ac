"""Ranks of a hierarchy's equality rows, level by level, and the rows that add nothing.

The recursion is that of `wbc.linalg`: with Z a basis of what the levels above leave,
a level's rank is that of its rows A Z, relative to the norm of A before projection.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, get_args

import numpy as np

from wbc.analysis.data import Analysis, Dependency, LevelAnalysis, Metric
from wbc.arrays import Array, positive
from wbc.assembly import NOTHING
from wbc.checks import expect, known
from wbc.errors import SolverError
from wbc.linalg import RANK_TOLERANCE, factorise, norm
from wbc.rows import allocate_rows
from wbc.state import State

if TYPE_CHECKING:
    from wbc.hierarchy import Hierarchy, Level
    from wbc.task import Task

__all__ = ["analyse"]

SHARE = 1e-6
"""Part of a row below which another is not named as what it depends on."""
AGREE = 1e-6
"""Mismatch, relative to what is compared, that counts as agreement."""


@dataclass(frozen=True, slots=True, eq=False)
class _Row:
    """An equality row: a . y = b, y the acceleration in the metric's coordinates."""

    a: Array
    b: float
    task: str
    name: str
    unit: str
    weight: float

    @property
    def label(self) -> str:
        return f"{self.task}/{self.name}"


@dataclass(slots=True, eq=False)
class _Above:
    """What the levels so far have taken: rows that count, point, basis of the rest."""

    x: Array
    Z: Array
    rows: list[_Row] = field(default_factory=list)


def analyse(
    hierarchy: Hierarchy,
    state: State,
    metric: Metric = "kinetic",
    tolerance: float = RANK_TOLERANCE,
) -> Analysis:
    """Rows, rank, redundancy and conflicts of every level at a state.

    Args:
        hierarchy: the tasks; their equality rows count, bounds are only listed.
        state: of the robot; what a task wants there decides who conflicts.
        metric: of the singular values: "kinetic", in which the solvers work, or
            "joint".
        tolerance: share of the norm of a level's rows that counts as zero; by default
            the solvers'. A larger one forgives a pose that holds only nearly.

    Raises:
        UnknownName: no such metric, or a task's frame or joint is not the robot's.
        InputError: a task does not fit the robot, or the tolerance is not positive.
        SolverError: a task wrote a row that is not finite.
    """
    expect(State, state=state)
    known("metric", metric, get_args(Metric))
    positive(tolerance, "tolerance")
    robot = state.robot
    basis = np.eye(robot.nv)
    if metric == "kinetic":
        basis = np.linalg.inv(np.linalg.cholesky(state.M)).T  # vdot = L^-T y
    above = _Above(np.zeros(robot.nv), np.eye(robot.nv))
    levels = tuple(
        _level(k, level, state, basis, above, tolerance)
        for k, level in enumerate(hierarchy.levels, 1)
    )
    return Analysis(robot.name, robot.nv, metric, tolerance, levels)


def _level(
    k: int, level: Level, state: State, basis: Array, above: _Above, tolerance: float
) -> LevelAnalysis:
    """Analyse one level, and take what it uses from what is left."""
    rows: list[_Row] = []
    bounds = 0
    for task, weight in level.terms:
        equalities, inequalities = _rows(task, weight, state, basis, k)
        rows += equalities
        bounds += inequalities
    A = np.array([row.a for row in rows]).reshape(len(rows), state.robot.nv)
    b = np.array([row.b for row in rows])
    factor = factorise(A @ above.Z, norm(A), tolerance)
    sigma = np.zeros(0)
    if A.size and above.Z.size:
        sigma = np.array(np.linalg.svd(A @ above.Z, compute_uv=False), np.float64)
    kept, others = _split(rows, above.Z, factor.rank, tolerance * norm(A))
    found = [_dependency(row, kept, above) for row in others]
    above.x = above.x + above.Z @ factor.solve(b - A @ above.x)
    above.Z = above.Z @ factor.V2
    above.rows += kept
    return LevelAnalysis(
        level=k,
        tasks=tuple(task.name for task, _ in level.terms),
        rows=len(rows),
        inequalities=bounds,
        rank=factor.rank,
        free=above.Z.shape[1],
        singular_values=sigma,
        redundant=tuple(row for row, agrees in found if agrees),
        conflicts=tuple(row for row, agrees in found if not agrees),
    )


def _rows(
    task: Task, weight: float, state: State, basis: Array, level: int
) -> tuple[list[_Row], int]:
    """Equality rows of a task over y, and the number of its other rows."""
    robot = state.robot
    task.check(robot)
    names = task.row_names(robot)
    rows = allocate_rows(len(names), robot.nv)
    task.update(state, rows)
    A, wish = rows.A, rows.upper
    units = task.wish_units(len(names))
    if task.space == "torque":  # tau = M vdot + h
        A, wish = A @ state.M, wish - A @ state.h
    else:
        A = np.where(np.abs(A) <= NOTHING, 0.0, A)  # as solvers see it
    equal = rows.lower == rows.upper
    if not np.isfinite(A).all() or np.isnan([rows.lower, rows.upper]).any():
        raise SolverError(f"task '{task.name}' wrote a row that is not finite.", level)
    Ay = weight * (A @ basis)
    found = [
        _Row(Ay[i], weight * float(wish[i]), task.name, names[i], units[i], weight)
        for i in np.flatnonzero(equal)
    ]
    return found, len(names) - len(found)


def _split(
    rows: list[_Row], Z: Array, rank: int, threshold: float
) -> tuple[list[_Row], list[_Row]]:
    """Rows that each add a direction to those before, as many as the rank; the rest."""
    kept: list[_Row] = []
    others: list[_Row] = []
    Q = np.zeros((Z.shape[1], 0))
    for row in rows:
        new = Z.T @ row.a
        for _ in range(2):  # once more for what round-off left
            new = new - Q @ (Q.T @ new)
        length = float(np.linalg.norm(new))
        if len(kept) < rank and length > threshold:
            kept.append(row)
            Q = np.column_stack([Q, new / length])
        else:
            others.append(row)
    return kept, others


def _dependency(row: _Row, kept: list[_Row], above: _Above) -> tuple[Dependency, bool]:
    """What a row that adds nothing is a combination of, and whether it agrees."""
    c = _shares(above.Z.T @ row.a, [above.Z.T @ other.a for other in kept])
    rest = row.a - sum(
        (share * other.a for share, other in zip(c, kept, strict=True)),
        np.zeros(row.a.size),
    )
    d = _shares(rest, [other.a for other in above.rows])
    terms = [row.b, -float(rest @ above.x)]
    terms += [-share * other.b for share, other in zip(c, kept, strict=True)]
    mismatch = sum(terms)
    size = float(np.linalg.norm(row.a)) or 1.0
    share = [
        (abs(s) * float(np.linalg.norm(other.a)) / size, other, i >= len(kept))
        for i, (s, other) in enumerate(zip([*c, *d], [*kept, *above.rows], strict=True))
    ]
    named = sorted((s for s in share if s[0] > SHARE), key=lambda s: -s[0])
    found = Dependency(
        row.task,
        row.name,
        tuple(other.label for _, other, _ in named),
        any(is_above for _, _, is_above in named),
        mismatch / row.weight,
        row.unit,
    )
    return found, abs(mismatch) <= AGREE * (AGREE + sum(map(abs, terms)))


def _shares(target: Array, rows: list[Array]) -> Array:
    """Coefficients with which rows add up to a target, in the least-squares sense."""
    if not rows or target.size == 0:
        return np.zeros(len(rows))
    shares = np.linalg.lstsq(np.array(rows).T, target, rcond=RANK_TOLERANCE)[0]
    return np.array(shares, np.float64)
