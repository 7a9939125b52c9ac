"""A hierarchy bound to a robot: its rows in fixed arrays, rewritten every tick."""

from __future__ import annotations

from typing import NoReturn, final

import numpy as np

from wbc import slots
from wbc.arrays import Array
from wbc.assembly import kept, measured
from wbc.binding import register
from wbc.compiled import announce
from wbc.errors import InputError
from wbc.failure import complain
from wbc.hierarchy import Hierarchy
from wbc.inertia import back_substitute, inverse_dynamics
from wbc.parts import Parts
from wbc.pointers import address_of
from wbc.program import Place, Program
from wbc.robot import Robot
from wbc.rows import rows_over
from wbc.state import State
from wbc.task import Task
from wbc.term import Term
from wbc.tick import without_kernels

__all__ = ["Stack"]

ROWS_ONLY = np.empty(0)


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
        raw: (m, n) rows as the tasks write them, from the top level down.
        bands: (5, m) their error, rate, drift, lower, upper.
        A: (m, n) weighted rows in vdot.
        Ay: (m, n) the same rows in y.
        lower, upper: (m,) weighted bounds.
        weights: (m,) the weights.
        levels: one slice of the rows a level.
        terms: the tasks and their places.
        M, h: inertia (n, n) and bias torques (n,) of the last state; h includes
            torques of the contact forces that tasks count on.
        L: (n, n) Cholesky factor of M.
        U: (n, n) L^-T.
        v: (n,) joint velocities of the last state.
        tick: how often the rows were rewritten.
        parts: of the array that `run` writes.
        solved: whether the solver came to an end when it last ran.
    """

    def __init__(self, robot: Robot, hierarchy: Hierarchy) -> None:
        self.robot, self.hierarchy = robot, hierarchy
        self.terms: list[Term] = []
        self.levels: list[slice] = []
        m = 0
        for k, level in enumerate(hierarchy.levels):
            first = m
            for task, weight in level.terms:
                term = Term(task, weight, k, m, robot)
                self.terms.append(term)
                m = term.where.stop
            self.levels.append(slice(first, m))
        self._allocate(m, robot.nv)
        self.parts = Parts.of(robot.nv, m, len(self.levels))
        self.solved = False
        self._program: Program | None = None
        self._state: State | None = None
        self.tick = 0
        self._sort_out()
        register(self)

    def _sort_out(self) -> None:
        """Tell tasks in plain Python, and those with a memory, from the others."""
        self._plain = [term for term in self.terms if term.kernel is None]
        everyone = [term.task for term in self.terms]
        self._advancing = [t for t in everyone if type(t).advance is not Task.advance]
        self._python = bool(self._plain or self._advancing)

    def read_afresh(self) -> None:
        """Read gains and settings of the tasks again, at the next update."""
        for term in self.terms:
            term.read(self.robot)
        self._sort_out()
        self._state = None

    def _allocate(self, m: int, n: int) -> None:
        self.raw, self.bands = np.zeros((m, n)), np.zeros((5, m))
        self.A, self.Ay, self._bounds = (
            np.zeros((m, n)),
            np.zeros((m, n)),
            np.zeros((2, m)),
        )
        self.lower, self.upper = self._bounds
        self.M, self.h = np.eye(n), np.zeros(n)
        self.L, self.U = np.eye(n), np.eye(n)
        self._M, self.v = self.M, np.zeros(n)
        self.weights, self._torque = np.ones(m), np.zeros(m)
        self._joint = np.full(m, -1)
        for term in self.terms:
            where = term.where
            term.rows = rows_over(self.raw[where], self.bands[:, where])
            self.weights[where] = term.weight
            self._torque[where] = term.task.space == "torque"
        self._table = np.zeros(slots.SIZE, np.int_)
        self._table[[slots.JOINTS, slots.ROWS]] = n, m
        self._table[slots.RAW : slots.TORQUE + 1] = [
            address_of(array)
            for array in (self.raw, self.bands, self.weights, self._torque)
        ]
        self._table[slots.VDOT_ROWS : slots.INVERSE + 1] = [
            address_of(array)
            for array in (self.A, self.Ay, self._bounds, self.L, self.U)
        ]
        self._table[slots.JOINT] = address_of(self._joint)
        on_top = [term for term in self.terms if term.level == 0]
        if len(on_top) == 1 and on_top[0].task.space == "torque":
            self._table[slots.GUARDED] = on_top[0].where.stop

    def connect(self, solver: int) -> None:
        """Let `run` use a compiled solver, which must stay alive.

        Args:
            solver: address of its memory.
        """
        self._table[slots.SOLVER] = solver

    def update(self, state: State) -> None:
        """Rewrite all rows at this state.

        Raises:
            ModelError: the inertia matrix is not positive definite.
            SolverError: a measurement, or a row that a task wrote, is not finite.
        """
        self.run(state, ROWS_ONLY)

    def run(self, state: State, out: Array) -> None:
        """Rewrite all rows and solve them with the connected solver, in one call.

        Args:
            state: the state.
            out: its `parts` are written.

        Raises:
            ModelError, SolverError: as for `update`, or a torque is not finite or
                breaks limits that stand alone on top.
        """
        self.v = state.v
        if state is not self._state:
            self._bind(state)
        self.tick += 1
        outcome = slots.UNMEASURED
        if not self._python or self._prepare(state):
            table, run = self._table, self._runner
            outcome = run(table, state.q, state.v, state.t, state.dt, out)
        self.solved = outcome == slots.SOLVED
        if not self.solved and outcome != slots.UNSOLVED:
            complain(self, outcome)

    def _prepare(self, state: State) -> bool:
        """What compiled code leaves to Python, unless a measurement is not finite."""
        if not measured(state.q, state.v, state.t):
            return False
        for term in self._plain:
            term.task.update(state, term.rows)
        if self._advancing:
            self._advance(state)
        return True

    def _advance(self, state: State) -> None:
        """Let tasks with a memory move on, and add their contact torques to h."""
        self.h[:] = 0.0
        for task in self._advancing:
            self.h += state.advanced(task)
        self.h += state.h

    def _bind(self, state: State) -> None:
        """Read from another State's memory from now on."""
        self._state, self.M = state, state.M
        self.h = np.zeros(state.h.size) if self._advancing else state.h
        self._M = state.M.T  # symmetric, and stored by rows as kernels want it
        places = [
            Place(
                term.kernel,
                next(iter(term.task.frames), None),
                term.where.start,
                term.where.stop,
                next(iter(term.task.frames[1:]), None),
            )
            for term in self.terms
            if term.kernel is not None
        ]
        self._joint[:], self.A[:], self.Ay[:] = -1, 0.0, 0.0
        for term in self.terms:
            if term.kernel is not None and term.kernel.joints is not None:
                self._joint[term.where] = term.kernel.joints
        table, self._runner = self._table, without_kernels
        table[slots.INERTIA : slots.BIAS + 1] = address_of(state.M), address_of(self.h)
        if places:
            self._program = Program(places, state, self.lower.size)
            self._program.enter(table)
            self._runner = self._program.runner
        announce(self._runner, "the tick")

    def acceleration(self, y: Array) -> Array:
        """Vdot = L^-T y, (n,)."""
        vdot = np.empty(y.size)
        back_substitute(self.U, y, vdot)
        return vdot

    def coordinates(self, vdot: Array) -> Array:
        """Y = L^T vdot, (n,)."""
        return np.asarray(self.L.T @ vdot)

    def torque(self, vdot: Array) -> Array:
        """Tau = M vdot + h, (n,) [Nm].

        Raises:
            SolverError: a torque is not finite, or breaks limits alone on top.
        """
        tau = np.empty(vdot.size)
        if not inverse_dynamics(self._M, self.h, vdot, tau):
            complain(self, slots.NOT_FINITE)
        if not kept(self.raw, self.bands, int(self._table[slots.GUARDED]), tau):
            complain(self, slots.BEYOND)
        return tau

    def __reduce__(self) -> NoReturn:
        """Refuse copies and pickles, whose addresses would point elsewhere.

        Raises:
            InputError: always.
        """
        raise InputError(
            "a controller reads Pinocchio's memory where it lies, so it cannot be "
            "copied or pickled: make another one from the same robot and hierarchy."
        )
