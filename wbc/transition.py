"""From one hierarchy to the next at run time, without a jump in torque.

While a change is under way both stacks are resolved, and the robot gets

    tau = tau_old + s (tau_new - tau_old),      0 < s <= 1,

with s a quintic in time, stretched where it would change a torque too fast. Limits that
both keep are kept, because they are convex; a task that both meet is met, because it is
affine in vdot. A change that comes while another one is under way starts from the
blend, so any number may follow each other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from wbc.arrays import Array
from wbc.errors import InputError, SolverError, shown
from wbc.hierarchy import Hierarchy
from wbc.resolver import Answer, Resolver, Status, unpack
from wbc.robot import Robot
from wbc.stack import Stack
from wbc.state import State

__all__ = ["Bound", "Transition"]

MOST = 4
"""Stacks that are resolved in one tick; a further change waits for its turn."""
STEEPEST = 1.875
"""Largest slope of the quintic."""
END = 1e-9
"""A ramp this close to its end is there."""


@final
class Bound:
    """A hierarchy at work: its stack, and the solver of a resolver for it.

    Raises:
        UnknownName, InputError: a task does not fit the robot, or the resolver is none.
    """

    __slots__ = ("hierarchy", "solver", "stack")

    def __init__(self, robot: Robot, hierarchy: Hierarchy, resolver: Resolver) -> None:
        if not isinstance(resolver, Resolver):
            raise InputError(
                f"expected a resolver such as HierarchicalQP() or NullSpace(), got "
                f"{shown(resolver)}."
            )
        self.hierarchy = hierarchy
        self.stack = Stack(robot, hierarchy)
        self.solver = resolver.start(self.stack)

    def tick(self, state: State) -> tuple[Array, Answer | Array, Status]:
        """Torques (n,) at a state, what they come from (to unpack), and how it ended.

        Raises:
            ModelError, SolverError: as for `Solver.tick`, or a torque is not finite.
        """
        stack = self.stack
        found = self.solver.tick(stack, state)
        if isinstance(found, Answer):
            given = found.torque
            torque = stack.torque(found.vdot) if given is None else given
            return torque, found, found.status
        status = Status.SOLVED if stack.solved else Status.INCOMPLETE
        return found[stack.parts.torque], found, status

    def answer(self, state: State) -> tuple[Array, Answer]:
        """The same, unpacked."""
        torque, found, status = self.tick(state)
        return torque, unpack(found, self.stack, status)


@dataclass(slots=True, eq=False)
class _Ramp:
    """A hierarchy on its way in; u goes from 0 to 1, by `step` a tick at most.

    `most` is by how much it may change a torque in a tick [Nm].
    """

    bound: Bound
    step: float = 1.0
    most: float = np.inf
    u: float = 0.0

    @property
    def share(self) -> float:
        """Of the blend with all that is older."""
        u = self.u
        return u**3 * (10.0 - 15.0 * u + 6.0 * u * u)

    def advance(self, difference: Array, others: int) -> float:
        """Move on, while so many others ramp too; slower where torques (n,) differ."""
        largest = STEEPEST * others * float(np.abs(difference).max())
        step = self.step if largest == 0.0 else min(self.step, self.most / largest)
        self.u = 1.0 if self.u + step > 1.0 - END else self.u + step
        return self.share


@final
class Transition:
    """Hierarchies that hand over to one another, the newest last.

    Args:
        old: what is in force now.

    Attributes:
        share: of the newest hierarchy in the last torque.
    """

    def __init__(self, old: Bound) -> None:
        self._live = [_Ramp(old, u=1.0)]
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

    @property
    def parts(self) -> list[tuple[Hierarchy, float]]:
        """Hierarchies in the last torque and their shares of it, the oldest first."""
        rest, found = 1.0, []
        for ramp in self._live[:0:-1]:
            found.append((ramp.bound.hierarchy, rest * ramp.share))
            rest *= 1.0 - ramp.share
        return [(self._live[0].bound.hierarchy, rest), *found[::-1]]

    def to(self, bound: Bound, ticks: int, most: float) -> None:
        """Begin with one more, at the next tick; the last one to wait is the one.

        Args:
            bound: the hierarchy.
            ticks: that it takes to come in, 0 for at once.
            most: change of a torque in one tick that this may cause [Nm].
        """
        ramp = _Ramp(bound, 1.0 / max(ticks, 1), most)
        if ticks == 0:
            self._live, self._waiting = [_Ramp(bound, u=1.0)], None
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
        found = [self.newest.answer(state)]  # first, for it alone may fail the tick
        for ramp in self._live[-2::-1]:
            try:
                found.insert(0, ramp.bound.answer(state))
            except (SolverError, np.linalg.LinAlgError):
                self._live.remove(ramp)
        blended = self._blend(found)
        first = max(i for i, r in enumerate(self._live) if i == 0 or r.share == 1.0)
        self._live = self._live[first:]
        self.share = self._live[-1].share if len(self._live) > 1 else 1.0
        return blended

    def _blend(self, found: list[tuple[Array, Answer]]) -> tuple[Array, Answer]:
        """What all of them give together, oldest first."""
        torque, vdot = found[0][0], found[0][1].vdot
        status, ramps = found[-1][1].status, self._live[1:]
        self._live[0].u = 1.0  # nothing older is left to blend with
        for ramp, (tau, answer) in zip(ramps, found[1:], strict=True):
            share = ramp.advance(tau - torque, len(ramps))
            torque = torque + share * (tau - torque)
            vdot = vdot + share * (answer.vdot - vdot)
        if any(answer.status is Status.INCOMPLETE for _, answer in found):
            status = Status.INCOMPLETE
        newest = found[-1][1]
        return torque, Answer(
            vdot, newest.ranks, status, torque=torque, kinetic=newest.kinetic
        )
