"""Reference behaviour: from an error and its rate to a desired acceleration."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from wbc.arrays import Array, per_row

__all__ = ["PD", "Damper", "Law"]


class Law(ABC):
    """Desired acceleration of a quantity that should go to zero."""

    @abstractmethod
    def acceleration(self, error: Array, rate: Array) -> Array:
        """Acceleration (m,) wanted at this error (m,) and error rate (m,)."""


@final
class PD(Law):
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
class Damper(Law):
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
