"""The position errors of a hierarchy's tasks, as functions of the configuration."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias, final

import numpy as np

from wbc.arrays import Array
from wbc.errors import InputError, SolverError
from wbc.hierarchy import Hierarchy, Level
from wbc.law import Damper
from wbc.pose.result import TaskMiss
from wbc.stack import Stack
from wbc.state import State
from wbc.task import MotionTask, Task
from wbc.term import Term

if TYPE_CHECKING:
    from wbc.robot import Robot

__all__ = ["Goal", "Linear"]

Linear: TypeAlias = tuple[Array, Array]
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
        self._robot, self._t, self._scale = robot, float(t), scale
        self._state, self._rest = State(robot, 1e-3), np.zeros(robot.nv)
        self._ranks, levels = [], []
        for rank, level in enumerate(hierarchy.levels, 1):
            terms = tuple(term for term in level.terms if _has_position(term[0]))
            if terms:
                self._ranks.append(rank)
                levels.append(Level(terms))
        if not levels:
            raise InputError(
                "a pose needs at least one task with a position: limits and tasks of "
                "velocity alone say nothing about it."
            )
        self._stack = Stack(robot, Hierarchy(*levels))
        self.count, self.evaluations = len(levels), 0

    def evaluate(self, u: Array) -> list[Linear]:
        """Weighted Jacobian over u and error of every level.

        Raises:
            SolverError: a task wrote a row that is not finite.
        """
        self._run(u)
        J = self._stack.A / self._scale
        e = self._stack.weights * self._stack.bands[0]
        return [(J[where], e[where]) for where in self._stack.levels]

    def misses(self, u: Array, tolerance: float) -> tuple[TaskMiss, ...]:
        """How far every task is from holding at u."""
        self._run(u)
        return tuple(self._miss(term, tolerance) for term in self._stack.terms)

    def miss(self, u: Array, k: int) -> float:
        """Largest error of a task of level k at u, whatever its unit."""
        tasks = self.misses(u, 0.0)
        return max(task.size for task in tasks if task.level == self._ranks[k])

    def _miss(self, term: Term, tolerance: float) -> TaskMiss:
        error = term.rows.error.copy()
        units = np.array(term.task.row_units(error.size))
        errors = {
            str(unit): float(np.linalg.norm(error[units == unit]))
            for unit in dict.fromkeys(units)
        }
        met = max(errors.values(), default=0.0) <= tolerance
        rank = self._ranks[term.level]
        return TaskMiss(term.task.name, rank, errors, error, term.names, met)

    def _run(self, u: Array) -> None:
        """Let all tasks write their rows at u."""
        self.evaluations += 1
        self._state.refresh(u / self._scale, self._rest, self._t)
        self._stack.update(self._state)
        for term in self._stack.terms:
            good = np.isfinite(term.rows.error)
            if not good.all():
                raise SolverError(
                    f"task '{term.task.name}' wrote a row "
                    f"'{term.names[int(np.argmin(good))]}' that is not finite.",
                    term.level,
                )


def _has_position(task: Task) -> bool:
    return isinstance(task, MotionTask) and not isinstance(task.law, Damper)
