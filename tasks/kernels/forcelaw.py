"""The law of a force: what it commands, and how its integral term moves on."""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array
from wbc.compiled import compiled

__all__ = ["command", "integrate"]


@compiled
def command(
    gain: float, desired: Array, measured: Array, held: Array, out: Array
) -> None:
    """Write f* = F_d + kp (F_d - F_s) + held, all (m,)."""
    for k in range(out.size):
        out[k] = desired[k] + gain * (desired[k] - measured[k]) + held[k]


@compiled
def integrate(held: Array, rate: Array, dt: float, limit: float) -> None:
    """Move the integral term (m,) on at a rate (m,), within +-limit; not by NaN."""
    for k in range(held.size):
        moved = held[k] + dt * rate[k]
        if not np.isnan(moved):
            held[k] = min(max(moved, -limit), limit)
