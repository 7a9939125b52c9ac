"""Two frames of a robot that must not come near each other."""

from __future__ import annotations

from typing import final

import numpy as np

from tasks.base import run_kernel
from tasks.evaluator import SCRATCH, Code, run
from wbc import Kernel, Robot, Rows, State, Task
from wbc.arrays import Array, positive
from wbc.checks import named, text
from wbc.errors import InputError
from wbc.kernel import NO_TABLE
from wbc.relative import relative
from wbc.settled import Settled

__all__ = ["Clearance"]


@final
class Clearance(Settled, Task):
    """|p_A - p_B| >= distance, one row [m/s^2]; for two arms in one model.

    With c = |p_A - p_B| - distance the row asks for cdd + 2 a cd + a^2 c >= 0: c decays
    no faster than a critically damped system, so from c >= 0 at a moderate approach it
    never gets negative, and from c < 0 it comes back. Spheres around elbows, wrists or
    tools make this a guard against collisions.

    Args:
        first: name of frame A.
        second: name of frame B.
        distance: [m].
        rate: a, how abruptly an approach may be stopped [1/s].
        name: "<first> clear of <second>" by default.

    Raises:
        InputError: a number that is not positive, or one frame twice.
    """

    def __init__(
        self,
        first: str,
        second: str,
        distance: float,
        *,
        rate: float = 10.0,
        name: str | None = None,
    ) -> None:
        first, second = text(first, "first frame"), text(second, "second frame")
        if first == second:
            raise InputError(f"'{first}' has no distance from itself: name two frames.")
        name = named(name, f"{first} clear of {second}")
        super().__init__(name, "m", (first, second))
        self.distance = positive(distance, "distance")
        self.rate = positive(rate, "rate")

    def row_names(self, robot: Robot) -> tuple[str, ...]:
        """One."""
        del robot
        return ("distance",)

    def _parameters(self) -> Array:
        return np.array([self.distance, self.rate])

    def kernel(self, robot: Robot) -> Kernel:
        """The compiled half."""
        del robot
        return Kernel(run, int(Code.CLEARANCE), self._parameters())

    def update(self, state: State, rows: Rows) -> None:
        """Write the row."""
        first, second = (state.flat(name) for name in self.frames)
        seen = np.zeros(first.size)
        relative(first, second, seen, np.zeros(SCRATCH), state.robot.nv)
        run_kernel(Code.CLEARANCE, self._parameters(), NO_TABLE, seen, state, rows)
