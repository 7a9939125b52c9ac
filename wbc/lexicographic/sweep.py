"""One rank-revealing orthogonal sweep: the hierarchy of equalities of a working set.

For each level the working rows are brought into the coordinates that the levels above
left, and reduced to lower triangular form by reflections of the columns, the row with
the largest rest as pivot. Where the rows are independent they are met exactly by
forward substitution; otherwise the level is a small least-squares problem. Where few
coordinates are left to many rows, as to a posture, these columns are made instead.
"""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array, IntArray
from wbc.compiled import inner
from wbc.lexicographic.work import Work
from wbc.vectors import (
    add_scaled,
    copy,
    dot,
    fours,
    reflect,
    reflect_back,
)

__all__ = ["factorise", "few_left", "resolve", "sweep", "take_point", "working_rows"]

CANCELLED = 1e-4
"""A square that differences have brought down to this share is summed afresh."""
FEW = 4
"""Columns are made where there are so many times more rows."""


@inner
def sweep(w: Work, k0: int, k1: int) -> int:
    """Resolve levels k0..k1-1 of the working set; those before k0 must be resolved.

    A level's direction counts if it keeps more than the tolerance of the norm of its
    level.

    Returns:
        how many coordinates the levels so far have taken.
    """
    taken = w.first[k0]
    for k in range(k0, k1):
        w.count[k] = working_rows(w, k)
        rows = w.order[w.start[k] : w.start[k] + w.count[k]]
        rank = resolve(w, rows, taken, w.tolerance[0] * w.scale[k])
        if few_left(w, rows.size, taken):
            _complete(w, rows[:rank], taken)
        taken += rank
        w.first[k + 1] = taken
    return int(taken)


@inner
def working_rows(w: Work, k: int) -> int:
    """List the level's rows of the working set in `order`; how many there are."""
    side, size, slack, order = w.side, w.size, w.slack, w.order
    begin, count = w.start[k], 0
    for r in range(begin, w.start[k + 1]):
        slack[r] = 0.0
        if side[r] != 0 and size[r] > 0.0:
            order[begin + count] = r
            count += 1
    return count


@inner
def take_point(w: Work, x: Array, taken: int) -> None:
    """X <- the point of the coordinates taken, of least norm in the others."""
    for j in range(x.size):
        x[j] = w.c[j] if j < taken else 0.0
    reflect_back(x, w.V, w.beta, taken)


@inner
def resolve(
    w: Work,
    rows: IntArray,
    taken: int,
    lost: float,
) -> int:
    """Meet the rows as well as they can be in the coordinates not taken yet.

    Reorders the rows, pivots first. A row that keeps no more than `lost` in those
    coordinates has no direction of its own.

    Returns:
        how many coordinates they take.
    """
    W, c, slack, rest, side = w.W, w.c, w.slack, w.rest, w.side
    lower, upper = w.lower, w.upper
    if few_left(w, rows.size, taken):
        _make_columns(w, rows, taken)
    else:
        _reflect_rows(w, rows, taken)
    for r in rows:
        slack[r] += upper[r] if side[r] == 1 else lower[r]
        rest[r] = dot(W[r], W[r], taken, c.size)
    rank = _triangular(W, w.V, w.beta, rest, w.size, rows, taken, lost * lost)
    if 0 < rank < rows.size:
        _least_squares(W, c, slack, w.factor, rows, taken, rank)
    elif rank > 0:
        _substitute(W, c, slack, rows, taken)
    return rank


@inner
def few_left(w: Work, rows: int, taken: int) -> bool:
    """Whether only the columns not taken yet are made of so many rows."""
    return bool(taken > 0 and FEW * (w.c.size - taken) < rows)


@inner
def _reflect_rows(w: Work, rows: IntArray, taken: int) -> None:
    """W <- A Q, and minus what the coordinates taken make of the rows into `slack`."""
    A, W, V, beta, slack, c = w.A, w.W, w.V, w.beta, w.slack, w.c
    n = c.size
    for r in rows:
        copy(A[r], W[r])
    for i in range(taken):
        j = fours(i)
        for r in rows:
            add_scaled(-beta[i] * dot(W[r], V[i], j, n), V[i], W[r], j, n)
    for r in rows:
        slack[r] = -dot(W[r], c, 0, taken)


@inner
def _make_columns(w: Work, rows: IntArray, taken: int) -> None:
    """The same, but of A Q only the columns that are not taken."""
    A, W, V, beta, column = w.A, w.W, w.V, w.beta, w.pull
    n = column.size
    take_point(w, column, taken)
    for r in rows:
        w.slack[r] = -dot(A[r], column, 0, n)
    for j in range(taken, n):
        for i in range(n):
            column[i] = 1.0 if i == j else 0.0
        reflect_back(column, V, beta, taken)
        for r in rows:
            W[r, j] = dot(A[r], column, 0, n)


@inner
def _complete(w: Work, pivots: IntArray, taken: int) -> None:
    """The other columns of A Q, for the rows that multipliers are made of."""
    A, W, V, beta, row = w.A, w.W, w.V, w.beta, w.pull
    for r in pivots:
        copy(A[r], row)
        reflect(row, V, beta, taken)
        copy(row[:taken], W[r])


@inner
def _triangular(
    W: Array,
    V: Array,
    beta: Array,
    rest: Array,
    size: Array,
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
        _eliminate(W, V[taken + rank], beta, rest, size, rows[rank:], taken + rank)
    return int(most)


@inner
def _eliminate(
    W: Array, v: Array, beta: Array, rest: Array, size: Array, rows: IntArray, i: int
) -> None:
    """Reflect so that the first row ends at coordinate i; apply it to the others."""
    n, pivot = v.size, W[rows[0]]
    end = np.sqrt(dot(pivot, pivot, i, n))
    if pivot[i] > 0.0:
        end = -end
    for j in range(i, n):
        v[j] = pivot[j]
        pivot[j] = 0.0
    v[i] -= end
    pivot[i] = end
    beta[i] = -1.0 / (end * v[i])
    j = fours(i)
    for r in rows[1:]:
        row = W[r]
        add_scaled(-beta[i] * dot(row, v, j, n), v, row, j, n)
        left = rest[r] - row[i] * row[i]
        if left < CANCELLED * max(rest[r], size[r] * size[r]):
            left = dot(row, row, i + 1, n)
        rest[r] = left


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
    R: Array,
    rows: IntArray,
    taken: int,
    rank: int,
) -> None:
    """Meet the level's rows as far as they agree."""
    factorise(W, slack, R, rows, taken, rank)
    y = c[taken : taken + rank]
    copy(R[rank, :rank], y)
    for j in range(rank - 1, -1, -1):
        y[j] *= R[j, j]
        add_scaled(-y[j], R[j], y, 0, j)
    for r in rows:
        slack[r] -= dot(W[r], c, taken, taken + rank)


@inner
def factorise(
    W: Array, slack: Array, R: Array, rows: IntArray, taken: int, rank: int
) -> None:
    """Householder's QR of the level's factor and its slack.

    R holds columns as rows, and of its diagonal the reciprocals: it is solved with many
    times, and a division takes as long as four multiplications in a row.
    """
    count = rows.size
    for q in range(count):
        for j in range(rank):
            R[j, q] = W[rows[q], taken + j]
        R[rank, q] = slack[rows[q]]
    for j in range(rank):
        v = R[j]
        end = np.sqrt(dot(v, v, j, count))
        if v[j] > 0.0:
            end = -end
        v[j] -= end
        beta = -1.0 / (end * v[j])
        for i in range(j + 1, rank + 1):
            add_scaled(-beta * dot(R[i], v, j, count), v, R[i], j, count)
        v[j] = 1.0 / end
