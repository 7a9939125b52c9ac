"""Two frames of a robot that must not come near each other."""

from __future__ import annotations

from typing import final

import numpy as np

from wbc import Robot, Rows, State, Task
from wbc.arrays import positive
from wbc.checks import named, text
from wbc.errors import InputError
from wbc.settled import Settled

__all__ = ["Clearance"]

CONTACT = 1e-9
"""Distance below which two points have no direction between them [m]."""


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

    def update(self, state: State, rows: Rows) -> None:
        """Write the row."""
        A, B = (state.frame(name) for name in self.frames)
        apart, v = A.p - B.p, A.V[:3] - B.V[:3]
        d = float(np.sqrt(apart @ apart))
        n = apart / d if d > CONTACT else np.eye(3)[2]
        along = float(n @ v)
        spare = d - self.distance
        rows.A[0] = n @ (A.J[:3] - B.J[:3])
        rows.error[0], rows.rate[0] = min(spare, 0.0), along
        turning = (v @ v - along * along) / max(d, CONTACT)
        rows.drift[0] = n @ (A.drift[:3] - B.drift[:3]) + turning
        wanted = -2.0 * self.rate * along - self.rate**2 * spare
        rows.lower[0], rows.upper[0] = wanted - rows.drift[0], np.inf
