"""What joint sensors add to the truth: noise, bias, delay."""

from __future__ import annotations

from collections import deque
from typing import final

import numpy as np

from wbc.arrays import Array, positive
from wbc.checks import whole

__all__ = ["Encoders"]

LATEST = 100_000
"""Ticks by which readings may be late, as all of them are kept."""


@final
class Encoders:
    """Position and velocity sensors of all joints; perfect by default.

    Args:
        position_noise: standard deviation [rad].
        velocity_noise: standard deviation [rad/s].
        position_bias: largest constant offset of a joint, drawn uniformly [rad].
        delay: readings late by so many ticks.
        seed: of the noise.

    Raises:
        InputError: a negative number, or a delay or seed that is not whole.
    """

    def __init__(
        self,
        *,
        position_noise: float = 0.0,
        velocity_noise: float = 0.0,
        position_bias: float = 0.0,
        delay: int = 0,
        seed: int = 0,
    ) -> None:
        self._noise = (
            positive(position_noise, "position_noise", zero=True),
            positive(velocity_noise, "velocity_noise", zero=True),
        )
        self._bias = positive(position_bias, "position_bias", zero=True)
        self._delay, self._seed = (
            whole(delay, "delay", most=LATEST),
            whole(seed, "seed"),
        )
        self.reset()

    def reset(self) -> None:
        """Forget what was read and start the noise again."""
        self._rng = np.random.default_rng(self._seed)
        self._offset: Array | None = None
        self._past: deque[tuple[Array, Array]] = deque(maxlen=self._delay + 1)

    def read(self, q: Array, v: Array) -> tuple[Array, Array]:
        """Readings (n,), (n,) for the true q (n,), v (n,)."""
        if self._offset is None:
            self._offset = self._rng.uniform(-self._bias, self._bias, q.size)
        q = q + self._offset
        if any(self._noise):
            q = q + self._rng.normal(0.0, self._noise[0], q.size)
            v = v + self._rng.normal(0.0, self._noise[1], v.size)
        self._past.append((q, v))
        return self._past[0]
