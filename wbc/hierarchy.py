"""Ordered levels of weighted tasks, and the operators that write them down."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, final

from wbc.analysis import Analysis, Metric, analyse
from wbc.arrays import positive
from wbc.errors import InputError, shown
from wbc.linalg import RANK_TOLERANCE
from wbc.task import Task

if TYPE_CHECKING:
    from wbc.state import State

__all__ = ["Hierarchy", "Level"]


@final
class Level:
    """Tasks that share one priority, each with a weight; immutable.

    Attributes:
        terms: (task, weight) pairs; a weight multiplies its task's residual, so the
            level minimises the sum of (weight * residual)^2.

    Raises:
        InputError: no pair, or one that is not of a task and a positive number.
    """

    __slots__ = ("terms",)
    __array_ufunc__ = None  # numpy leaves products with arrays to `__rmul__`

    def __init__(self, terms: tuple[tuple[Task, float], ...]) -> None:
        self.terms = _pairs(terms)
        if not self.terms:
            raise InputError("a level needs at least one task.")

    @classmethod
    def of(cls, item: Task | Level) -> Level:
        """A level as it is, or a single task as a level.

        Raises:
            InputError: neither a task nor a level.
        """
        if isinstance(item, Level):
            return item
        if isinstance(item, Task):
            return cls(((item, 1.0),))
        if isinstance(item, Hierarchy):
            raise InputError(
                "'+' joins tasks of one level; it cannot join a hierarchy. "
                "'a + b >> c' reads (a + b) >> c."
            )
        raise InputError(
            f"expected a task, got {shown(item)}: a Hierarchy consists of tasks, or "
            "of a Level of several."
        )

    def __add__(self, other: Task | Level) -> Level:
        return Level(self.terms + Level.of(other).terms)

    def __rmul__(self, weight: float) -> Level:
        factor = positive(weight, "a task's weight")
        return Level(tuple((task, factor * w) for task, w in self.terms))

    __mul__ = __rmul__

    def __rshift__(self, other: Task | Level | Hierarchy) -> Hierarchy:
        return Hierarchy.of(self) >> other

    @property
    def name(self) -> str:
        """Names of the tasks, joined by '+'."""
        return " + ".join(task.name for task, _ in self.terms)

    def __repr__(self) -> str:
        return " + ".join(
            repr(task) if weight == 1.0 else f"{weight:g} * {task!r}"
            for task, weight in self.terms
        )


@final
class Hierarchy:
    """Levels from the most to the least important; immutable, cheap to rebuild.

    Args:
        levels: each a task, or a level of several.

    Raises:
        InputError: no level, something that is no task, one task named twice, or two
            that answer the same measured force.
    """

    __slots__ = ("levels",)

    def __init__(self, *levels: Task | Level) -> None:
        if not levels:
            raise InputError("an empty hierarchy has nothing to control: add a task.")
        self.levels = tuple(Level.of(level) for level in levels)
        seen: dict[str, Task] = {}
        for task in self.tasks():
            if task.name in seen:
                twice = "stands twice" if seen[task.name] is task else "has a namesake"
                raise InputError(
                    f"task '{task.name}' {twice} in the hierarchy: give each task "
                    "once, under a name of its own (name=...)."
                )
            seen[task.name] = task
        _refuse_shared_claims(self.tasks())

    @classmethod
    def of(cls, item: Task | Level | Hierarchy) -> Hierarchy:
        """A hierarchy as it is, or one of a single level."""
        return item if isinstance(item, Hierarchy) else cls(item)

    def tasks(self) -> Iterator[Task]:
        """All tasks, from the top."""
        return (task for level in self.levels for task, _ in level.terms)

    def analyse(
        self,
        state: State,
        *,
        metric: Metric = "kinetic",
        tolerance: float = RANK_TOLERANCE,
    ) -> Analysis:
        """Rank, freedom, redundant and conflicting rows of every level at a state.

        Arguments and errors as for `wbc.analysis.analyse`; print the result.
        """
        return analyse(self, state, metric, tolerance)

    def __rshift__(self, other: Task | Level | Hierarchy) -> Hierarchy:
        return Hierarchy(*self.levels, *Hierarchy.of(other).levels)

    def __add__(self, other: object) -> Level:
        raise InputError(
            "'+' joins tasks of one level; it cannot join a hierarchy. Write the sum "
            "inside its level: limits >> (a + b) >> c."
        )

    def __mul__(self, weight: object) -> Level:
        raise InputError(
            "a weight belongs to a task or a level, not to a hierarchy: "
            "limits >> 2 * a + b."
        )

    __rmul__ = __mul__

    def __len__(self) -> int:
        return len(self.levels)

    def __repr__(self) -> str:
        return " >> ".join(f"({level!r})" for level in self.levels)


def _pairs(terms: Iterable[tuple[Task, float]]) -> tuple[tuple[Task, float], ...]:
    """Checked terms of a level."""
    try:
        pairs = tuple((task, weight) for task, weight in terms)
    except (TypeError, ValueError) as error:
        raise InputError(
            f"terms of a level are pairs of a task and its weight, not {shown(terms)}."
        ) from error
    for task, weight in pairs:
        if not isinstance(task, Task):
            raise InputError(f"expected a task in a level's terms, got {shown(task)}.")
        positive(weight, f"weight of '{task.name}'")
    return pairs


def _refuse_shared_claims(tasks: Iterator[Task]) -> None:
    """A measured force goes into the torques once, or the robot would push twice."""
    claimed: dict[str, str] = {}
    for task in tasks:
        for claim in task.claims:
            if claim in claimed:
                raise InputError(
                    f"tasks '{claimed[claim]}' and '{task.name}' both answer the "
                    f"{claim}: it would count twice. Give one of them another sensor, "
                    "or join their rows in one task."
                )
            claimed[claim] = task.name
