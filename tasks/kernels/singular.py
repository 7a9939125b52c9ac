"""Joint directions that a task loses, and how strongly they are damped."""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array
from wbc.compiled import compiled
from wbc.pointers import matrix
from wbc.projection.basis import align, start_from_axes
from wbc.rows import Rows
from wbc.vectors import dot

__all__ = ["damp_lost", "work_size"]


def work_size(m: int, n: int) -> int:
    """Numbers on the way of `damp_lost`, for m rows and n joints."""
    return n + n * m + 2 * max(m, n)


@compiled
def damp_lost(
    J: Array,
    v: Array,
    threshold: float,
    factor: float,
    bend: float,
    damping: float,
    error: float,
    work: Array,
    out: Rows,
) -> None:
    """One row a direction, strongest first: l_i v_i^T vdot = -l_i kd v_i^T v.

    Args:
        J: (m, n) the task's Jacobian.
        v: (n,) velocities.
        threshold: singular value below which damping sets in, relative to |J|.
        factor: damping at zero error, on the same scale.
        bend: how much of it comes with the error.
        damping: kd [1/s].
        error: size of the task's error.
        work: (`work_size`,) numbers on the way.
        out: the rows.
    """
    m, n = J.shape
    Z, sigma, width, square = out.A, work[:n], max(m, n), 0.0
    B, spare = matrix(work[n:], n, m), matrix(work[n + n * m :], 2, width)
    for i in range(n):
        for q in range(m):
            B[i, q] = J[q, i]
            square += J[q, i] * J[q, i]
    size = np.sqrt(square)
    start_from_axes(Z)
    align(Z, B, sigma, 0, m, size, spare)
    size = size if size != 0.0 else 1.0
    weakest = sigma[min(m, n) - 1]
    strength = factor * factor * size * size + bend * size * error
    for i in range(n):
        share = max(sigma[i], weakest) / (threshold * size)
        gain = np.sqrt(strength * max(1.0 - share * share, 0.0))
        for j in range(n):
            Z[i, j] *= gain
        out.error[i] = out.rate[i] = dot(Z[i], v, 0, n)
        out.drift[i] = 0.0
        out.lower[i] = out.upper[i] = -damping * out.rate[i]
