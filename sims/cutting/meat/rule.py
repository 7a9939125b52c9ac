"""Which links a knife cuts: P0 section II-C as corrected, for a knife that moves."""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array, IntArray
from wbc.compiled import compiled, inner

__all__ = ["cut", "segment_distance"]


def cut(before: Array, after: Array, a1: Array, a2: Array, width: float) -> IntArray:
    """Indices of the links that the knife's tip cuts on its way between two instants.

    A link a1 a2 is cut where, somewhere on the way, the tip is below it,
    z_c <= min(z1, z2) (P0 eq. 3), and its distance from the segment a1 a2 in the xy
    plane is at most `width`. That distance replaces P0 eqs. 4 to 6, whose box has no
    width for mated ends and whose line test lacks y_c and a unit. Testing the way, not
    the end of it, keeps a fast knife from jumping over links.

    Args:
        before: (3,) where the tip was [m].
        after: (3,) where it is [m].
        a1: (N, 3) one end of the links [m].
        a2: (N, 3) the other end [m].
        width: d of P0 eq. 6 [m].
    """
    found = np.empty(a1.shape[0], dtype=np.int_)
    return found[: _find_cut(before, after, a1, a2, width, found)]


@compiled
def _find_cut(
    before: Array, after: Array, a1: Array, a2: Array, width: float, found: IntArray
) -> int:
    """Write the indices to `found` (N,); how many there are."""
    count = 0
    low = min(before[2], after[2])
    rise = after[2] - before[2]
    for i in range(a1.shape[0]):
        height = min(a1[i, 2], a2[i, 2])
        if height < low:
            continue
        # shares of the way between which the tip is at or below the link
        first, last = 0.0, 1.0
        if rise < 0.0:
            first = max((height - before[2]) / rise, 0.0)
        elif rise > 0.0:
            last = min((height - before[2]) / rise, 1.0)
        px = before[0] + first * (after[0] - before[0])
        py = before[1] + first * (after[1] - before[1])
        qx = before[0] + last * (after[0] - before[0])
        qy = before[1] + last * (after[1] - before[1])
        distance = segment_distance(
            px, py, qx, qy, a1[i, 0], a1[i, 1], a2[i, 0], a2[i, 1]
        )
        if distance <= width:
            found[count] = i
            count += 1
    return count


@compiled
def segment_distance(
    px: float, py: float, qx: float, qy: float,
    ax: float, ay: float, bx: float, by: float,
) -> float:  # fmt: skip
    """Distance between the segments p q and a b in the plane."""
    if (
        _side(px, py, qx, qy, ax, ay) * _side(px, py, qx, qy, bx, by) < 0.0
        and _side(ax, ay, bx, by, px, py) * _side(ax, ay, bx, by, qx, qy) < 0.0
    ):
        return 0.0
    return min(
        _to_segment(px, py, ax, ay, bx, by),
        _to_segment(qx, qy, ax, ay, bx, by),
        _to_segment(ax, ay, px, py, qx, qy),
        _to_segment(bx, by, px, py, qx, qy),
    )


@inner
def _to_segment(
    x: float, y: float, ax: float, ay: float, bx: float, by: float
) -> float:
    dx, dy = bx - ax, by - ay
    length2 = dx * dx + dy * dy
    t = 0.0
    if length2 > 0.0:
        t = min(max(((x - ax) * dx + (y - ay) * dy) / length2, 0.0), 1.0)
    return float(np.hypot(x - ax - t * dx, y - ay - t * dy))


@inner
def _side(ax: float, ay: float, bx: float, by: float, x: float, y: float) -> float:
    """Twice the signed area of the triangle a b x."""
    return (bx - ax) * (y - ay) - (by - ay) * (x - ax)
