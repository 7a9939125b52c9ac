"""Moves of the dual method: how x answers to a force along a row.

The metric prices coordinates: those that the level determines by its factor, the free
ones at 1, the others not at all. Where none is free, the level's few columns of Q are
made once, and a move is a combination of these.
"""

from __future__ import annotations

from wbc.arrays import Array
from wbc.compiled import inner
from wbc.lexicographic.work import Dual, Work
from wbc.vectors import add_scaled, copy, dot, reflect, reflect_back

__all__ = ["along", "make_basis", "move"]


@inner
def along(w: Work, d: Dual, row: int, x: Array) -> float:
    """The row times x (n,)."""
    A, j = w.A, d.column[row]
    return float(A[row, j] * x[j]) if j >= 0 else dot(A[row], x, 0, x.size)


@inner
def move(w: Work, d: Dual, row: int, base: int, rank: int, price: float) -> None:
    """How x answers to a unit force along the row, in the metric of the level."""
    P, n = d.P[row], w.x.size
    d.known[row] = 1
    if base + rank == n:
        y = w.pull[:rank]
        for j in range(rank):
            y[j] = along(w, d, row, d.Z[base + j])
        _apply_metric(w.factor, y, price)
        P[:] = 0.0
        for j in range(rank):
            add_scaled(y[j], d.Z[base + j], P, 0, n)
        return
    copy(w.A[row], P)
    reflect(P, w.V, w.beta, base + rank)
    P[:base] = 0.0
    _apply_metric(w.factor, P[base : base + rank], price)
    reflect_back(P, w.V, w.beta, base + rank)


@inner
def make_basis(w: Work, d: Dual, base: int) -> None:
    """The last columns of Q, where the level determines all that was left."""
    V, beta, Z, n = w.V, w.beta, d.Z, w.x.size
    for j in range(base, n):
        column = Z[j]
        for i in range(n):
            column[i] = 1.0 if i == j else 0.0
        reflect_back(column, V, beta, j + 1)  # the others leave it as it is


@inner
def _apply_metric(R: Array, y: Array, price: float) -> None:
    """Y <- price (R^T R)^-1 y."""
    for j in range(y.size):
        y[j] = (y[j] - dot(R[j], y, 0, j)) * R[j, j]
    for j in range(y.size - 1, -1, -1):
        y[j] *= R[j, j]
        add_scaled(-y[j], R[j], y, 0, j)
    for j in range(y.size):
        y[j] *= price
