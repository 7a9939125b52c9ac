"""A point of the robot on a point, a line, a plane."""

from __future__ import annotations

from wbc.arrays import Array
from wbc.compiled import inner
from wbc.frames import FrameState
from wbc.rows import Rows

__all__ = ["on_line", "on_plane", "on_point"]


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


@inner
def on_line(p: Array, F: FrameState, out: Rows) -> None:
    """e_i = n_i . (p_WF - p_0). Parameters: p_0, n_1, n_2."""
    across(p, p[3:6], F, out, 0)
    across(p, p[6:9], F, out, 1)


@inner
def on_plane(p: Array, F: FrameState, out: Rows) -> None:
    """E = n . (p_WF - p_0). Parameters: p_0, n."""
    across(p, p[3:6], F, out, 0)


@inner
def across(p: Array, n: Array, F: FrameState, out: Rows, i: int) -> None:
    """Row i: distance of F's origin from p_0 = p[:3] along a fixed direction n."""
    J, J_F = out.A, F.J
    out.error[i] = (
        n[0] * (F.p[0] - p[0]) + n[1] * (F.p[1] - p[1]) + n[2] * (F.p[2] - p[2])
    )
    out.drift[i] = n[0] * F.drift[0] + n[1] * F.drift[1] + n[2] * F.drift[2]
    for j in range(J.shape[1]):
        J[i, j] = n[0] * J_F[0, j] + n[1] * J_F[1, j] + n[2] * J_F[2, j]
