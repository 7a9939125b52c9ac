"""A hierarchy bound to a robot: its rows in fixed arrays, rewritten every tick."""

from __future__ import annotations

from typing import final

import numpy as np
from scipy.linalg.lapack import dpotrf, dtrtri

from wbc.arrays import Array
from wbc.errors import ModelError
from wbc.hierarchy import Hierarchy
from wbc.robot import Robot
from wbc.rows import Rows
from wbc.state import State
from wbc.task import Task

__all__ = ["Stack", "Term"]


@final
class Term:
    """One task's place in a stack.

    Attributes:
        task: the task.
        weight: what its residual is multiplied by.
        level: index of its level, 0 at the top.
        where: slice of its rows in the stacked arrays.
        rows: what the task writes.
        names: one name a row.
    """

    __slots__ = ("level", "names", "rows", "task", "torque", "weight", "where")

    def __init__(
        self, task: Task, weight: float, level: int, start: int, robot: Robot
    ) -> None:
        task.check(robot)
        self.task, self.weight, self.level = task, weight, level
        self.names = task.row_names(robot)
        self.where = slice(start, start + len(self.names))
        self.rows = Rows(len(self.names), robot.nv)
        self.torque = task.space == "torque"


@final
class Stack:
    """All rows of a hierarchy for one robot, as lower <= A vdot <= upper.

    Torque rows are mapped to accelerations through tau = M vdot + h. The same rows in
    y = L^T vdot (M = L L^T), where the kinetic metric is the identity, are `Ay`.

    Args:
        robot: whose tasks they are.
        hierarchy: the tasks.

    Raises:
        UnknownName, InputError: a task does not fit the robot.

    Attributes:
        A: (m, n) weighted rows in vdot, from the top level down.
        Ay: (m, n) the same rows in y.
        lower: (m,) weighted lower bounds.
        upper: (m,) weighted upper bounds.
        weights: (m,) the weights.
        levels: one slice of the rows a level.
        terms: the tasks and their places.
        L_inv: (n, n) inverse of the Cholesky factor of M.
        tick: how often the rows were rewritten.
    """

    def __init__(self, robot: Robot, hierarchy: Hierarchy) -> None:
        self.robot, self.hierarchy = robot, hierarchy
        self.terms: list[Term] = []
        self.levels: list[slice] = []
        start = 0
        for k, level in enumerate(hierarchy.levels):
            first = start
            for task, weight in level.terms:
                term = Term(task, weight, k, start, robot)
                self.terms.append(term)
                start = term.where.stop
            self.levels.append(slice(first, start))
        n = robot.nv
        self.A, self.Ay = np.zeros((start, n)), np.zeros((start, n))
        self.lower, self.upper = np.zeros(start), np.zeros(start)
        self.weights = np.concatenate(
            [np.full(len(t.names), t.weight) for t in self.terms]
        )
        self.M, self.h, self.L_inv = np.eye(n), np.zeros(n), np.eye(n)
        self.tick = 0

    def update(self, state: State) -> None:
        """Rewrite all rows at this state.

        Raises:
            ModelError: the inertia matrix is not positive definite.
        """
        self.tick += 1
        self.M, self.h = state.M, state.h
        for term in self.terms:
            self._write(term, state)
        L, failed = dpotrf(self.M, lower=1)
        if failed:
            raise ModelError("the inertia matrix is not positive definite.")
        self.L_inv, _ = dtrtri(L, lower=1)
        np.matmul(self.A, self.L_inv.T, out=self.Ay)

    def _write(self, term: Term, state: State) -> None:
        rows, where = term.rows, term.where
        term.task.update(state, rows)
        A, lower, upper = self.A[where], self.lower[where], self.upper[where]
        if term.torque:
            np.matmul(rows.A, state.M, out=A)
            bias = rows.A @ state.h
            np.subtract(rows.lower, bias, out=lower)
            np.subtract(rows.upper, bias, out=upper)
        else:
            A[:], lower[:], upper[:] = rows.A, rows.lower, rows.upper
        if term.weight != 1.0:
            A *= term.weight
            lower *= term.weight
            upper *= term.weight

    def torque(self, vdot: Array) -> Array:
        """Tau = M vdot + h, (n,) [Nm]."""
        return self.M @ vdot + self.h
