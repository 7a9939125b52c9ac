"""One rank-revealing orthogonal sweep: the hierarchy of equalities of a working set.

For each level the working rows are brought into the coordinates that the levels above
left, and reduced to lower triangular form by reflections of the columns, the row with
the largest rest as pivot. Where the rows are independent they are met exactly by
forward substitution; otherwise the level is a small least-squares problem.
"""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array, IntArray
from wbc.compiled import inner
from wbc.lexicographic.vectors import add_scaled, dot, reflect
from wbc.lexicographic.work import Work

__all__ = ["sweep"]


@inner
def sweep(
    A: Array, lower: Array, upper: Array, w: Work, tolerance: float, k0: int, k1: int
) -> int:
    """Resolve levels k0..k1-1 of the working set; those before k0 must be resolved.

    A level's direction counts if it keeps more than `tolerance` of the norm of the
    level's rows.

    Returns:
        how many coordinates the levels so far have taken.
    """
    start, side, order, first, size = w.start, w.side, w.order, w.first, w.size
    W, V, beta, c = w.W, w.V, w.beta, w.c
    slack, bound, rest = w.slack, w.bound, w.rest
    taken = first[k0]
    for k in range(k0, k1):
        begin, count, scale = start[k], 0, 0.0
        for r in range(begin, start[k + 1]):
            slack[r] = 0.0
            if side[r] != 0:
                order[begin + count] = r
                count += 1
                scale += size[r] * size[r]
                W[r] = A[r]
                reflect(W[r], V, beta, taken)
                bound[r] = upper[r] if side[r] == 1 else lower[r]
                slack[r] = bound[r] - dot(W[r], c, 0, taken)
                rest[r] = dot(W[r], W[r], taken, c.size)
        rows = order[begin : begin + count]
        threshold = tolerance * tolerance * scale
        rank = _triangular(W, V, beta, rest, rows, taken, threshold)
        if rank == count:
            _substitute(W, c, slack, rows, taken)
        elif rank > 0:
            _least_squares(W, c, slack, w.square, rows, taken, rank)
        w.count[k] = count
        taken += rank
        first[k + 1] = taken
    return int(taken)


@inner
def _triangular(
    W: Array,
    V: Array,
    beta: Array,
    rest: Array,
    rows: IntArray,
    taken: int,
    threshold: float,
) -> int:
    """Reduce the rows to lower triangular form, pivots first; how many pivots."""
    most = min(rows.size, V.shape[0] - taken)
    for rank in range(most):
        best = rank
        for i in range(rank + 1, rows.size):
            if rest[rows[i]] > rest[rows[best]]:
                best = i
        pivot = rows[best]
        if rest[pivot] <= threshold:
            return rank
        rows[best], rows[rank] = rows[rank], pivot
        _eliminate(W, V[taken + rank], beta, rest, rows, rank, taken + rank)
    return int(most)


@inner
def _eliminate(
    W: Array, v: Array, beta: Array, rest: Array, rows: IntArray, rank: int, i: int
) -> None:
    """Reflect so that the pivot row ends at coordinate i; apply it to those after."""
    n, row = v.size, W[rows[rank]]
    length = np.sqrt(dot(row, row, i, n))
    if row[i] > 0.0:
        length = -length
    for j in range(i, n):
        v[j] = row[j]
        row[j] = 0.0
    v[i] -= length
    row[i] = length
    beta[i] = -1.0 / (length * v[i])
    for q in range(rank + 1, rows.size):
        other = W[rows[q]]
        add_scaled(-beta[i] * dot(other, v, i, n), v, other, i, n)
        rest[rows[q]] = dot(other, other, i + 1, n)


@inner
def _substitute(W: Array, c: Array, slack: Array, rows: IntArray, taken: int) -> None:
    """Meet all rows of the level exactly."""
    for i in range(rows.size):
        r = rows[i]
        done = dot(W[r], c, taken, taken + i)
        c[taken + i] = (slack[r] - done) / W[r, taken + i]
        slack[r] = 0.0


@inner
def _least_squares(
    W: Array,
    c: Array,
    slack: Array,
    L: Array,
    rows: IntArray,
    taken: int,
    rank: int,
) -> None:
    """Meet the level's rows as far as they agree, by Householder's QR of the factor."""
    count = rows.size
    for q in range(count):
        for j in range(rank):
            L[q, j] = W[rows[q], taken + j]
        L[q, rank] = slack[rows[q]]
    for j in range(rank):
        _column(L, j, count, rank)
    for j in range(rank - 1, -1, -1):
        left = L[j, rank]
        for i in range(j + 1, rank):
            left -= L[j, i] * c[taken + i]
        c[taken + j] = left / L[j, j]
    for q in range(count):
        slack[rows[q]] -= dot(W[rows[q]], c, taken, taken + rank)


@inner
def _column(L: Array, j: int, count: int, rank: int) -> None:
    """One column of the QR, applied to the columns right of it."""
    square = 0.0
    for q in range(j, count):
        square += L[q, j] * L[q, j]
    length = -np.sqrt(square) if L[j, j] > 0.0 else np.sqrt(square)
    L[j, j] -= length
    beta = -1.0 / (length * L[j, j])
    for i in range(j + 1, rank + 1):
        along = 0.0
        for q in range(j, count):
            along += L[q, j] * L[q, i]
        along *= beta
        for q in range(j, count):
            L[q, i] -= along * L[q, j]
    L[j, j] = length
