"""What a tick decided, and the proof that it was right."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, final

import numpy as np

from wbc.arrays import Array
from wbc.certificate import Certificate, certify
from wbc.checks import known
from wbc.errors import StaleError
from wbc.explain import Explanation, StrictnessCost, explain, strictness_cost
from wbc.report import TaskReport, active_rows, shortfalls, task_report
from wbc.resolver import Answer, Status, unpack
from wbc.stack import Stack
from wbc.task import MotionTask

if TYPE_CHECKING:
    from wbc.transition import Transition

__all__ = ["Solution"]


@final
class Solution:
    """Torques of one tick, and everything that can be asked about them.

    Reports, explanations, the certificate, `lost` and `active_rows` read the rows of
    the tick, which the controller rewrites at the next one: ask before that. Torque,
    acceleration, status and `ranks` stay.

    Attributes:
        torque: (n,) joint torques [Nm or N], always finite.
        status: how the tick ended.
        message: what went wrong, empty if nothing did.
    """

    __slots__ = (
        "_found", "_ramp", "_stack", "_tick", "message", "status", "torque",
    )  # fmt: skip

    def __init__(
        self,
        stack: Stack,
        torque: Array,
        answer: Answer | Array | None,
        status: Status,
        message: str = "",
        transition: Transition | None = None,
    ) -> None:
        self._stack, self._tick, self._found = stack, stack.tick, answer
        self.torque, self.status, self.message = torque, status, message
        self._ramp = None if transition is None else (transition, transition.share)

    @property
    def acceleration(self) -> Array:
        """(n,) joint accelerations that the torques cause in the model.

        NaN after a fallback.
        """
        answer = self._answer
        return np.full(self.torque.size, np.nan) if answer is None else answer.vdot

    @property
    def _answer(self) -> Answer | None:
        """What the resolver said, None after a fallback."""
        found = self._found
        return None if found is None else unpack(found, self._stack, self.status)

    @property
    def ok(self) -> bool:
        """Whether the resolver answered."""
        return self.status in (Status.SOLVED, Status.INCOMPLETE)

    @property
    def share(self) -> float:
        """Of the hierarchy that reports are about, in the torque.

        Below 1 while a change to it is under way (`Controller.change`), so that its
        levels are not optimal yet.
        """
        return 1.0 if self._ramp is None else self._ramp[1]

    @property
    def ranks(self) -> tuple[int, ...]:
        """For each level, the directions that its equalities and active bounds use.

        Empty after a fallback.
        """
        answer = self._answer
        return () if answer is None else tuple(map(int, answer.ranks.tolist()))

    @property
    def lost(self) -> tuple[int, ...]:
        """For each level, how many of its equality rows had no direction of their own.

        They repeat another row, are held by a level above, or the robot is singular
        there. What of their wish was met all the same, `report` tells.

        Raises:
            StaleError: the controller has moved on, or this tick fell back.
        """
        stack = self._fresh()
        equal = stack.lower == stack.upper
        return tuple(
            max(int(np.count_nonzero(equal[where])) - rank, 0)
            for where, rank in zip(stack.levels, self.ranks, strict=True)
        )

    def certificate(self) -> Certificate:
        """Proof of lexicographic optimality; `.worst` is 0 for a perfect one.

        What the levels leave free is held to the law's own measure: least
        vdot^T M vdot, or for `NullSpace("tsid")` least vdot^T vdot.

        Raises:
            StaleError: the controller has moved on, or this tick fell back.
            SolverError: numbers too large to calculate with, as after a measurement
                of 1e308.
        """
        answer = self._answer
        return self._certify(answer is None or answer.kinetic)

    def _certify(self, kinetic: bool) -> Certificate:
        stack = self._fresh()
        where = stack.levels
        A = stack.Ay if kinetic else stack.A
        levels = [(A[k], stack.lower[k], stack.upper[k]) for k in where]
        answer, x = self._answer, self.acceleration
        slacks = None if answer is None else answer.slacks
        then = None if slacks is None else [slacks[k] for k in where]
        return certify(levels, stack.coordinates(x) if kinetic else x, then)

    def level_rows(self) -> list[tuple[Array, Array, Array]]:
        """Copies of the rows that were resolved: (A (m, n), lower (m,), upper (m,)).

        Weighted, in joint accelerations, from the top level down.

        Raises:
            StaleError: the controller has moved on, or this tick fell back.
        """
        stack = self._fresh()
        return [
            (stack.A[k].copy(), stack.lower[k].copy(), stack.upper[k].copy())
            for k in stack.levels
        ]

    def report(self, task: str) -> TaskReport:
        """How a task fared.

        Raises:
            UnknownName: no task of that name is in the hierarchy.
            StaleError: the controller has moved on, or this tick fell back.
        """
        stack = self._fresh()
        found = {term.task.name: term for term in stack.terms}
        term = found[known("task", task, found)]
        return task_report(stack, term, self.acceleration)

    def reports(self) -> tuple[TaskReport, ...]:
        """How all tasks fared, from the top level down."""
        stack = self._fresh()
        return tuple(
            task_report(stack, term, self.acceleration) for term in stack.terms
        )

    def explain(self) -> Explanation:
        """Which tasks are met, what blocks the others, and at what price; print it.

        Made for reading, not for every tick: it takes milliseconds. While a change of
        hierarchy is under way it says so, and which tasks come and go.

        Raises:
            StaleError: the controller has moved on, or this tick fell back.
            SolverError: numbers too large to calculate with, as after a measurement
                of 1e308.
        """
        stack, ramp = self._fresh(), self._ramp and self._ramp[0]
        return explain(stack, self.acceleration, self._certify(True), ramp)

    def cost_of_strictness(self) -> StrictnessCost:
        """What each level misses alone, what it misses here, who took the difference.

        Made for reading, not for every tick: it takes milliseconds. A level that pays
        more than it is worth can share its level, `+`, and be weighed instead.

        Raises:
            StaleError: the controller has moved on, or this tick fell back.
        """
        return strictness_cost(self._fresh(), self.acceleration)

    def error_norms(self) -> Iterator[tuple[str, float]]:
        """Name and norm of the error of every equality task, cheap enough for a log."""
        for term in self._fresh().terms:
            if isinstance(term.task, MotionTask):
                error = term.rows.error
                yield term.task.name, math.sqrt(error @ error)

    def active_rows(self) -> list[str]:
        """Inequality rows at a bound or beyond it, as "level k: task: row"."""
        return active_rows(self._fresh(), self.acceleration)

    def shortfalls(self) -> list[tuple[int, str, float]]:
        """Level, name and relative shortfall of every task, cheap enough for a log.

        |missing| / |wanted| of the weighted rows, at most 1, and 0 where a task is met
        up to round-off. Of inequalities the broken rows alone count.
        """
        return shortfalls(self._fresh(), self.acceleration)

    def _fresh(self) -> Stack:
        if self._stack.tick != self._tick:
            raise StaleError(
                "a later tick has rewritten the rows of this solution: ask for its "
                "certificate and reports before calling the controller again."
            )
        if not self.ok:
            raise StaleError(
                f"this tick fell back ({self.status.value}): nothing was resolved, so "
                "there is nothing to report or to prove."
            )
        return self._stack

    def __repr__(self) -> str:
        torque = np.array2string(self.torque, precision=3, suppress_small=True)
        return f"Solution({self.status.name}, torque={torque}, ranks={self.ranks})"
