"""What a resolver is: from the rows of a stack to joint accelerations."""

from __future__ import annotations

from abc import ABC, abstractmethod
from enum import Enum
from typing import NamedTuple

from wbc.arrays import Array, IntArray
from wbc.stack import Stack
from wbc.state import State

__all__ = ["Answer", "Resolver", "Solver", "Status", "unpack"]


class Status(Enum):
    """How a tick ended; every value carries what it means.

    A lost direction or a limit that cannot be met is no failure: it shows as the
    rank and the residual of its level.
    """

    SOLVED = "all levels resolved"
    INCOMPLETE = "the limits kept changing sides; the last point was taken"
    SENSOR_INVALID = "a measurement was not finite: held by gravity and damping"
    SOLVER_FAILED = "the resolver failed: held by gravity and damping"


class Answer(NamedTuple):
    """What a resolver found.

    Attributes:
        vdot: (n,) joint accelerations.
        ranks: (p,) for each level, how many independent directions it could use.
        status: SOLVED or INCOMPLETE.
        slacks: (m,) weighted slack of every row when its own level was solved, or
            None where the resolver does not tell.
        torque: (n,) joint torques, or None where the resolver leaves them to others.
        kinetic: whether what is left free should cost least vdot^T M vdot, rather than
            least vdot^T vdot.
    """

    vdot: Array
    ranks: Array | IntArray
    status: Status
    slacks: Array | None = None
    torque: Array | None = None
    kinetic: bool = True


def unpack(found: Answer | Array, stack: Stack, status: Status) -> Answer:
    """An answer, cut out of the array that `Stack.run` wrote if it is one."""
    if isinstance(found, Answer):
        return found
    where = stack.parts
    torque, slacks = found[where.torque], found[where.slacks]
    return Answer(found[where.vdot], found[where.ranks], status, slacks, torque)


class Solver(ABC):
    """A resolver at work on one stack; may keep a warm start between ticks."""

    @abstractmethod
    def solve(self) -> Answer:
        """Resolve the stack's present rows.

        Raises:
            SolverError: no solution was found.
        """

    def tick(self, stack: Stack, state: State) -> Answer | Array:
        """Rewrite the stack's rows at this state, and resolve them.

        Returns:
            the answer, or the array that `Stack.run` wrote.

        Raises:
            ModelError, SolverError: as for `Stack.update` and `solve`.
        """
        stack.update(state)
        return self.solve()


class Resolver(ABC):
    """A strategy: how strict priorities become joint accelerations."""

    name: str

    @abstractmethod
    def start(self, stack: Stack) -> Solver:
        """A solver for this stack, with memory of its own."""
