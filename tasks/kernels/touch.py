"""A frame's twist, Jacobian and drift in the axes of a task on forces."""

from __future__ import annotations

from wbc.arrays import Array
from wbc.compiled import compiled

__all__ = ["in_axes"]


@compiled
def in_axes(
    R: Array, J: Array, V: Array, drift: Array, A: Array, rate: Array, bent: Array
) -> None:
    """Rows of blockdiag(R, R)^T times each, as many as A has: 3 or 6.

    Args:
        R: (3, 3) R_WD of the axes D.
        J: (6, n) Jacobian of the frame.
        V: (6,) its twist.
        drift: (6,) its acceleration at zero joint acceleration.
        A: (m, n) J in D is written.
        rate: (m,) V in D is written.
        bent: (m,) the drift in D is written.
    """
    for row in range(A.shape[0]):
        begin, i = row - row % 3, row % 3
        A[row] = 0.0
        rate[row] = bent[row] = 0.0
        for j in range(3):
            share = R[j, i]
            rate[row] += share * V[begin + j]
            bent[row] += share * drift[begin + j]
            for c in range(A.shape[1]):
                A[row, c] += share * J[begin + j, c]
