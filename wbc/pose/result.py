"""What a search for a pose found, or how near it came."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import final

from wbc.arrays import Array

__all__ = ["PoseResult", "TaskMiss"]


@final
@dataclass(frozen=True, slots=True, eq=False)
class TaskMiss:
    """How far a task is from holding.

    Attributes:
        task: its name.
        level: its level, 1 at the top.
        errors: for each unit, the norm of the rows in that unit.
        rows: (m,) error of every row.
        names: of the rows.
        met: whether no error exceeds the tolerance.
    """

    task: str
    level: int
    errors: Mapping[str, float]
    rows: Array
    names: tuple[str, ...]
    met: bool

    @property
    def size(self) -> float:
        """The largest of the errors, whatever its unit."""
        return max(self.errors.values(), default=0.0)

    def __str__(self) -> str:
        sizes = (f"{size:.3g} {unit}".rstrip() for unit, size in self.errors.items())
        return ", ".join(sizes)


@final
@dataclass(frozen=True, slots=True, eq=False)
class PoseResult:
    """A configuration; printing it says what holds and what does not.

    Attributes:
        ok: whether every task holds, within the tolerance.
        q: (n,) the nearest configuration found that satisfies the tasks; the one that
            misses least where there is none.
        distance: norm of q - start, in the joint weights [rad, m].
        tasks: one entry a task, from the top.
        at_limit: "joint at its lower limit" and the like, for each that is.
        attempts: how many starts were tried.
        evaluations: how often the tasks were evaluated.
    """

    ok: bool
    q: Array
    distance: float
    tasks: tuple[TaskMiss, ...]
    at_limit: tuple[str, ...]
    attempts: int
    evaluations: int

    @property
    def misses(self) -> tuple[TaskMiss, ...]:
        """Tasks that do not hold, the largest error first."""
        unmet = (task for task in self.tasks if not task.met)
        return tuple(sorted(unmet, key=lambda task: -task.size))

    def __str__(self) -> str:
        return "\n".join(self._lines())

    def _lines(self) -> Iterator[str]:
        starts = "1 start" if self.attempts == 1 else f"{self.attempts} starts"
        if self.ok:
            yield f"pose found, {self.distance:.4g} from the start ({starts})"
        else:
            yield f"no pose found from {starts}; the closest misses"
            for miss in self.misses:
                yield f"  {miss.task} (level {miss.level}) by {miss}"
        held = [task.task for task in self.tasks if task.met]
        if held:
            yield f"  holds: {', '.join(held)}"
        yield from (f"  {limit}" for limit in self.at_limit)
