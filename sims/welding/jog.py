"""An operator's jogging of the torch: angles about two of its axes over time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from tasks import FrameOrientation
from tasks.along import smooth_rise
from wbc.arrays import Array

__all__ = ["Jog"]

RISE = 1.0
"""Time over which the scripted motion fades in [s]."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Jog:
    """Turns a torch about its own axes: R_d(t) = R_0 Rx(a) Rz(b).

    Attributes:
        R: (3, 3) R_0.
        tilt: amplitude of a, about the torch's x axis [rad].
        spin: amplitude of b, about the torch's z axis [rad].
        period: of the sinusoids [s].
    """

    R: Array
    tilt: float = 0.3
    spin: float = 0.3
    period: float = 4.0

    def script(self, task: FrameOrientation, t: float) -> None:
        """Move the task's target to time t [s], with velocity and acceleration."""
        a, ad, add = self._wave(t, self.tilt, 1.0)
        b, bd, bdd = self._wave(t, self.spin, 0.7)
        Rx, Rz = turn(0, a), turn(2, b)
        x, z = np.eye(3)[0], Rx @ np.eye(3)[2]
        omega = ad * x + bd * z
        alpha = add * x + bdd * z + ad * bd * np.cross(x, z)
        task.set_target(self.R @ Rx @ Rz, self.R @ omega, self.R @ alpha)

    def _wave(self, t: float, size: float, pace: float) -> tuple[float, float, float]:
        """Size * rise(t) * sin(w t) and two derivatives, the rise quintic."""
        w = 2.0 * np.pi * pace / self.period
        s, c = np.sin(w * t), np.cos(w * t)
        u = min(max(t / RISE, 0.0), 1.0)
        r, rd = smooth_rise(u)
        rd, rdd = rd / RISE, (60 * u - 180 * u**2 + 120 * u**3) / RISE**2
        return (
            float(size * r * s),
            float(size * (rd * s + r * w * c)),
            float(size * (rdd * s + 2.0 * rd * w * c - r * w * w * s)),
        )


def turn(axis: int, angle: float) -> Array:
    """Rotation (3, 3) about a coordinate axis by an angle [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = np.eye(3)
    R[i, i], R[j, j], R[i, j], R[j, i] = c, c, -s, s
    return R
