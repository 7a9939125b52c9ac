"""Two points that keep away from each other."""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array
from wbc.compiled import inner
from wbc.frames import FrameState
from wbc.rows import Rows

__all__ = ["clearance"]

CONTACT = 1e-9
"""Distance below which two points have no direction between them [m]."""


@inner
def clearance(p: Array, F: FrameState, out: Rows) -> None:
    """One row: cdd >= -2 a cd - a^2 c, c the distance less the one to keep.

    Distances are the same in any axes, so the second point's own will do.

    Args:
        p: (2,) distance to keep [m], rate a [1/s].
        F: the first point's frame, as seen from the second one's.
        out: the row.
    """
    x, v, J = F.p, F.V, F.J
    d = np.sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2])
    n0, n1, n2 = 0.0, 0.0, 1.0
    if d > CONTACT:
        n0, n1, n2 = x[0] / d, x[1] / d, x[2] / d
    along = n0 * v[0] + n1 * v[1] + n2 * v[2]
    square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    turning = (square - along * along) / max(d, CONTACT)
    bent = n0 * F.drift[0] + n1 * F.drift[1] + n2 * F.drift[2]
    spare, a = d - p[0], p[1]
    for j in range(J.shape[1]):
        out.A[0, j] = n0 * J[0, j] + n1 * J[1, j] + n2 * J[2, j]
    out.error[0], out.rate[0] = min(spare, 0.0), along
    out.drift[0] = bent + turning
    out.lower[0] = -2.0 * a * along - a * a * spare - out.drift[0]
    out.upper[0] = np.inf
