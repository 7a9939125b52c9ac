"""What a camera adds to the truth: frames, delay, noise, lost points, blindness."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from typing import NamedTuple, final

import numpy as np

from wbc import InputError
from wbc.arrays import Array, positive

__all__ = ["Camera", "Frame"]

ROUND_OFF = 1e-9


class Frame(NamedTuple):
    """One picture's worth of points.

    Attributes:
        t: when it was taken [s].
        points: (k, 3) of the interface, in the world [m].
    """

    t: float
    points: Array


@final
class Camera:
    """Locates points of the interface, as the third robot's camera would.

    Args:
        rate: frames per second [1/s].
        delay: from the picture to its result [s].
        noise: standard deviation of each coordinate [m].
        dropped: share of the points that a frame misses, drawn anew each time.
        blind: intervals (from, to) [s] in which it takes no pictures.
        seed: of noise and losses.

    Raises:
        InputError: a rate that is not positive, a negative number, a share of 1 or
            more, or an interval that ends before it begins.
    """

    def __init__(
        self,
        *,
        rate: float = 60.0,
        delay: float = 0.0,
        noise: float = 0.0,
        dropped: float = 0.0,
        blind: Sequence[tuple[float, float]] = (),
        seed: int = 0,
    ) -> None:
        self.rate = positive(rate, "frame rate")
        self.delay = positive(delay, "delay", zero=True)
        self.noise = positive(noise, "noise", zero=True)
        self.dropped = positive(dropped, "dropped", zero=True)
        if self.dropped >= 1.0:
            raise InputError("dropped is a share of the points, below 1.")
        if any(not a <= b for a, b in blind):
            raise InputError(f"blind intervals must be (from, to): {list(blind)}.")
        self._blind, self._seed = tuple(blind), seed
        self.reset()

    def reset(self) -> None:
        """Forget all frames and start the noise again."""
        self._rng = np.random.default_rng(self._seed)
        self._taken = -1
        self._latest: Frame | None = None
        self._waiting: deque[Frame] = deque()

    def look(self, t: float, points: Callable[[], Array]) -> Frame | None:
        """The newest frame that has arrived at time t [s]; None before the first.

        Args:
            t: never earlier than in the call before.
            points: gives the true points (N, 3); called only for a new picture.
        """
        number = int(np.floor(t * self.rate + ROUND_OFF))
        if number > self._taken:
            self._taken = number
            if not self._is_blind(t):
                self._waiting.append(Frame(t, self._see(points())))
        while self._waiting and self._waiting[0].t + self.delay <= t + ROUND_OFF:
            self._latest = self._waiting.popleft()
        return self._latest

    def _is_blind(self, t: float) -> bool:
        return any(a <= t < b for a, b in self._blind)

    def _see(self, points: Array) -> Array:
        if self.dropped:
            points = points[self._rng.random(len(points)) >= self.dropped]
        if self.noise:
            points = points + self._rng.normal(0.0, self.noise, points.shape)
        return np.array(points)
