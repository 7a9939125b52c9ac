"""What an explanation says, as data: tasks, what blocks them, bounds in force."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, final

from wbc.arrays import Array
from wbc.checks import known
from wbc.explain.fading import Fading
from wbc.explain.text import paid, table

__all__ = [
    "ActiveBound",
    "Blocker",
    "Explanation",
    "Reason",
    "Side",
    "TaskExplanation",
]

Side: TypeAlias = Literal["upper", "lower", "equality", "cannot be met itself"]
Reason: TypeAlias = Literal["bounds", "tasks", "conflict", "lost", "ramp", "resolver"]

WORDS: dict[Reason, str] = {
    "bounds": "active bounds above leave no more",
    "tasks": "tasks of higher levels take the freedom that it needs",
    "conflict": "tasks of its own level want something else",
    "lost": (
        "the robot itself cannot move that way here: it is singular, or the task's "
        "own rows contradict each other"
    ),
    "ramp": "the hierarchy is not in full force before the end of its ramp",
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
            level, a direction "lost" to the robot, a "ramp" that is under way, a
            "resolver" that is not optimal.
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
        if {"ramp", "resolver"} & {*self.reasons} and self.blockers:
            words.append("take the prices as a hint")
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
        change: the change of hierarchy that is under way, None for none.
    """

    tasks: tuple[TaskExplanation, ...]
    bounds: tuple[ActiveBound, ...]
    levels: int
    change: Fading | None = None

    def task(self, name: str) -> TaskExplanation:
        """How one task fared.

        Raises:
            UnknownName: no task of that name is in the hierarchy.
        """
        found = {task.name: task for task in self.tasks}
        return found[known("task", name, found)]

    def blocked(self, name: str) -> tuple[Blocker, ...]:
        """What blocks a task, strongest first; empty if it is met.

        Raises:
            UnknownName: no task of that name is in the hierarchy.
        """
        return self.task(name).blockers

    def __repr__(self) -> str:
        lines = [] if self.change is None else [str(self.change), ""]
        lines += table(self.tasks)
        missed = [task for task in self.tasks if not task.met]
        lines += ["", "why" if missed else "every task is met"]
        lines += [f"  {task.name}: {task.why}" for task in missed]
        if self.bounds:
            lines += ["", "bounds in force, and who pays per unit"]
            lines += [f"  {paid(bound, self.levels)}" for bound in self.bounds]
        return "\n".join(lines)
