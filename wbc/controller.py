"""The controller: robot, hierarchy and resolver, called once a tick."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NoReturn, final

import numpy as np
from numpy.typing import ArrayLike

from wbc.arrays import FLOAT, Array, numbers, positive
from wbc.assembly import measured
from wbc.checks import expect
from wbc.errors import InputError, ModelError, SolverError, shown
from wbc.hierarchy import Hierarchy, Level
from wbc.hqp import HierarchicalQP
from wbc.resolver import Answer, Resolver, Status
from wbc.robot import Robot
from wbc.solution import Solution
from wbc.state import State
from wbc.task import Task
from wbc.transition import Bound, Transition
from wbc.vectors import finite

__all__ = ["Controller", "resolve"]

NOT_FINITE = "a measurement is not finite"
FALLBACK_DAMPING = 10.0
"""Rate [1/s] at which the fallback damps joint velocities."""


@final
class Controller:
    """Maps measured (q, v) to joint torques; never sends what is not finite.

    When a measurement is not finite, or the resolver fails, it holds the robot by
    gravity compensation and damping within the torque limits of the robot, all of
    them whatever `tasks.TorqueLimits(fraction=...)` says, tells so in
    `Solution.status` and counts it in `failures`.

    Args:
        robot: the robot.
        hierarchy: tasks in order of importance; a level or a single task will do.
        resolver: how priorities become torques; strict hierarchical QP by default.
        dt: control period [s].

    Raises:
        UnknownName, InputError: a task does not fit the robot.

    Attributes:
        failures: ticks that fell back so far.
    """

    def __init__(
        self,
        robot: Robot,
        hierarchy: Hierarchy | Level | Task,
        resolver: Resolver | None = None,
        dt: float = 1e-3,
    ) -> None:
        if not isinstance(robot, Robot):
            raise InputError(f"expected a Robot, got {shown(robot)}.")
        self.robot = robot
        self.hierarchy = Hierarchy.of(hierarchy)
        self.resolver = HierarchicalQP() if resolver is None else resolver
        self.dt = positive(dt, "dt")
        self.failures = 0
        self._adopt(Bound(robot, self.hierarchy, self.resolver))
        self._transition: Transition | None = None
        self._state = State(robot, self.dt)
        self._last, self._shape = robot.q_home, (robot.nv,)
        self._damping = np.diag(robot.state(robot.q_home).M) * FALLBACK_DAMPING
        self._no_wrench: dict[str, Array] = {}

    def __call__(
        self,
        q: ArrayLike,
        v: ArrayLike,
        t: float = 0.0,
        wrenches: Mapping[str, ArrayLike] | None = None,
    ) -> Solution:
        """Torques for positions q (n,), velocities v (n,) at time t [s].

        Args:
            q: measured positions [rad or m].
            v: measured velocities [rad/s or m/s].
            t: time [s] that moving targets refer to.
            wrenches: sensor name -> (6,) robot on environment, world axes [N, Nm].

        Raises:
            InputError: an argument has the wrong shape or is no number, which is no
                sensor fault.
        """
        forces = self._no_wrench
        try:
            try:  # the quickest copy that refuses complex numbers and dates
                at: Array = q.astype(FLOAT, "C", "same_kind", False)  # type: ignore[union-attr]
                speed: Array = v.astype(FLOAT, "C", "same_kind", False)  # type: ignore[union-attr]
            except (AttributeError, TypeError):  # lists, too
                at, speed = numbers(q, "q"), numbers(v, "v")
            t = float(t)
            if wrenches:
                forces = {k: _wrench(k, w) for k, w in wrenches.items()}
        except (TypeError, ValueError, OverflowError, AttributeError) as error:
            raise _unreadable(error, q, v, t, wrenches) from error
        if at.shape != self._shape or speed.shape != self._shape:
            raise InputError(
                f"q and v have shapes {at.shape}, {speed.shape}; need {self._shape}."
            )
        if wrenches and not all(finite(w) for w in forces.values()):
            return self._hold(at, speed, Status.SENSOR_INVALID, NOT_FINITE)
        return self._tick(at, speed, t, forces)

    def change(
        self,
        hierarchy: Hierarchy | Level | Task,
        over: float = 0.3,
        resolver: Resolver | None = None,
        rate: float = 500.0,
    ) -> None:
        """Hand over to another hierarchy, from the next tick on, without a jump.

        Tasks, levels and priorities may all differ. For `over` seconds both are
        resolved, and the torque moves smoothly from one to the other: limits that both
        keep, and tasks that both meet, hold all the way (`wbc.transition`). A change
        may come while another is under way; beyond three such, the last one waits.

        Args:
            hierarchy: what is wanted from now on.
            over: duration [s]; 0 switches at once, with whatever jump that means.
            resolver: the resolver from now on; the present one by default.
            rate: the change takes longer where it would add more than so to a torque's
                rate [Nm/s]; what a hierarchy does by itself comes on top, and
                `tasks.TorqueRateLimits` bounds that, too.

        Raises:
            UnknownName, InputError: a task does not fit the robot, `over` is negative,
                or the rate is not greater than 0; all stays as it was.
        """
        wanted = Hierarchy.of(hierarchy)
        resolver = self.resolver if resolver is None else resolver
        ticks = round(positive(over, "over", zero=True) / self.dt)
        most = positive(rate, "rate") * self.dt
        bound = Bound(self.robot, wanted, resolver)
        if self._transition is None:
            self._transition = Transition(self._bound)
        self._transition.to(bound, ticks, most)
        self.hierarchy, self.resolver = wanted, resolver

    @property
    def changing(self) -> bool:
        """Whether a change of hierarchy is under way."""
        return self._transition is not None

    def _adopt(self, bound: Bound) -> None:
        """Let a hierarchy be the one that solutions report on."""
        self._bound, self._stack, self._solver = bound, bound.stack, bound.solver

    def _tick(
        self, q: Array, v: Array, t: float, wrenches: Mapping[str, Array]
    ) -> Solution:
        self._state.refresh(q, v, t, wrenches)
        try:
            if self._transition is None:
                torque, answer, status = self._bound.tick(self._state)
            else:
                torque, answer = self._pass_on(self._transition)
                status = answer.status
        except (SolverError, ModelError, np.linalg.LinAlgError) as error:
            if not measured(q, v, t):
                return self._hold(q, v, Status.SENSOR_INVALID, NOT_FINITE)
            return self._hold(q, v, Status.SOLVER_FAILED, str(error))
        self._last, self._state.commanded = q, torque
        change = self._transition
        return Solution(self._stack, torque, answer, status, "", change)

    def _pass_on(self, transition: Transition) -> tuple[Array, Answer]:
        """A tick of a change: torques, and what they come from."""
        torque, answer = transition.tick(self._state)
        self._adopt(transition.newest)
        if transition.finished:
            self._transition = None
        return torque, answer

    def _hold(self, q: Array, v: Array, status: Status, message: str) -> Solution:
        """Gravity compensation and damping within the torque limits.

        Joints whose reading is not finite count as where they last were, and at rest.
        """
        self.failures += 1
        self._last = np.where(np.isfinite(q), q, self._last)
        gravity = self.robot.state(self._last).gravity()
        braking = self._damping * np.where(np.isfinite(v), v, 0.0)
        limit = self.robot.tau_max
        torque = np.clip(gravity - braking, -limit, limit)
        self._state.commanded = torque.copy()
        return Solution(self._stack, torque, None, status, message)

    def __reduce__(self) -> NoReturn:
        """Refuse copies and pickles, as its stack does.

        Raises:
            InputError: always.
        """
        self._stack.__reduce__()

    def __repr__(self) -> str:
        return (
            f"Controller({self.robot.name}, {self.hierarchy!r}, {self.resolver.name})"
        )


def _unreadable(error: Exception, *given: object) -> InputError:
    """What to raise where measurements (q, v, t, wrenches) are no numbers."""
    if isinstance(error, InputError):
        return error
    q, v, t, wrenches = map(shown, given)
    return InputError(
        "q and v must be arrays of numbers, t a number, and wrenches a mapping of "
        f"sensors to (6,); got q = {q}, v = {v}, t = {t}, wrenches = {wrenches}."
    )


def _wrench(sensor: str, value: ArrayLike) -> Array:
    """A measured wrench (6,), which may be NaN but not of another shape."""
    wrench = numbers(value, f"wrench '{sensor}'")
    if wrench.shape != (6,):
        raise InputError(
            f"wrench '{sensor}' has shape {wrench.shape}; it must be (6,)."
        )
    return wrench


def resolve(
    state: State,
    hierarchy: Hierarchy | Level | Task,
    resolver: Resolver | None = None,
) -> Solution:
    """Resolve one state once, without a controller: for study and for tests.

    Raises:
        UnknownName, InputError: a task does not fit the robot, or an argument is of
            the wrong kind.
        SolverError: the resolver found no solution.
    """
    expect(State, state=state)
    resolver = HierarchicalQP() if resolver is None else resolver
    bound = Bound(state.robot, Hierarchy.of(hierarchy), resolver)
    return Solution(bound.stack, *bound.tick(state))
