"""The recursion of a projection law over its blocks: held bounds, then equalities."""

from __future__ import annotations

import numpy as np

from wbc.arrays import IntArray
from wbc.compiled import inner
from wbc.linalg import RANK_TOLERANCE
from wbc.projection.basis import align, fill, start_from_axes
from wbc.projection.work import Work
from wbc.vectors import add_scaled, dot

__all__ = ["norm", "project", "target"]


@inner
def project(w: Work) -> None:
    """Resolve all blocks from the top, with the bounds that are held."""
    start_from_axes(w.Z)
    w.y[:] = 0.0
    w.blocks[0] = w.block[0] = w.first[0] = 0
    for k in range(w.ranks.size):
        before = w.first[w.blocks[0]]
        _resolve(w, k, True)
        _resolve(w, k, False)
        w.ranks[k] = w.first[w.blocks[0]] - before


@inner
def target(w: Work, row: int) -> float:
    """Where a row of a block should be."""
    return float(w.upper[row] if w.side[row] > 0 else w.lower[row])


@inner
def _resolve(w: Work, k: int, held: bool) -> None:
    """Resolve one block of a level.

    A direction counts if its image has more than `RANK_TOLERANCE` of the norm of the
    block *before* projection. Bounds are met exactly, whatever the law.
    """
    c = w.blocks[0]
    begin, taken = w.block[c], w.first[c]
    end = _list(w, k, held, begin)
    if end == begin:
        return
    rows = w.order[begin:end]
    scale = norm(w, rows)
    fill(w.A, rows, w.Z, w.B, taken)
    align(w.Z, w.B, w.sigma, taken, rows.size, scale, w.spare)
    behind = taken
    while behind < w.sigma.size and w.sigma[behind] > RANK_TOLERANCE * scale:
        behind += 1
    for q in range(rows.size):
        w.missing[q] = target(w, rows[q])
    if w.alone[0] and not held:
        _add_alone(w, rows, taken, scale)
    else:
        _add(w, rows, taken, behind, scale, 0.0 if held else w.damping[1])
    w.blocks[0], w.block[c + 1], w.first[c + 1] = c + 1, end, behind


@inner
def _list(w: Work, k: int, held: bool, begin: int) -> int:
    """List the rows of a block in `order`; index behind them."""
    end = begin
    for r in range(w.start[k], w.start[k + 1]):
        equal = w.lower[r] == w.upper[r]
        bounding = w.bounding[w.task[r]] != 0
        if (w.side[r] != 0 or (equal and bounding)) if held else equal and not bounding:
            w.order[end] = r
            end += 1
    return end


@inner
def norm(w: Work, rows: IntArray) -> float:
    """Frobenius norm of some rows; 1 for rows of zeros, so that it can divide."""
    square = 0.0
    for r in rows:
        square += dot(w.A[r], w.A[r], 0, w.y.size)
    return float(np.sqrt(square)) if square > 0.0 else 1.0


@inner
def _add(
    w: Work,
    rows: IntArray,
    taken: int,
    behind: int,
    scale: float,
    factor: float,
) -> None:
    """Y <- y + Z (J Z)^+ (b - J y), the inverse damped by up to `factor`."""
    y, n = w.y, w.y.size
    for q in range(rows.size):
        w.missing[q] -= dot(w.A[rows[q]], y, 0, n)
    for j in range(n):
        w.way[j] = w.rest[j] - y[j]
    for i in range(taken, behind):
        wanted = dot(w.B[i], w.missing, 0, rows.size)
        calm = dot(w.Z[i], w.way, 0, n)
        step = _step(wanted, calm, w.sigma[i], scale, w.damping[0], factor)
        add_scaled(step, w.Z[i], y, 0, n)


@inner
def _add_alone(w: Work, rows: IntArray, taken: int, scale: float) -> None:
    """Y <- y + Z Z^T J^+ b, likewise."""
    n = w.y.size
    start_from_axes(w.V)
    fill(w.A, rows, w.V, w.C, 0)
    align(w.V, w.C, w.gain, 0, rows.size, scale, w.spare)
    w.way[:] = 0.0
    for i in range(n):
        if w.gain[i] > RANK_TOLERANCE * scale:
            wanted, calm = (
                dot(w.C[i], w.missing, 0, rows.size),
                dot(w.V[i], w.rest, 0, n),
            )
            step = _step(wanted, calm, w.gain[i], scale, w.damping[0], w.damping[1])
            add_scaled(step, w.V[i], w.way, 0, n)
    for i in range(taken, n):
        add_scaled(dot(w.Z[i], w.way, 0, n), w.Z[i], w.y, 0, n)


@inner
def _step(
    wanted: float,
    calm: float,
    sigma: float,
    scale: float,
    threshold: float,
    factor: float,
) -> float:
    """How far to go along a singular direction z.

    The minimiser of |sigma x - u^T b|^2 + lambda^2 |x - calm|^2, with lambda^2 =
    (1 - (s / threshold)^2) factor^2 at singular values s below the threshold, relative
    to the norm of the block, and 0 above it (Wampler and Leifer 1988).

    Args:
        wanted: sigma u^T b, the image of z times what is missing.
        calm: what x would be if all motion were to die out.
        sigma: the singular value.
        scale: norm of the block.
        threshold: as above.
        factor: as above; 0 for the plain inverse.
    """
    s = sigma / scale
    square = max(1.0 - (s / threshold) ** 2, 0.0) * factor * factor
    return (wanted / (scale * scale) + square * calm) / (s * s + square)
