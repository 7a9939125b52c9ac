"""A moving target as numbers that kernels read, checked on the way."""

from __future__ import annotations

from wbc.arrays import ROTATION_TOLERANCE, Array
from wbc.compiled import compiled, inner
from wbc.vectors import finite

__all__ = ["take"]


@compiled
def take(p: Array, R: Array, V: Array, A: Array, out: Array) -> bool:
    """Write a target, unless it is unusable; whether it was written.

    Args:
        p: (3,) position [m].
        R: (3, 3) orientation.
        V: (3,) velocity, linear or angular, or (6,) twist [linear; angular].
        A: its derivative.
        out: (9,) p, its velocity and acceleration; (15,) R, its velocity and
            acceleration; or (24,) one after the other.
    """
    if not (finite(p) and finite(R.reshape(9)) and finite(V) and finite(A)):
        return False
    if not _is_rotation(R):
        return False
    if out.size != 15:
        for i in range(3):
            out[i], out[3 + i], out[6 + i] = p[i], V[i], A[i]
    if out.size != 9:
        _take_rotation(R, V[V.size - 3 :], A[A.size - 3 :], out[out.size - 15 :])
    return True


@inner
def _take_rotation(R: Array, omega: Array, alpha: Array, out: Array) -> None:
    for i in range(3):
        for j in range(3):
            out[3 * i + j] = R[i, j]
        out[9 + i], out[12 + i] = omega[i], alpha[i]


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
