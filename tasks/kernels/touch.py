"""What tasks on forces share: a frame's rows in their axes, and the measured wrench.

Their parameters begin with R_WD of their axes D (9,), by rows; p_d, its velocity and
its acceleration (3,) each; R_d (9,); the force in D (6,).
"""

from __future__ import annotations

from typing import Final

from wbc.arrays import Array
from wbc.compiled import compiled, inner
from wbc.frames import FrameState, frame_at
from wbc.rows import Rows

__all__ = [
    "FORCE",
    "OWN",
    "TARGET",
    "TARGET_ROTATION",
    "component",
    "felt_at",
    "in_axes",
    "press",
]

TARGET: Final = 9
TARGET_ROTATION: Final = 18
FORCE: Final = 27
OWN: Final = 33
"""Where these begin, and where each task's own begin."""


@inner
def component(R: Array, x: Array, i: int) -> float:
    """Component i of R^T x, for R (9,) by rows and x (3,)."""
    return float(R[i] * x[0] + R[3 + i] * x[1] + R[6 + i] * x[2])


@inner
def in_axes(R: Array, F: FrameState, out: Rows) -> None:
    """A, rate and drift of blockdiag(R, R)^T times the twist, as many rows as A has."""
    A, J = out.A, F.J
    for row in range(A.shape[0]):
        begin, i = row - row % 3, row % 3
        out.rate[row] = component(R, F.V[begin : begin + 3], i)
        out.drift[row] = component(R, F.drift[begin : begin + 3], i)
        for c in range(A.shape[1]):
            A[row, c] = R[i] * J[begin, c] + R[3 + i] * J[begin + 1, c]
            A[row, c] += R[6 + i] * J[begin + 2, c]


@inner
def felt_at(F: FrameState, sensor: Array, measured: Array, h: Array) -> None:
    """A wrench about F's origin, from what was measured about the sensor's.

    Args:
        F: the frame.
        sensor: (3,) or more; origin of the sensor's frame.
        measured: (6,) wrench there, world axes.
        h: (6,) is written.
    """
    x, y, z = sensor[0] - F.p[0], sensor[1] - F.p[1], sensor[2] - F.p[2]
    for i in range(6):
        h[i] = measured[i]
    h[3] += y * measured[2] - z * measured[1]
    h[4] += z * measured[0] - x * measured[2]
    h[5] += x * measured[1] - y * measured[0]


@compiled
def press(flat: Array, h: Array, torque: Array) -> None:
    """Torque (n,) += J^T h, for a flat frame and a wrench h (6,) about its origin."""
    n = torque.size
    J = frame_at(flat, n).J
    for j in range(n):
        torque[j] += (h[0] * J[0, j] + h[1] * J[1, j] + h[2] * J[2, j]) + (
            h[3] * J[3, j] + h[4] * J[4, j] + h[5] * J[5, j]
        )
