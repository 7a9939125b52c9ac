"""Acceleration of an approach whose speed is bounded, for tasks in any language."""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array
from wbc.compiled import compiled
from wbc.vectors import length

__all__ = ["approach"]


@compiled
def approach(error: Array, rate: Array, gains: Array, out: Array) -> None:
    """Write -kd (de/dt - v_d), v_d = -(kp / kd) e, both shortened as vectors.

    Args:
        error: (m,).
        rate: (m,) its rate of change.
        gains: (4,) kp [1/s^2], kd [1/s], largest speed, largest acceleration; half of
            the last must be able to stop the approach in time.
        out: (m,) is written; none of the others.
    """
    kp, kd, largest = gains[0], gains[1], gains[3]
    far = length(error)
    speed = min(gains[2], np.sqrt(largest * far))
    steep = kp / kd
    pull = steep if steep * far <= speed else speed / far
    for i in range(error.size):
        out[i] = -kd * (pull * error[i] + rate[i])
    size = length(out)
    if not size <= largest:  # NaN must stay NaN
        for i in range(error.size):
            out[i] *= largest / size
