"""A path's points, and which of them is nearest."""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array
from wbc.compiled import compiled, inner

__all__ = ["locate", "write_point"]

HEADER = 4
"""A table begins with kind (0 line, 1 curve), length, pieces, samples."""
NEWTON_STEPS = 6
CONVERGED = 1e-13


@compiled
def write_point(table: Array, s: float, out: Array) -> None:
    """Point and normals of a path at s, with three derivatives, into out (4, 9)."""
    if table[0] == 0.0:
        out[:] = 0.0
        for i in range(3):
            out[0, i] = table[HEADER + i] + s * table[HEADER + 3 + i]
            out[1, i] = table[HEADER + 3 + i]
            out[0, 3 + i] = table[HEADER + 6 + i]
            out[0, 6 + i] = table[HEADER + 9 + i]
        return
    pieces = int(table[2])
    inside = min(max(s, 0.0), table[1])
    i = _piece(table, pieces, inside)
    x = inside - table[HEADER + i]
    begin = HEADER + pieces + 54 * i
    for column in range(9):
        _taylor(table[begin + column : begin + 54 : 9], x, out[:, column])
    if inside != s:
        for j in range(9):
            if j < 3:
                out[0, j] += (s - inside) * out[1, j]
            else:
                out[1, j] = 0.0
            out[2, j] = out[3, j] = 0.0


@inner
def _taylor(a: Array, x: float, out: Array) -> None:
    """A quintic, highest power first, and three derivatives (Horner)."""
    value, first, second, third = a[0], 0.0, 0.0, 0.0
    for i in range(1, 6):
        third = third * x + second
        second = second * x + first
        first = first * x + value
        value = value * x + a[i]
    out[0], out[1], out[2], out[3] = value, first, 2.0 * second, 6.0 * third


@compiled
def locate(table: Array, p: Array, point: Array) -> float:
    """Position of the path's point nearest to p (3,); `point` (4, 9) is overwritten."""
    if table[0] == 0.0:
        s = 0.0
        for i in range(3):
            s += table[HEADER + 3 + i] * (p[i] - table[HEADER + i])
        return s
    s = _nearest_sample(table, p)
    for _ in range(NEWTON_STEPS):
        write_point(table, s, point)
        along, slope = 0.0, 0.0
        for i in range(3):
            offset = p[i] - point[0, i]
            along += point[1, i] * offset
            slope += point[1, i] * point[1, i] - offset * point[2, i]
        step = along / max(slope, 0.1)
        s += step
        if abs(step) < CONVERGED:
            break
    return s


@inner
def _piece(table: Array, pieces: int, s: float) -> int:
    """Number of the last piece that begins at or before s; by halves."""
    first, end = 0, pieces
    while end - first > 1:
        middle = (first + end) // 2
        if table[HEADER + middle] <= s:
            first = middle
        else:
            end = middle
    return first


@inner
def _nearest_sample(table: Array, p: Array) -> float:
    pieces, count = int(table[2]), int(table[3])
    samples = table[HEADER + 55 * pieces : HEADER + 55 * pieces + 3 * count]
    best, nearest = np.inf, 0
    for i in range(count):
        x, y, z = (
            p[0] - samples[3 * i],
            p[1] - samples[3 * i + 1],
            p[2] - samples[3 * i + 2],
        )
        square = x * x + y * y + z * z
        if square < best:
            best, nearest = square, i
    return table[1] * nearest / (count - 1)  # type: ignore[no-any-return]
