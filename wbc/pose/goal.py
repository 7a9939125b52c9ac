"""The position errors of a hierarchy's tasks, as functions of the configuration."""

from __future__ import annotations

from typing import TYPE_CHECKING, final

import numpy as np

from wbc.arrays import Array
from wbc.errors import InputError, SolverError
from wbc.hierarchy import Hierarchy
from wbc.law import Damper
from wbc.pose.result import TaskMiss
from wbc.rows import Rows, allocate_rows
from wbc.state import State
from wbc.task import MotionTask

if TYPE_CHECKING:
    from wbc.robot import Robot

__all__ = ["Goal", "Level"]

Level = tuple[Array, Array]
"""Jacobian (m, n) and error (m,) of a level, weighted."""


@final
class Goal:
    """Position tasks of a hierarchy, at a time; joints measured in their weights.

    Tasks without a position of their own are left out: limits, and what only wants a
    velocity (its law is a `Damper`).

    Args:
        robot: whose configuration is sought.
        hierarchy: the tasks.
        t: time [s] at which moving targets are taken.
        scale: (n,) joint weights; u = scale * q.

    Raises:
        InputError: no task has a position, or one does not fit the robot.
        UnknownName: a frame or joint that the robot does not have.

    Attributes:
        count: number of levels that have a task.
        evaluations: how often the tasks were evaluated.
    """

    def __init__(
        self, robot: Robot, hierarchy: Hierarchy, t: float, scale: Array
    ) -> None:
        self._robot, self._t, self._scale = robot, t, scale
        self._state, self._rest = State(robot, 1e-3), np.zeros(robot.nv)
        self._levels: list[list[tuple[MotionTask, float, Rows]]] = []
        self._ranks: list[int] = []
        for k, level in enumerate(hierarchy.levels, 1):
            terms: list[tuple[MotionTask, float, Rows]] = []
            for task, weight in level.terms:
                task.check(robot)
                if isinstance(task, MotionTask) and not isinstance(task.law, Damper):
                    m = len(task.row_names(robot))
                    terms.append((task, weight, allocate_rows(m, robot.nv)))
            if terms:
                self._levels.append(terms)
                self._ranks.append(k)
        if not self._levels:
            raise InputError(
                "a pose needs at least one task with a position: limits and tasks of "
                "velocity alone say nothing about it."
            )
        self.count, self.evaluations = len(self._levels), 0

    def evaluate(self, u: Array) -> list[Level]:
        """Weighted Jacobian over u and error of every level.

        Raises:
            SolverError: a task wrote a row that is not finite.
        """
        self._run(u)
        levels = []
        for terms in self._levels:
            J = np.vstack([weight * rows.A for _, weight, rows in terms])
            e = np.concatenate([weight * rows.error for _, weight, rows in terms])
            levels.append((J / self._scale, e))
        return levels

    def misses(self, u: Array, tolerance: float) -> tuple[TaskMiss, ...]:
        """How far every task is from holding at u."""
        self._run(u)
        return tuple(
            self._miss(task, rows.error.copy(), level, tolerance)
            for level, terms in zip(self._ranks, self._levels, strict=True)
            for task, _, rows in terms
        )

    def miss(self, u: Array, k: int) -> float:
        """Largest error of a task of level k at u, whatever its unit."""
        tasks = self.misses(u, 0.0)
        return max(task.size for task in tasks if task.level == self._ranks[k])

    def _miss(
        self, task: MotionTask, error: Array, level: int, tolerance: float
    ) -> TaskMiss:
        units = np.array(task.row_units(error.size))
        errors = {
            str(unit): float(np.linalg.norm(error[units == unit]))
            for unit in dict.fromkeys(units)
        }
        met = max(errors.values(), default=0.0) <= tolerance
        names = task.row_names(self._robot)
        return TaskMiss(task.name, level, errors, error, names, met)

    def _run(self, u: Array) -> None:
        """Let all tasks write their rows at u."""
        self.evaluations += 1
        self._state.refresh(u / self._scale, self._rest, self._t)
        for k, terms in enumerate(self._levels):
            for task, _, rows in terms:
                for array in (rows.error, rows.rate, rows.drift, rows.A):
                    array[:] = 0.0
                task.evaluate(self._state, rows)
                if not (np.isfinite(rows.error).all() and np.isfinite(rows.A).all()):
                    raise SolverError(
                        f"task '{task.name}' wrote a row that is not finite.", k
                    )
