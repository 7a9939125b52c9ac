"""A moving pose as numbers that kernels read, checked on the way."""

from __future__ import annotations

from wbc.arrays import ROTATION_TOLERANCE, Array
from wbc.compiled import compiled, inner
from wbc.vectors import finite

__all__ = ["FINE", "INFINITE", "NO_ROTATION", "take_pose"]

FINE, INFINITE, NO_ROTATION = 0, 1, 2
"""What can be said of a pose."""


@compiled
def take_pose(p: Array, R: Array, V: Array, A: Array, out: Array) -> int:
    """Write a pose, unless it is unusable.

    Args:
        p: (3,) position [m].
        R: (3, 3) orientation.
        V: (6,) twist [linear; angular], world axes.
        A: (6,) its derivative.
        out: (24,) p, its velocity and acceleration, R, its velocity and acceleration.

    Returns:
        `FINE`, or what is wrong with it; nothing is written then.
    """
    if not (finite(p) and finite(R.reshape(9)) and finite(V) and finite(A)):
        return INFINITE
    if not _is_rotation(R):
        return NO_ROTATION
    for i in range(3):
        out[i], out[3 + i], out[6 + i] = p[i], V[i], A[i]
        out[18 + i], out[21 + i] = V[3 + i], A[3 + i]
        for j in range(3):
            out[9 + 3 * i + j] = R[i, j]
    return FINE


@inner
def _is_rotation(R: Array) -> bool:
    """Whether R R^T is the identity and no axis is mirrored."""
    for i in range(3):
        for j in range(3):
            product = R[i, 0] * R[j, 0] + R[i, 1] * R[j, 1] + R[i, 2] * R[j, 2]
            if abs(product - (1.0 if i == j else 0.0)) > ROTATION_TOLERANCE:
                return False
    turned = R[0, 0] * (R[1, 1] * R[2, 2] - R[1, 2] * R[2, 1])
    turned -= R[0, 1] * (R[1, 0] * R[2, 2] - R[1, 2] * R[2, 0])
    turned += R[0, 2] * (R[1, 0] * R[2, 1] - R[1, 1] * R[2, 0])
    return bool(turned > 0.0)
