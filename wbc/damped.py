"""Damped inverse of a task's rows near a singularity."""

from __future__ import annotations

from typing import final

import numpy as np

from wbc.arrays import Array, positive
from wbc.linalg import Factor

__all__ = ["DampedInverse"]


@final
class DampedInverse:
    """Damping for the force only; a projector must never contain it, or it leaks.

    A direction of relative singular value s < threshold is inverted with
    lambda^2 = (1 - (s / threshold)^2) factor^2, and its motion is damped towards rest:
    what the task does not get there goes to -rate times the velocity. Damped towards
    zero acceleration, as in a plain damped inverse, that velocity would never die, and
    an arm stretched for a goal beyond its reach would swing about its border (Wampler
    and Leifer 1988).

    Args:
        threshold: relative to the norm of the unprojected task.
        factor: largest damping, on the same scale.
        rate: at which motion in a lost direction dies out [1/s].

    Raises:
        InputError: a number is not greater than 0.
    """

    def __init__(
        self, threshold: float = 0.1, factor: float = 0.05, rate: float = 20.0
    ) -> None:
        self.threshold = positive(threshold, "threshold")
        self.factor = positive(factor, "factor")
        self.rate = positive(rate, "rate")

    def solve(self, factor: Factor, b: Array, scale: float, rest: Array) -> Array:
        """Minimiser z (n,) of |A z - b|^2 + lambda^2 |z - rest|^2 in the row space.

        Args:
            factor: of A.
            b: (m,) what A z should be.
            scale: norm of the task before projection.
            rest: (n,) what z would be if all motion were to die out.
        """
        s = factor.sigma / scale
        square = np.maximum(1.0 - (s / self.threshold) ** 2, 0.0) * self.factor**2
        wanted = s / scale * (factor.U.T @ b)
        return factor.V1 @ ((wanted + square * (factor.V1.T @ rest)) / (s * s + square))
