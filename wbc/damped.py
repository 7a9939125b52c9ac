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
    lambda^2 = (1 - (s / threshold)^2) factor^2.

    Args:
        threshold: relative to the norm of the unprojected task.
        factor: largest damping, on the same scale.
    """

    def __init__(self, threshold: float = 0.1, factor: float = 0.05) -> None:
        self.threshold = positive(threshold, "threshold")
        self.factor = positive(factor, "factor")

    def solve(self, factor: Factor, b: Array, scale: float) -> Array:
        """Damped least-squares solution of the factorised system, (n,)."""
        s = factor.sigma / scale
        square = np.maximum(1.0 - (s / self.threshold) ** 2, 0.0) * self.factor**2
        gain = s / (s * s + square) / scale
        return factor.V1 @ (gain * (factor.U.T @ b))
