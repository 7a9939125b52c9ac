"""Damped inverse of a task's rows near a singularity."""

from __future__ import annotations

from typing import final

from wbc.arrays import positive

__all__ = ["DampedInverse"]


@final
class DampedInverse:
    """Damping for the force only; a projector must never contain it, or it leaks.

    In a direction of relative singular value s < threshold a level J minimises
    |J x - b|^2 + lambda^2 |x - rest|^2, lambda^2 = (1 - (s / threshold)^2) factor^2,
    so that its motion is damped towards rest: what the task does not get there goes to
    -rate times the velocity. Damped towards zero acceleration, as in a plain damped
    inverse, that velocity would never die, and an arm stretched for a goal beyond its
    reach would swing about its border (Wampler and Leifer 1988).

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
