"""Mobility J M^-1 J^T of some rows, as B B^T, and its inverse where it has one."""

from __future__ import annotations

from typing import Final

import numpy as np

from wbc.arrays import Array
from wbc.compiled import inner
from wbc.projection.basis import align, start_from_axes
from wbc.vectors import add_scaled, dot

__all__ = ["least_squares"]

NOTHING: Final = 1e-9
"""Share of the largest eigenvalue below which one counts as zero."""


@inner
def least_squares(
    B: Array, b: Array, x: Array, Z: Array, sigma: Array, spare: Array
) -> None:
    """Least-squares solution of least norm of B B^T x = b.

    Args:
        B: (m, n); is turned.
        b: (m,).
        x: (m,) is written.
        Z: (m, m) eigenvectors are written, one a row.
        sigma: (m,) square roots of the eigenvalues are written.
        spare: (2, max(m, n)) numbers on the way.
    """
    m, n = B.shape
    size = 0.0
    for k in range(m):
        size += dot(B[k], B[k], 0, n)
        x[k] = 0.0
    start_from_axes(Z)
    align(Z, B, sigma, 0, n, np.sqrt(size), spare)
    for i in range(m):
        square = sigma[i] * sigma[i]
        if square > NOTHING * sigma[0] * sigma[0]:
            add_scaled(dot(Z[i], b, 0, m) / square, Z[i], x, 0, m)
