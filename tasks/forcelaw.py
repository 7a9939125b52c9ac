"""Law of a force that should be exerted: feed-forward, P and I with anti-windup."""

from __future__ import annotations

from typing import final

import numpy as np

from tasks.kernels.forcelaw import command, integrate
from wbc.arrays import Array, positive
from wbc.errors import InputError

__all__ = ["ForceLaw"]


@final
class ForceLaw:
    """f* = F_d + kp (F_d - F_s) + ki int (F_d - F_s) dt: P4 eq. (22), mended.

    F_s is what the robot exerts on its surroundings, like F_d. Without the feed-forward
    the printed law settles at kp / (1 + kp) F_d; in rigid contact it diverges for
    kp >= 1, as soon as the sensor is a tick late.

    Args:
        proportional: kp [1], below 1.
        integral: ki [1/s].
        limit: largest magnitude of the integral term [N or Nm]: its anti-windup.

    Raises:
        InputError: a negative number, or kp >= 1.
    """

    def __init__(
        self, proportional: float = 0.0, integral: float = 5.0, limit: float = 100.0
    ) -> None:
        self.proportional = positive(proportional, "proportional", zero=True)
        self.integral = positive(integral, "integral", zero=True)
        self.limit = positive(limit, "limit")
        if self.proportional >= 1.0:
            raise InputError(
                f"a proportional force gain of {proportional} diverges in rigid "
                "contact with a sensor that is a tick late: it must be below 1."
            )

    def command(self, desired: Array, measured: Array, held: Array) -> Array:
        """F* (m,) for F_d (m,), F_s (m,) and the integral term (m,)."""
        out = np.empty(held.size)
        command(self.proportional, desired, measured, held, out)
        return out

    def integrate(self, held: Array, rate: Array, dt: float) -> Array:
        """The integral term (m,) after dt [s] at a rate [N/s]; kept if that is NaN."""
        moved = np.array(held)
        integrate(moved, rate, dt, self.limit)
        return moved

    def __repr__(self) -> str:
        return f"ForceLaw({self.proportional}, {self.integral}, {self.limit})"
