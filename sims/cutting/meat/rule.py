"""Which links a knife cuts: P0 section II-C as corrected, for a knife that moves."""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array, IntArray

__all__ = ["cut", "segment_distance"]


def cut(
    before: Array, after: Array, ends: tuple[Array, Array], width: float
) -> IntArray:
    """Indices of the links that the knife's tip cuts on its way between two instants.

    A link a1 a2 is cut where, somewhere on the way, the tip is below it,
    z_c <= min(z1, z2) (P0 eq. 3), and its distance from the segment a1 a2 in the xy
    plane is at most `width`. That distance replaces P0 eqs. 4 to 6, whose box has no
    width for mated ends and whose line test lacks y_c and a unit. Testing the way, not
    the end of it, keeps a fast knife from jumping over links.

    Args:
        before: (3,) where the tip was [m].
        after: (3,) where it is [m].
        ends: (N, 3), (N, 3) of the links [m].
        width: d of P0 eq. 6 [m].
    """
    a1, a2 = ends
    lowest = np.minimum(a1[:, 2], a2[:, 2])
    box_low, box_high = np.minimum(before, after), np.maximum(before, after)
    near = lowest >= box_low[2]
    for axis in (0, 1):
        near &= np.maximum(a1[:, axis], a2[:, axis]) >= box_low[axis] - width
        near &= np.minimum(a1[:, axis], a2[:, axis]) <= box_high[axis] + width
    found = np.flatnonzero(near)
    if found.size == 0:
        return found
    p, q = _below(before, after, lowest[found])
    distance = segment_distance(p, q, a1[found, :2], a2[found, :2])
    return found[distance <= width]


def _below(before: Array, after: Array, heights: Array) -> tuple[Array, Array]:
    """Ends (k, 2) of the part of the way that is at or below heights (k,)."""
    rise = after[2] - before[2]
    crossing = np.full(heights.size, 0.0 if rise <= 0.0 else 1.0)
    if rise != 0.0:
        crossing = np.clip((heights - before[2]) / rise, 0.0, 1.0)
    way = (after - before)[:2]
    first, last = (
        before[:2] + 0.0 * crossing[:, None],
        after[:2] + 0.0 * crossing[:, None],
    )
    turn = before[:2] + crossing[:, None] * way
    return (turn, last) if rise <= 0.0 else (first, turn)


def segment_distance(p: Array, q: Array, a: Array, b: Array) -> Array:
    """Distances (k,) between segments p q and a b, all ends (k, 2)."""
    ends = np.stack(
        [
            _to_segment(p, a, b),
            _to_segment(q, a, b),
            _to_segment(a, p, q),
            _to_segment(b, p, q),
        ]
    )
    apart = (_side(p, q, a) * _side(p, q, b) >= 0) | (
        _side(a, b, p) * _side(a, b, q) >= 0
    )
    return np.where(apart, ends.min(axis=0), 0.0)


def _to_segment(x: Array, a: Array, b: Array) -> Array:
    along = b - a
    length2 = np.einsum("ij,ij->i", along, along)
    t = np.einsum("ij,ij->i", x - a, along) / np.where(length2 > 0.0, length2, 1.0)
    nearest = a + np.clip(t, 0.0, 1.0)[:, None] * along
    return np.asarray(np.hypot(*(x - nearest).T))


def _side(a: Array, b: Array, x: Array) -> Array:
    """Twice the signed area of the triangles a b x."""
    return (b[:, 0] - a[:, 0]) * (x[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (
        x[:, 0] - a[:, 0]
    )
