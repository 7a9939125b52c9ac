"""Why a task is not met: which rows hold it back, and what a unit of them is worth.

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
from itertools import zip_longest
from typing import Literal, TypeAlias, final

import numpy as np
from scipy.optimize import nnls

from wbc.arrays import Array, IntArray
from wbc.certificate import AT_BOUND, Certificate, slack_of
from wbc.errors import UnknownName
from wbc.linalg import factorise, norm
from wbc.stack import Stack, Term
from wbc.task import MotionTask

__all__ = ["ActiveBound", "Blocker", "Explanation", "TaskExplanation", "explain"]

Side: TypeAlias = Literal["upper", "lower", "equality", "cannot be met itself"]
Reason: TypeAlias = Literal["bounds", "tasks", "conflict", "lost", "resolver"]

OPTIMAL = 1e-6
"""A level whose proof leaves more than this is not optimal."""
NEGLIGIBLE = 1e-7
"""A row that acts less than this, relative to the rows it acts on, is left out."""
GONE = 1e-9
"""A unit row keeping less than this of its norm can no longer be moved."""
SHOWN = 3
"""Rows and blockers of a task that the table has room for."""

WORDS: dict[Reason, str] = {
    "bounds": "active bounds above leave no more",
    "tasks": "tasks of higher levels need the motion that it wants",
    "conflict": "tasks of its own level want something else",
    "lost": (
        "the robot itself cannot move that way here: it is singular, or the task's "
        "own rows contradict each other"
    ),
    "resolver": "this resolver's answer is not optimal here",
}


@final
@dataclass(frozen=True, slots=True)
class Blocker:
    """A row that holds a task back.

    Attributes:
        level: of the row, from 1 at the top.
        task: that the row belongs to.
        row: its name.
        unit: of its bound, unweighted; Nm for torques.
        side: where it stands.
        towards: +1 where raising its bound (or target) relieves the blocked task, -1
            where lowering it does.
        relief: how much |missing| of the blocked task shrinks per unit, > 0.
        price: how much 1/2 |weighted residual|^2 of the blocked task's level falls per
            unit; negative where its neighbours lose more than it gains.
        held_for: level that presses the row to its bound although the blocked task
            wants it away from there (`towards` then points inwards), else 0.
    """

    level: int
    task: str
    row: str
    unit: str
    side: Side
    towards: int
    relief: float
    price: float
    held_for: int

    def __str__(self) -> str:
        at = f" at {self.side}" if self.side in ("upper", "lower") else ""
        if self.held_for:
            at = f" held at {self.side} by level {self.held_for}"
        elif self.side == "cannot be met itself":
            at = ", which cannot be met itself"
        return f"{self.level} {self.task}/{self.row}{at}"


@final
@dataclass(frozen=True, slots=True)
class ActiveBound:
    """A bound in force, and who pays for it.

    Attributes:
        level: of the row, from 1 at the top.
        task: that the row belongs to.
        row: its name.
        unit: of its bound, unweighted.
        side: "upper" or "lower".
        payers: (level, price) of every level that would be better off without: its
            1/2 |weighted residual|^2 falls by `price` per unit of relaxing. The level
            after the last one is the least norm, 1/2 vdot^T M vdot.
    """

    level: int
    task: str
    row: str
    unit: str
    side: Side
    payers: tuple[tuple[int, float], ...]


@final
@dataclass(frozen=True, slots=True, eq=False)
class TaskExplanation:
    """How one task fared, and why.

    Attributes:
        name: of the task.
        level: from 1 at the top.
        unit: of `missing` and `wanted`; "" where the rows differ.
        rows: (m,) names.
        units: (m,) unit of each row.
        met: whether nothing is missing, up to round-off.
        missing: (m,) wanted - delivered in unweighted rows; 0 within the bounds.
        wanted: (m,) target of an equality, nearest allowed value of an inequality.
        error: norm of the state error in the task's own unit, None for tasks that
            have none; `error_unit` is its unit.
        lost: the part of |missing| that the task would miss even alone.
        reasons: why it is not met: "bounds" or "tasks" above, "conflict" within its
            level, a direction "lost" to the robot, a "resolver" that is not optimal.
        blockers: rows of its level and above that hold it back, strongest first (per
            unit of the row in the kinetic metric, so that Nm and rad/s^2 compare).
        unique: False where active bounds above depend on one another, so that other
            blockers with other prices would prove the same.
        proof: residual of the proof of its level.
    """

    name: str
    level: int
    unit: str
    rows: tuple[str, ...]
    units: tuple[str, ...]
    met: bool
    missing: Array
    wanted: Array
    error: float | None
    error_unit: str
    lost: float
    reasons: tuple[Reason, ...]
    blockers: tuple[Blocker, ...]
    unique: bool
    proof: float

    @property
    def why(self) -> str:
        """The reasons in plain words, "" if it is met."""
        words = [WORDS[reason] for reason in self.reasons]
        if "resolver" in self.reasons:
            words[-1] += f" (residual of its proof {self.proof:.1e})"
            words += ["take the prices as a hint"] if self.blockers else []
        if self.blockers and not self.unique:
            words.append("the bounds depend on one another: other prices are possible")
        return "; ".join(words)


@final
@dataclass(frozen=True, slots=True, eq=False)
class Explanation:
    """What was met and what was not, as data; `print` it for a table.

    Attributes:
        tasks: from the top level down.
        bounds: all bounds in force, from the top level down.
        levels: number of levels.
    """

    tasks: tuple[TaskExplanation, ...]
    bounds: tuple[ActiveBound, ...]
    levels: int

    def task(self, name: str) -> TaskExplanation:
        """How one task fared.

        Raises:
            UnknownName: no task of that name is in the hierarchy.
        """
        for task in self.tasks:
            if task.name == name:
                return task
        raise UnknownName("task", name, [task.name for task in self.tasks])

    def blocked(self, name: str) -> tuple[Blocker, ...]:
        """What blocks a task, strongest first; empty if it is met.

        Raises:
            UnknownName: no task of that name is in the hierarchy.
        """
        return self.task(name).blockers

    def __repr__(self) -> str:
        lines = list(_table(self.tasks))
        missed = [task for task in self.tasks if not task.met]
        lines += ["", "why" if missed else "every task is met"]
        lines += [f"  {task.name}: {task.why}" for task in missed]
        if self.bounds:
            lines += ["", "bounds in force, and who pays per unit"]
            lines += [f"  {_paid(bound, self.levels)}" for bound in self.bounds]
        return "\n".join(lines)


def explain(stack: Stack, vdot: Array, certificate: Certificate) -> Explanation:
    """Explain what joint accelerations vdot (n,) make of the stack's present rows."""
    tick = _Tick(stack, vdot)
    levels = list(_levels(tick))
    proofs = [proof.residual for proof in certificate.levels]
    tasks = tuple(
        _task(tick, term, levels[term.level], proofs[term.level])
        for term in stack.terms
    )
    if proofs[-1] > OPTIMAL:  # another notion of least than ours: it pays no price
        levels[-1].slope[:] = 0.0
    bounds = tuple(_bounds(tick, levels))
    return Explanation(tasks, bounds, len(stack.levels))


class _Tick:
    """All rows (m, n) at the solution, weighted, in coordinates of the kinetic metric.

    `side` is +1 or -1 where a row is met at its upper or lower bound; `wish` marks
    what a level minimises: equalities, and bounds that are broken.
    """

    def __init__(self, stack: Stack, vdot: Array) -> None:
        self.stack, self.vdot, self.torque = stack, vdot, stack.torque(vdot)
        A, lower, upper = stack.Ay, stack.lower, stack.upper
        self.y = np.linalg.solve(stack.L_inv.T, vdot).astype(np.float64, copy=False)
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
class _Level:
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


def _levels(tick: _Tick) -> Iterator[_Level]:
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
        yield _Level(R, _without_noise(tick, slope, norm(A), slack), held, unique)
    size = 1.0 + float(np.linalg.norm(tick.y))
    sided = np.flatnonzero(tick.side)
    pushing, clear = _pushing(tick, Z, -tick.y, sided, NEGLIGIBLE * size)
    R, Z = _stage(tick.unit[pushing], pushing, tick.norm[pushing], R, Z)
    slope = _without_noise(tick, tick.y @ R, 1.0, tick.y)
    yield _Level(R, slope, held, unique and clear)


def _pushing(
    tick: _Tick, Z: Array, pull: Array, rows: IntArray, tiny: float
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


def _without_noise(tick: _Tick, slope: Array, size: float, slack: Array) -> Array:
    least = NEGLIGIBLE * size * float(np.linalg.norm(slack))
    clear: Array = np.where(np.abs(slope) * tick.norm > least, slope, 0.0)
    return clear


def _task(tick: _Tick, term: Term, level: _Level, proof: float) -> TaskExplanation:
    where, raw = term.where, term.rows
    value = raw.A @ (tick.torque if term.task.space == "torque" else tick.vdot)
    wanted = np.clip(value, raw.lower, raw.upper)
    missed = tick.missed[where]
    met = not missed.any()
    units = _row_units(term)
    lost = 0.0 if met else _lost(tick, where) / term.weight
    blockers = () if met else tuple(_blockers(tick, term, level))
    return TaskExplanation(
        name=term.task.name,
        level=term.level + 1,
        unit=units[0] if len(set(units)) == 1 else "",
        rows=term.names,
        units=units,
        met=met,
        missing=np.where(tick.equal[where] | missed, wanted - value, 0.0),
        wanted=wanted,
        error=_error(term),
        error_unit=term.task.unit,
        lost=lost,
        reasons=() if met else _reasons(term, blockers, lost, proof),
        blockers=blockers,
        unique=level.unique,
        proof=proof,
    )


def _error(term: Term) -> float | None:
    if not isinstance(term.task, MotionTask):
        return None
    return float(np.linalg.norm(term.rows.error))


def _lost(tick: _Tick, where: slice) -> float:
    """What of the weighted slack no motion at all could remove from these rows."""
    wish = tick.wish[where]
    A, slack = tick.A[where][wish], tick.slack[where][wish]
    U = factorise(A, norm(A)).U
    lost = float(np.linalg.norm(slack - U @ (U.T @ slack)))
    return lost if lost > float(tick.near[where].max()) else 0.0


def _blockers(tick: _Tick, term: Term, level: _Level) -> Iterator[Blocker]:
    where, weights = term.where, tick.stack.weights
    length = float(np.linalg.norm(tick.slack[where]))
    slope = tick.slope(where, level.R) / length
    slope[where] = 0.0
    strength = np.abs(slope) * tick.norm
    tiny = NEGLIGIBLE * norm(tick.A[where])
    tiny += 0.01 * norm(tick.A[where]) * float(tick.near[where].max()) / length
    for j in np.argsort(-strength, kind="stable").tolist():
        if strength[j] <= tiny:
            return
        owner, i = tick.owner[j]
        towards = -int(np.sign(slope[j]))
        side = int(tick.side[j])
        yield Blocker(
            level=owner.level + 1,
            task=owner.task.name,
            row=owner.names[i],
            unit=_row_units(owner)[i],
            side=_side(tick, j),
            towards=towards,
            relief=float(abs(slope[j]) * weights[j] / term.weight),
            price=float(-towards * level.slope[j] * weights[j]),
            held_for=int(level.held[j]) if side == -towards else 0,
        )


def _side(tick: _Tick, j: int) -> Side:
    if tick.equal[j]:
        return "equality"
    if tick.missed[j]:
        return "cannot be met itself"
    return "upper" if tick.side[j] > 0 else "lower"


def _reasons(
    term: Term, blockers: tuple[Blocker, ...], lost: float, proof: float
) -> tuple[Reason, ...]:
    causes = {_cause(blocker, term.level + 1) for blocker in blockers}
    order: tuple[Reason, ...] = ("bounds", "tasks", "conflict")
    found: list[Reason] = [reason for reason in order if reason in causes]
    if lost > 0.0 or not (found or proof > OPTIMAL):
        found.append("lost")
    if proof > OPTIMAL:
        found.append("resolver")
    return tuple(found)


def _cause(blocker: Blocker, level: int) -> Reason:
    """What a blocker stands for, seen from a task of this level."""
    if level in (blocker.level, blocker.held_for):
        return "conflict"
    if blocker.side == "equality" or blocker.held_for:
        return "tasks"
    return "bounds"


def _bounds(tick: _Tick, levels: list[_Level]) -> Iterator[ActiveBound]:
    for j in np.flatnonzero(tick.side).tolist():
        term, i = tick.owner[j]
        prices = [-tick.side[j] * k.slope[j] * tick.stack.weights[j] for k in levels]
        yield ActiveBound(
            level=term.level + 1,
            task=term.task.name,
            row=term.names[i],
            unit=_row_units(term)[i],
            side=_side(tick, j),
            payers=tuple((k, float(p)) for k, p in enumerate(prices, 1) if p > 0.0),
        )


def _row_units(term: Term) -> tuple[str, ...]:
    """Unit of every row's bounds: torques as they are, errors per second squared.

    A unit of several parts, "m, rad", is shared out in equal blocks.
    """
    parts = [part.strip() for part in term.task.unit.split(",")]
    if term.task.space != "torque":
        parts = [_per_second_squared(part) for part in parts]
    m = len(term.names)
    if m % len(parts):
        return (", ".join(parts),) * m
    return tuple(part for part in parts for _ in range(m // len(parts)))


def _per_second_squared(unit: str) -> str:
    if unit in ("", "-") or unit.endswith("/s^2"):
        return unit.strip("-")
    return f"{unit}^2" if unit.endswith("/s") else f"{unit}/s^2"


def _table(tasks: tuple[TaskExplanation, ...]) -> Iterator[str]:
    """One line a task, more where several rows miss or several rows block."""
    cells = [("level", "task", "met", "error", "missing", "blocked by (relief)")]
    for task in tasks:
        error = "" if task.error is None else _with(task.error, task.error_unit)
        first = (str(task.level), task.name, "yes" if task.met else "NO", error)
        rest = zip_longest(
            _first(_missing(task)),
            _first([_relief(blocker) for blocker in task.blockers]),
            fillvalue="",
        )
        lines = [(*first, *texts) for texts in rest] or [(*first, "", "")]
        cells.append(lines[0])
        cells += [("", "", "", "", *line[4:]) for line in lines[1:]]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    for line in cells:
        padded = (text.ljust(width) for text, width in zip(line, widths, strict=True))
        yield "  ".join(padded).rstrip()


def _first(texts: list[str]) -> list[str]:
    more = len(texts) - SHOWN
    return texts if more <= 1 else [*texts[:SHOWN], f"and {more} more"]


def _missing(task: TaskExplanation) -> list[str]:
    """What is missing of what, the worst row first; the round-off of others is not."""
    if task.met:
        return []
    size = np.abs(task.missing)
    worst = np.argsort(-size, kind="stable")
    return [
        f"{task.rows[i]} {_with(task.missing[i], '')} of "
        f"{_with(task.wanted[i], task.units[i])}"
        for i in worst
        if size[i] > NEGLIGIBLE * size[worst[0]]
    ]


def _relief(blocker: Blocker) -> str:
    """The row, and how much less is missing per unit of its bound."""
    return f"{blocker} ({_per(f'{blocker.relief:.3g}', blocker.unit)})"


def _paid(bound: ActiveBound, levels: int) -> str:
    names = [f"level {k}" if k <= levels else "least norm" for k, _ in bound.payers]
    prices = [_per(f"{price:.3g}", bound.unit) for _, price in bound.payers]
    paid = ", ".join(f"{n} pays {p}" for n, p in zip(names, prices, strict=True))
    row = f"{bound.level} {bound.task}/{bound.row} at {bound.side}"
    return f"{row}: {paid or 'nobody, it only touches'}"


def _with(number: float, unit: str) -> str:
    return f"{number + 0.0:.3g} {unit}".rstrip()


def _per(text: str, unit: str) -> str:
    return f"{text} per {unit or 'unit'}"
