"""What a resolver is: from the rows of a stack to joint accelerations."""

from __future__ import annotations

from abc import ABC, abstractmethod
from enum import Enum
from typing import NamedTuple, final

from wbc.arrays import Array, IntArray
from wbc.stack import Stack
from wbc.state import State

__all__ = ["Answer", "Packed", "Parts", "Resolver", "Solver", "Status"]


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


class Parts(NamedTuple):
    """Where the parts of an answer lie in one array.

    Attributes:
        torque, vdot, slacks, ranks: of the same names in `Answer`.
    """

    torque: slice
    vdot: slice
    slacks: slice
    ranks: slice


@final
class Packed:
    """An answer as compiled code wrote it: in one array, and cut out when asked for.

    Args:
        found: the array.
        parts: where they lie.
        status: SOLVED or INCOMPLETE.

    Attributes:
        torque: (n,) joint torques, which everyone asks for.
    """

    __slots__ = ("_found", "_parts", "status", "torque")

    kinetic = True

    def __init__(self, found: Array, parts: Parts, status: Status) -> None:
        self._found, self._parts, self.status = found, parts, status
        self.torque = found[parts.torque]

    @property
    def vdot(self) -> Array:
        """(n,) joint accelerations."""
        return self._found[self._parts.vdot]

    @property
    def slacks(self) -> Array:
        """(m,) weighted slack of every row when its own level was solved."""
        return self._found[self._parts.slacks]

    @property
    def ranks(self) -> Array:
        """(p,) for each level, how many independent directions it could use."""
        return self._found[self._parts.ranks]


class Solver(ABC):
    """A resolver at work on one stack; may keep a warm start between ticks."""

    @abstractmethod
    def solve(self) -> Answer:
        """Resolve the stack's present rows.

        Raises:
            SolverError: no solution was found.
        """

    def tick(self, stack: Stack, state: State) -> Answer | Packed:
        """Rewrite the stack's rows at this state, and resolve them.

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
