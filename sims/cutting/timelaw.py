"""How far along, and when: the quintic time law, and a clock that can slow down."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, final

from wbc.arrays import positive

__all__ = ["STILL", "Clock", "Motion", "Quintic"]


class Motion(NamedTuple):
    """A quantity and its first two derivatives by time."""

    value: float
    rate: float
    acceleration: float


STILL = Motion(0.0, 0.0, 0.0)


@final
@dataclass(frozen=True, slots=True)
class Quintic:
    """s(t) from rest to rest, P0 eqs. (9)-(11).

    s = D (10 u^3 - 15 u^4 + 6 u^5), u = t / T. Its greatest speed is 1.875 D / T, its
    greatest acceleration 5.774 D / T^2.

    Attributes:
        distance: D [m], of either sign.
        duration: T [s].
    """

    distance: float
    duration: float

    def __post_init__(self) -> None:
        """Refuse a duration that is not positive."""
        positive(self.duration, "duration of a motion")

    def at(self, t: float) -> Motion:
        """Position, speed, acceleration at time t [s]; at rest outside [0, T]."""
        u = min(max(t / self.duration, 0.0), 1.0)
        D, rate = self.distance, 1.0 / self.duration
        return Motion(
            D * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u),
            D * rate * 30.0 * u * u * (1.0 - u) * (1.0 - u),
            D * rate * rate * 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u),
        )


@final
class Clock:
    """Time of a motion that can be slowed to a stop, and go on, without a jolt.

    The pace dtau/dt follows what is wanted (1 goes, 0 stops) as a critically damped
    second-order system, so a motion s(tau) stays twice differentiable in t.

    Args:
        quickness: of the change of pace [1/s].
    """

    def __init__(self, quickness: float = 12.0) -> None:
        self._quickness = positive(quickness, "quickness")
        self.restart()

    def restart(self) -> None:
        """Set time to 0, at full pace."""
        self.time, self.pace, self._change = 0.0, 1.0, 0.0

    def tick(self, dt: float, wanted: float) -> None:
        """Move on by dt [s] towards the wanted pace, from 0 to 1."""
        w = self._quickness
        self._change += dt * (w * w * (wanted - self.pace) - 2.0 * w * self._change)
        self.pace = min(max(self.pace + dt * self._change, 0.0), 1.0)
        self.time += dt * self.pace

    def slowed(self, motion: Motion) -> Motion:
        """A motion given in the clock's time, as one in real time."""
        value, rate, acceleration = motion
        pace = self.pace
        bent = acceleration * pace * pace + rate * self._change
        return Motion(value, rate * pace, bent)
