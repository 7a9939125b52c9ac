"""Singular directions of a block of rows, by rotating the basis that is left to it.

Reflections first leave no more directions with an image than there are rows. Then
one-sided Jacobi rotations (Hestenes 1958, sorted as by de Rijk 1989) turn pairs of
these in their plane until all images are orthogonal: they are the singular vectors
times the singular values, and directions without an image span the null space.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from wbc.arrays import Array, IntArray
from wbc.compiled import inner
from wbc.vectors import add_scaled, dot, length

__all__ = ["align", "fill", "start_from_axes"]

ORTHOGONAL = 4e-15
"""Cosine below which two images are orthogonal."""
NOTHING = 1e-16
"""Share of the block's norm below which an image is none."""
SWEEPS = 40
"""Over all pairs; about six do, because the last ones converge quadratically."""

ONE: Final = np.uintp(1)
TWO: Final = np.uintp(2)


@inner
def start_from_axes(Z: Array) -> None:
    """Z <- the identity."""
    for i in range(Z.shape[0]):
        for j in range(Z.shape[0]):
            Z[i, j] = 1.0 if i == j else 0.0


@inner
def fill(A: Array, rows: IntArray, Z: Array, B: Array, i0: int) -> None:
    """Images in these rows of A of the directions from i0 on."""
    n = Z.shape[0]
    for i in range(i0, n):
        for q in range(rows.size):
            B[i, q] = dot(A[rows[q]], Z[i], 0, n)


@inner
def align(
    Z: Array, B: Array, sigma: Array, i0: int, rows: int, scale: float, spare: Array
) -> None:
    """Turn directions i0 and later until their images are orthogonal, largest first.

    Args:
        Z: (n, n) the directions.
        B: (n, m) their images.
        sigma: (n,) norms of the images, written.
        i0: first direction that may turn.
        rows: length of the images.
        scale: norm of the block.
        spare: (2, n) numbers on the way.
    """
    n = sigma.size
    if rows < n - i0:
        for q in range(rows):
            _reflect(Z, B, i0 + q, q, rows, spare)
    i1 = min(n, i0 + rows)
    for i in range(i0, n):
        sigma[i] = length(B[i, :rows]) if i < i1 else 0.0
    for _ in range(SWEEPS):
        if not _rotate_all(Z, B, sigma, i0, i1, rows, NOTHING * scale):
            break


@inner
def _reflect(Z: Array, B: Array, i: int, q: int, rows: int, spare: Array) -> None:
    """Reflect so that of directions i and later only i has an image in row q.

    However small the others are: what stays would count against small blocks below.
    """
    n, others = Z.shape[0], 0.0
    v, mixed = spare[0], spare[1]
    v[i] = B[i, q]
    for j in range(i + 1, n):
        v[j] = B[j, q]
        others += v[j] * v[j]
    if others == 0.0:
        return
    square = v[i] * v[i] + others
    alpha = -np.sqrt(square) if v[i] > 0.0 else np.sqrt(square)
    beta = 1.0 / (square - alpha * v[i])
    v[i] -= alpha
    _mix(B, v, mixed, i, beta, rows)
    _mix(Z, v, mixed, i, beta, n)


@inner
def _mix(X: Array, v: Array, mixed: Array, i: int, beta: float, size: int) -> None:
    """X[i:] <- (I - beta v v^T) X[i:], in the first columns."""
    mixed[:size] = 0.0
    for j in range(i, X.shape[0]):
        add_scaled(v[j], X[j], mixed, 0, size)
    for j in range(i, X.shape[0]):
        add_scaled(-beta * v[j], mixed, X[j], 0, size)


@inner
def _rotate_all(
    Z: Array, B: Array, sigma: Array, i0: int, i1: int, rows: int, nothing: float
) -> bool:
    """Turn all pairs once; whether any was not orthogonal."""
    turned = False
    for i in range(i0, i1 - 1):
        _bring_largest(Z, B, sigma, i, i1, rows)
        for j in range(i + 1, i1):
            if min(sigma[i], sigma[j]) <= nothing:
                continue
            common = dot(B[i], B[j], 0, rows)
            if abs(common) > ORTHOGONAL * sigma[i] * sigma[j]:
                difference = (sigma[j] + sigma[i]) * (sigma[j] - sigma[i])
                zeta = difference / (2.0 * common)
                t = 1.0 / (abs(zeta) + np.sqrt(1.0 + zeta * zeta))
                t = -t if zeta < 0.0 else t
                c = 1.0 / np.sqrt(1.0 + t * t)
                _rotate(B[i], B[j], c, c * t, rows)
                _rotate(Z[i], Z[j], c, c * t, Z.shape[0])
                sigma[i], sigma[j] = length(B[i, :rows]), length(B[j, :rows])
                turned = True
    return turned


@inner
def _rotate(a: Array, b: Array, c: float, s: float, n: int) -> None:
    """A, b <- c a - s b, s a + c b over the first n numbers, two at a time."""
    k, end = np.uintp(0), np.uintp(n)
    while k + TWO <= end:
        x0, x1, y0, y1 = a[k], a[k + ONE], b[k], b[k + ONE]
        a[k], a[k + ONE] = c * x0 - s * y0, c * x1 - s * y1
        b[k], b[k + ONE] = s * x0 + c * y0, s * x1 + c * y1
        k += TWO
    if k < end:
        x, y = a[k], b[k]
        a[k], b[k] = c * x - s * y, s * x + c * y


@inner
def _bring_largest(
    Z: Array, B: Array, sigma: Array, i: int, i1: int, rows: int
) -> None:
    """Let i be the direction with the largest image of those up to i1."""
    largest = i
    for j in range(i + 1, i1):
        if sigma[j] > sigma[largest]:
            largest = j
    if largest > i:
        _exchange(Z[i], Z[largest], Z.shape[0])
        _exchange(B[i], B[largest], rows)
        sigma[i], sigma[largest] = sigma[largest], sigma[i]


@inner
def _exchange(a: Array, b: Array, n: int) -> None:
    for k in range(np.uintp(n)):
        a[k], b[k] = b[k], a[k]
