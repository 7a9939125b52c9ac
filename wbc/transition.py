"""From one hierarchy to the next at run time, without a jump in torque.

While a change is under way both stacks are resolved, and the robot gets

    tau = tau_old + s (tau_new - tau_old),      0 < s <= 1,

with s a quintic in time. Limits that both keep are kept, because they are convex; a
task that both meet is met, because it is affine in vdot. A change that comes while
another one is under way starts from the blend, so any number may follow each other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from wbc.arrays import Array
from wbc.errors import SolverError
from wbc.hierarchy import Hierarchy
from wbc.resolver import Answer, Resolver, Status
from wbc.robot import Robot
from wbc.stack import Stack
from wbc.state import State

__all__ = ["Bound", "Transition"]

MOST = 4
"""Stacks that are resolved in one tick; a further change waits for its turn."""


@final
class Bound:
    """A hierarchy at work: its stack, and the solver of a resolver for it.

    Raises:
        UnknownName, InputError: a task does not fit the robot.
    """

    __slots__ = ("hierarchy", "solver", "stack")

    def __init__(self, robot: Robot, hierarchy: Hierarchy, resolver: Resolver) -> None:
        self.hierarchy = hierarchy
        self.stack = Stack(robot, hierarchy)
        self.solver = resolver.start(self.stack)

    def tick(self, state: State) -> tuple[Array, Answer]:
        """Torques (n,) at a state, and what they come from.

        Raises:
            ModelError, SolverError: as for `Solver.tick`, or a torque is not finite.
        """
        answer = self.solver.tick(self.stack, state)
        torque = answer.torque
        return (self.stack.torque(answer.vdot) if torque is None else torque), answer


@dataclass(slots=True, eq=False)
class _Ramp:
    """A hierarchy on its way in: `done` of `ticks`, or none for the one before all."""

    bound: Bound
    ticks: int
    done: int = 0

    @property
    def share(self) -> float:
        """Of the blend with all that is older."""
        if self.done >= self.ticks:
            return 1.0
        u = self.done / self.ticks
        return u**3 * (10.0 - 15.0 * u + 6.0 * u * u)


@final
class Transition:
    """Hierarchies that hand over to one another, the newest last.

    Args:
        old: what is in force now.

    Attributes:
        share: of the newest hierarchy in the last torque.
    """

    def __init__(self, old: Bound) -> None:
        self._live = [_Ramp(old, 0)]
        self._waiting: _Ramp | None = None
        self.share = 1.0

    @property
    def newest(self) -> Bound:
        """What comes into force last, of those that have begun."""
        return self._live[-1].bound

    @property
    def finished(self) -> bool:
        """Whether the newest is alone, and none waits."""
        return len(self._live) == 1 and self._waiting is None

    def to(self, bound: Bound, ticks: int) -> None:
        """Begin with one more, at the next tick; the last one to wait is the one."""
        ramp = _Ramp(bound, ticks)
        if ticks == 0:
            self._live, self._waiting = [ramp], None
        elif len(self._live) < MOST:
            self._live.append(ramp)
        else:
            self._waiting = ramp

    def tick(self, state: State) -> tuple[Array, Answer]:
        """Torques (n,) of the blend, and what they come from.

        Of the hierarchies that go, one that fails is dropped.

        Raises:
            ModelError, SolverError: as for `Solver.tick`, by the newest.
        """
        if self._waiting is not None and len(self._live) < MOST:
            self._live.append(self._waiting)
            self._waiting = None
        found = [self.newest.tick(state)]  # first, for it alone may fail the tick
        for ramp in self._live[-2::-1]:
            try:
                found.insert(0, ramp.bound.tick(state))
            except (SolverError, np.linalg.LinAlgError):
                self._live.remove(ramp)
        for ramp in self._live:
            ramp.done += 1
        blended = self._blend(found)
        first = max(i for i, r in enumerate(self._live) if i == 0 or r.share == 1.0)
        self._live = self._live[first:]
        self.share = self._live[-1].share if len(self._live) > 1 else 1.0
        return blended

    def _blend(self, found: list[tuple[Array, Answer]]) -> tuple[Array, Answer]:
        """What all of them give together, oldest first."""
        torque, (vdot, *_) = found[0]
        status = found[-1][1].status
        for ramp, (tau, answer) in zip(self._live[1:], found[1:], strict=True):
            torque = torque + ramp.share * (tau - torque)
            vdot = vdot + ramp.share * (answer.vdot - vdot)
        if any(answer.status is Status.INCOMPLETE for _, answer in found):
            status = Status.INCOMPLETE
        newest = found[-1][1]
        return torque, newest._replace(
            vdot=vdot, status=status, slacks=None, torque=torque
        )
