"""Whether triangles of a surface cross each other."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from wbc.arrays import Array, BoolArray, IntArray

__all__ = ["crossing"]

CHUNK: Final = 1_000_000
"""Pairs that are looked at in one go."""
GRAZE: Final = 1e-9
"""Share of a triangle or an edge by which an intersection must be inside it."""


def crossing(corners: Array) -> tuple[int, int] | None:
    """Two triangles of which an edge of one passes through the inside of the other.

    Triangles that lie in one plane, or touch in shared corners and edges, do not count.

    Args:
        corners: (f, 3, 3) of the triangles.

    Returns:
        Indices of the first pair found, or None.
    """
    for i, j in _neighbours(corners):
        for k in range(3):
            start, end = k, (k + 1) % 3
            for a, b in ((i, j), (j, i)):
                hit = _pierces(corners[a, start], corners[a, end], corners[b])
                if hit.any():
                    first = int(hit.argmax())
                    return int(i[first]), int(j[first])
    return None


def _neighbours(corners: Array) -> Iterator[tuple[IntArray, IntArray]]:
    """Pairs whose boxes overlap, by a sweep along x."""
    low, high = corners.min(axis=1), corners.max(axis=1)
    order = np.argsort(low[:, 0])
    last = np.searchsorted(low[order, 0], high[order, 0], side="right")
    count = np.maximum(last - np.arange(order.size) - 1, 0)
    begin = 0
    while begin < order.size:
        total = np.cumsum(count[begin:])
        end = begin + max(int(np.searchsorted(total, CHUNK, side="right")), 1)
        sizes = count[begin:end]
        first = np.repeat(np.arange(begin, end), sizes)
        within = np.arange(first.size) - np.repeat(np.cumsum(sizes) - sizes, sizes)
        i, j = order[first], order[first + 1 + within]
        overlap = ((low[i] <= high[j]) & (low[j] <= high[i])).all(axis=1)
        yield i[overlap], j[overlap]
        begin = end


def _pierces(p: Array, q: Array, triangle: Array) -> BoolArray:
    """Whether segments p q (k, 3) pass through the inside of triangles (k, 3, 3)."""
    a, ab, ac = (
        triangle[:, 0],
        triangle[:, 1] - triangle[:, 0],
        triangle[:, 2] - triangle[:, 0],
    )
    way = q - p
    normal = np.cross(ab, ac)
    slope = np.einsum("ij,ij->i", normal, way)
    size = np.linalg.norm(normal, axis=1) * np.linalg.norm(way, axis=1)
    steep = np.abs(slope) > 1e-12 * size
    safe = np.where(steep, slope, 1.0)
    t = np.einsum("ij,ij->i", normal, a - p) / safe
    beside = np.cross(a - p, way)
    u = np.einsum("ij,ij->i", ac, beside) / safe
    v = -np.einsum("ij,ij->i", ab, beside) / safe
    inside = (t > GRAZE) & (t < 1 - GRAZE) & (u > GRAZE) & (v > GRAZE)
    # from a corner of the triangle a segment leaves its plane and does not come back
    ends = np.stack([p, q], axis=1)[:, :, None]
    joined = (ends == triangle[:, None]).all(axis=3).any(axis=(1, 2))
    return np.asarray(steep & inside & (u + v < 1 - GRAZE) & ~joined)
