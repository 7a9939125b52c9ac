"""A spiral wound outwards at constant speed."""

from __future__ import annotations

from typing import final

import numpy as np

from wbc.arrays import Array, positive

__all__ = ["Spiral"]


@final
class Spiral:
    """The curve r = pitch angle / (2 pi), advanced in steps of time.

    Args:
        pitch: between two turns [m].
        speed: along the curve [m/s].

    Raises:
        InputError: a number that is not positive.

    Attributes:
        angle: turned so far [rad].
    """

    def __init__(self, pitch: float, speed: float) -> None:
        self._growth = positive(pitch, "pitch") / (2.0 * np.pi)
        self._speed = positive(speed, "speed")
        self.angle = 0.0

    @property
    def radius(self) -> float:
        """Distance from the centre [m]."""
        return self._growth * self.angle

    def advance(self, dt: float) -> tuple[Array, Array]:
        """Offset from the centre (3,) [m] and velocity (3,) [m/s], dt [s] later."""
        turning = self._speed / (self._growth * float(np.hypot(1.0, self.angle)))
        self.angle += turning * dt
        a, c, s = self.angle, np.cos(self.angle), np.sin(self.angle)
        offset = self._growth * a * np.array([c, s, 0.0])
        along = np.array([c - a * s, s + a * c, 0.0])
        return offset, self._growth * turning * along
