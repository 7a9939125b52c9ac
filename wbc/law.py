"""Reference behaviour: from an error and its rate to a desired acceleration."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from wbc.approach import approach
from wbc.arrays import FLOAT, Array, frozen, per_row, positive
from wbc.errors import InputError

__all__ = ["PD", "Damper", "Law", "SaturatedPD"]


class _Settled:
    """Whose gains are set once: a stack may have copied them."""

    def __setattr__(self, name: str, value: object) -> None:
        if name in vars(self):
            raise InputError(
                f"'{name}' of a law cannot change: give its task a new law, "
                f"task.law = {type(self).__name__}(...)."
            )
        super().__setattr__(name, value)


class Law(ABC):
    """Desired acceleration of a quantity that should go to zero."""

    @abstractmethod
    def acceleration(self, error: Array, rate: Array) -> Array:
        """Acceleration (m,) wanted at this error (m,) and error rate (m,)."""


@final
class PD(_Settled, Law):
    """-kp e - kd de/dt: a mass on a spring and a damper.

    Args:
        stiffness: kp [1/s^2], one number or one a row.
        damping: kd [1/s]; critical, 2 sqrt(kp), by default.

    Raises:
        InputError: a gain is negative or not finite.
    """

    def __init__(self, stiffness: ArrayLike, damping: ArrayLike | None = None) -> None:
        self.stiffness = per_row(stiffness, "stiffness")
        critical = 2.0 * np.sqrt(self.stiffness)
        self.damping = per_row(critical if damping is None else damping, "damping")

    def acceleration(self, error: Array, rate: Array) -> Array:
        """-kp e - kd de/dt."""
        return -(self.stiffness * error) - self.damping * rate

    def __repr__(self) -> str:
        return f"PD({self.stiffness}, {self.damping})"


@final
class Damper(_Settled, Law):
    """-kd de/dt: a velocity that should vanish, wherever the error is.

    Args:
        damping: kd [1/s], one number or one a row.

    Raises:
        InputError: the gain is negative or not finite.
    """

    def __init__(self, damping: ArrayLike) -> None:
        self.damping = per_row(damping, "damping")

    def acceleration(self, error: Array, rate: Array) -> Array:
        """-kd de/dt."""
        return -(self.damping * rate)

    def __repr__(self) -> str:
        return f"Damper({self.damping})"


@final
class SaturatedPD(_Settled, Law):
    """A PD that approaches from afar at a bounded speed (Khatib 1987; P4 sec. III-B).

    The wanted velocity -(kp / kd) e is shortened to `speed`, and to what half of
    `acceleration` can stop in time; the acceleration is shortened too. All are
    shortened as vectors, so the way stays straight.

    Args:
        stiffness: kp [1/s^2]; damping is critical, kd = 2 sqrt(kp).
        speed: largest wanted speed [m/s or rad/s].
        acceleration: largest wanted acceleration [m/s^2 or rad/s^2].

    Attributes:
        gains: (4,) kp, kd, speed, acceleration, for `wbc.approach`.

    Raises:
        InputError: a number is not greater than 0.
    """

    def __init__(self, stiffness: float, speed: float, acceleration: float) -> None:
        self.stiffness = per_row(positive(stiffness, "stiffness"), "stiffness")
        self.damping = per_row(2.0 * np.sqrt(self.stiffness), "damping")
        self.speed = positive(speed, "speed")
        self.largest = positive(acceleration, "acceleration")
        kp, kd = float(self.stiffness), float(self.damping)
        gains = [kp, kd, self.speed, self.largest]
        self.gains = frozen(gains, (4,), "gains")

    def acceleration(self, error: Array, rate: Array) -> Array:
        """-kd (de/dt - v_d), v_d = -(kp / kd) e, both shortened."""
        error, rate = np.array(error, FLOAT), np.array(rate, FLOAT)
        wish = np.empty(error.size)
        approach(error, rate, self.gains, wish)
        return wish

    def __repr__(self) -> str:
        return f"SaturatedPD({self.stiffness}, {self.speed}, {self.largest})"
