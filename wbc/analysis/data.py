"""What an analysis of a hierarchy's rank found, as values and as text."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias, final

from wbc.arrays import Array
from wbc.checks import known

__all__ = ["Analysis", "Dependency", "LevelAnalysis", "Metric"]

Metric: TypeAlias = Literal["kinetic", "joint"]
"""How long a joint acceleration is: sqrt(vdot^T M vdot), or sqrt(vdot^T vdot)."""
MEANING = {
    "kinetic": "of the rows over y = L^T vdot, M = L L^T, as the solvers see them",
    "joint": "of the rows over vdot",
}
SHOWN = 4
"""Rows of one kind, and rows that one depends on, that the text has room for."""


@final
@dataclass(frozen=True, slots=True)
class Dependency:
    """A row that adds nothing to the levels above and the rows before it.

    Attributes:
        task: name of its task.
        row: its name.
        on: "task/row" of those that it is a combination of, the largest share first;
            empty for a row of zeros.
        above: whether rows of levels above are among them.
        mismatch: by how much its wish differs from what those ask for or get [unit].
        unit: of the wish, such as "m/s^2".
    """

    task: str
    row: str
    on: tuple[str, ...]
    above: bool
    mismatch: float
    unit: str

    def __str__(self) -> str:
        more = len(self.on) - SHOWN
        names = [*self.on[:SHOWN], *([f"and {more} more"] if more > 0 else [])]
        return f"{self.task}/{self.row} ({', '.join(names) or 'a row of zeros'})"


@final
@dataclass(frozen=True, slots=True, eq=False)
class LevelAnalysis:
    """One level, with all degrees of freedom that the levels above leave.

    Attributes:
        level: 1 at the top.
        tasks: names of its tasks.
        rows: number of its equality rows.
        inequalities: number of its other rows, which are not counted.
        rank: independent directions of the equality rows in what is left to them.
        free: degrees of freedom left to the levels below.
        singular_values: of those rows there, in decreasing order; those that do not
            count in the rank included.
        redundant: rows that add nothing and agree with what they depend on.
        conflicts: rows that add nothing and disagree with what they depend on.
    """

    level: int
    tasks: tuple[str, ...]
    rows: int
    inequalities: int
    rank: int
    free: int
    singular_values: Array
    redundant: tuple[Dependency, ...]
    conflicts: tuple[Dependency, ...]


@final
@dataclass(frozen=True, slots=True, eq=False)
class Analysis:
    """A hierarchy's rank at one state; printing it gives a table.

    Attributes:
        robot: name of the robot.
        degrees: its degrees of freedom.
        metric: in which the singular values are.
        tolerance: share of the norm of a level's rows that counts as zero.
        levels: from the top.
    """

    robot: str
    degrees: int
    metric: Metric
    tolerance: float
    levels: tuple[LevelAnalysis, ...]

    @property
    def free(self) -> int:
        """Degrees of freedom that no level uses."""
        return self.levels[-1].free

    def level(self, task: str) -> LevelAnalysis:
        """The level of a task.

        Raises:
            UnknownName: there is no such task.
        """
        found = {name: level for level in self.levels for name in level.tasks}
        return found[known("task", task, found)]

    def __str__(self) -> str:
        return "\n".join(self._lines())

    def _lines(self) -> Iterator[str]:
        yield f"{self.robot}: {self.degrees} degrees of freedom"
        header = ("level", "rows", "rank", "left", "bounds", "singular values", "tasks")
        cells = [header, *map(_cells, self.levels)]
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        for i, line in enumerate(cells):
            padded = (t.ljust(w) for t, w in zip(line, widths, strict=True))
            yield "  ".join(padded).rstrip()
            if i > 0:
                yield from _dependencies(self.levels[i - 1])
        yield f"singular values {MEANING[self.metric]}"


def _cells(level: LevelAnalysis) -> tuple[str, ...]:
    numbers = (level.level, level.rows, level.rank, level.free, level.inequalities)
    sigma = " ".join(
        f"{value:.2g}" if i < level.rank else "0"
        for i, value in enumerate(level.singular_values)
    )
    return (*map(str, numbers), sigma or "-", " + ".join(level.tasks))


def _dependencies(level: LevelAnalysis) -> Iterator[str]:
    for row in level.redundant[:SHOWN]:
        yield f"       redundant: {row}"
    if len(level.redundant) > SHOWN:
        yield f"       redundant: {len(level.redundant) - SHOWN} rows more"
    for row in level.conflicts[:SHOWN]:
        where = "levels above" if row.above else "its own level"
        size = f"{abs(row.mismatch):.3g} {row.unit}".rstrip()
        yield f"       conflict with {where}: {row} by {size}"
    if len(level.conflicts) > SHOWN:
        yield f"       conflict: {len(level.conflicts) - SHOWN} rows more"
