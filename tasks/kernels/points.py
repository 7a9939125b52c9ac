"""A point of the robot at a point of the world."""

from __future__ import annotations

from wbc.arrays import Array
from wbc.compiled import inner
from wbc.frames import FrameState
from wbc.rows import Rows

__all__ = ["on_point"]


@inner
def on_point(p: Array, F: FrameState, out: Rows) -> None:
    """E = p_WF - p_d. Parameters: p_d, its velocity, its acceleration."""
    J, J_F = out.A, F.J
    for i in range(3):
        out.error[i] = F.p[i] - p[i]
        out.rate[i] = -p[3 + i]
        out.drift[i] = F.drift[i] - p[6 + i]
        for j in range(J.shape[1]):
            J[i, j] = J_F[i, j]
