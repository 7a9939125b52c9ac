"""The guide line where the knife is now, from the newest frame."""

from __future__ import annotations

from typing import NamedTuple, final

import numpy as np

from sims.cutting.camera import Frame
from sims.cutting.guide import GuideSurface
from sims.cutting.polynomial import Polynomial
from wbc import InputError
from wbc.arrays import Array, positive

__all__ = ["LiveGuide", "Sight"]

REACH_X, REACH_Z = 0.045, 0.035
"""How far around the knife points count [m]."""
SPREAD = 0.02
"""Half the length of the piece of guide line that is kept [m]."""
SETTLING = 0.3
"""Share by which a new difference of two frames changes the estimated rate."""
LOOK_AHEAD = 0.06
"""Longest time that the estimated rate is believed [s]."""


class Sight(NamedTuple):
    """The guide line at one x and one time.

    Attributes:
        y: [m].
        slope: dy/dx.
        rate: its motion at this x [m/s].
    """

    y: float
    slope: float
    rate: float


@final
class LiveGuide:
    """A short piece of the guide line around the knife, moved on between frames.

    Args:
        noise: standard deviation of the points that is expected [m].
    """

    def __init__(self, noise: float = 0.0) -> None:
        self._noise = positive(noise, "noise", zero=True)
        self.forget()

    def forget(self) -> None:
        """Start anew, as at the start of a passage."""
        self._line: Polynomial | None = None
        self._t, self._rate = -np.inf, 0.0

    def age(self, t: float) -> float:
        """How old the newest usable frame is at time t [s]; infinite without one."""
        return t - self._t

    def see(self, frame: Frame, x: float, z: float) -> None:
        """Take in a frame, for a knife at x and depth z [m].

        A frame seen before is nothing new, and one with too few points around the
        knife is none: the last piece of line holds, and grows old.
        """
        if frame.t <= self._t:
            return
        line = self._piece(frame.points, x, z)
        if line is None:
            return
        if self._line is not None:
            moved = (line.at(x).y - self._line.at(x).y) / (frame.t - self._t)
            self._rate += SETTLING * (moved - self._rate)
        self._line, self._t = line, frame.t

    def at(self, x: float, t: float) -> Sight | None:
        """The guide line at x and time t; None before the first usable frame."""
        if self._line is None:
            return None
        y, slope, _, _ = self._line.at(x)
        late = self.age(t)
        trusted = 0.0 <= late <= LOOK_AHEAD
        rate = self._rate if trusted else 0.0
        return Sight(y + self._rate * min(max(late, 0.0), LOOK_AHEAD), slope, rate)

    def _piece(self, points: Array, x: float, z: float) -> Polynomial | None:
        near = np.abs(points[:, 0] - x) < REACH_X
        near &= np.abs(points[:, 2] - z) < REACH_Z
        try:
            surface = GuideSurface(points[near], self._noise)
            return surface.fit(z, x - SPREAD, x + SPREAD, samples=5)
        except InputError:
            return None
