"""One task's place in a stack."""

from __future__ import annotations

from typing import final

from wbc.kernel import Kernel
from wbc.robot import Robot
from wbc.rows import Rows
from wbc.task import Task

__all__ = ["Term"]


@final
class Term:
    """One task's place in a stack.

    Attributes:
        task: the task.
        weight: what its residual is multiplied by.
        level: index of its level, 0 at the top.
        where: slice of its rows in the stacked arrays.
        rows: what the task writes: views of the stack's `raw` and `bands`.
        names: one name a row.
        kernel: its compiled half, None for a task in plain Python.
    """

    __slots__ = ("kernel", "level", "names", "rows", "task", "weight", "where")

    rows: Rows
    kernel: Kernel | None

    def __init__(
        self, task: Task, weight: float, level: int, start: int, robot: Robot
    ) -> None:
        task.check(robot)
        self.task, self.weight, self.level = task, weight, level
        self.names = task.row_names(robot)
        self.where = slice(start, start + len(self.names))
        self.read(robot)

    def read(self, robot: Robot) -> None:
        """Read gains and settings of the task."""
        self.kernel = self.task.kernel(robot) if self.names else None
