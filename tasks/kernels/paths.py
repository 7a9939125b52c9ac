"""A frame along a path, and the tasks that follow one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tasks.kernels.nearest import locate, write_point
from tasks.kernels.rotations import in_world, turn_to
from wbc.arrays import Array
from wbc.compiled import compiled, inner
from wbc.frames import FrameState, cross_into
from wbc.pointers import matrix
from wbc.rows import Rows

__all__ = [
    "SCRATCH",
    "along_path",
    "follow",
    "on_curve",
    "speed",
]

SCRATCH = 96
"""Numbers that the kernels of a path may write on the way, without the Jacobian's n."""


class Along(NamedTuple):
    """Motion of the path's nearest point below a frame.

    Attributes:
        s: its position along the path [m].
        rate: ds/dt [m/s].
        drift: d2s/dt2 at zero joint acceleration [m/s^2].
        J: (n,) Jacobian of s.
        point: (4, 9) the path there and three derivatives by s, columns [c, n1, n2].
    """

    s: float
    rate: float
    drift: float
    J: Array
    point: Array


@inner
def follow(table: Array, F: FrameState, scratch: Array) -> Along:
    """From c'(s) . (p - c(s)) = 0, differentiated twice."""
    n = F.J.shape[1]
    point = matrix(scratch[:36], 4, 9)
    J = scratch[SCRATCH : SCRATCH + n]
    s = locate(table, F.p, point)
    write_point(table, s, point)
    stretch, ahead, bent, change = 0.0, 0.0, 0.0, 0.0
    for i in range(3):
        stretch += point[1, i] * point[1, i] - (F.p[i] - point[0, i]) * point[2, i]
        ahead += point[1, i] * F.V[i]
    rate = ahead / stretch
    drift = 0.0
    for i in range(3):
        bent += point[2, i] * F.V[i]
        change += 2.0 * point[1, i] * point[2, i] * rate
        change -= (F.V[i] - point[1, i] * rate) * point[2, i]
        change -= (F.p[i] - point[0, i]) * point[3, i] * rate
        drift += point[1, i] * F.drift[i]
    drift = (drift + bent * rate - change * rate) / stretch
    for j in range(n):
        J[j] = 0.0
        for i in range(3):
            J[j] += point[1, i] * F.J[i, j] / stretch
    return Along(s, rate, drift, J, point)


@inner
def on_curve(table: Array, F: FrameState, scratch: Array, out: Rows) -> None:
    """e_i = n_i(s) . (p - c(s)); s moves with the robot."""
    path = follow(table, F, scratch)
    c, rate, J, J_F = path.point, path.rate, out.A, F.J
    for i in range(2):
        k = 3 + 3 * i
        error, by_s, turned, drift = 0.0, 0.0, 0.0, 0.0
        for j in range(3):
            offset = F.p[j] - c[0, j]
            error += c[0, k + j] * offset
            by_s += c[1, k + j] * offset - c[0, k + j] * c[1, j]
            turned += c[2, k + j] * offset * rate
            turned += 2.0 * c[1, k + j] * (F.V[j] - c[1, j] * rate)
            drift += c[0, k + j] * (F.drift[j] - c[2, j] * rate * rate)
        out.error[i] = error
        out.drift[i] = drift + turned * rate + by_s * path.drift
        for j in range(J.shape[1]):
            J[i, j] = by_s * path.J[j]
            for m in range(3):
                J[i, j] += c[0, k + m] * J_F[m, j]


@inner
def speed(
    p: Array, table: Array, F: FrameState, t: float, scratch: Array, out: Rows
) -> None:
    """ds/dt = v_ref(t, s). Parameters: speed, ramp, start, end."""
    path = follow(table, F, scratch)
    u = min(max((t - p[2]) / p[1], 0.0), 1.0)
    rise = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
    rise_rate = 30.0 * u * u * (1.0 - u) * (1.0 - u) / p[1]
    fall, slope = _fall(p[3] - path.s, 0.5 * np.pi / (p[0] * p[1]))
    reference = p[0] * rise * fall
    change = p[0] * (rise_rate * fall - rise * slope * path.rate)
    out.error[0] = path.rate - reference
    out.rate[0] = -reference
    out.drift[0] = path.drift - change
    J = out.A
    for j in range(J.shape[1]):
        J[0, j] = path.J[j]


@inner
def _fall(left: float, k: float) -> tuple[float, float]:
    """Share of the speed with `left` metres to go, and its slope [1/m]."""
    if k * left >= 0.5 * np.pi:
        return 1.0, 0.0
    if left > 0.0:
        return float(np.sin(k * left)), float(k * np.cos(k * left))
    return (k * left, k) if k * left > -1.0 else (-1.0, 0.0)


@inner
def along_path(
    p: Array, table: Array, F: FrameState, scratch: Array, out: Rows
) -> None:
    """An axis of F at fixed angles to a path. Parameters: triad in F, work, travel."""
    path = follow(table, F, scratch)
    d, B = scratch[36:45], scratch[45:54]
    turn, bent, alpha, omega = (
        scratch[54:57], scratch[57:60], scratch[60:63], scratch[63:66],
    )  # fmt: skip
    direction(path.point, p[9], p[10], d)
    in_world(p, F, B)
    turn_to(B, d[:3], scratch[66:69], out, 0)
    cross_into(d[:3], d[3:6], turn)
    cross_into(d[:3], d[6:9], bent)
    for i in range(3):
        omega[i] = turn[i] * path.rate
        alpha[i] = bent[i] * path.rate * path.rate + turn[i] * path.drift
    cross_into(F.V[3:6], omega, bent)
    J, J_F = out.A, F.J
    for i in range(2):
        out.drift[i] = 0.0
        for k in range(3):
            b = B[3 + 3 * i + k]
            out.drift[i] += b * (F.drift[3 + k] - alpha[k] + bent[k])
        for j in range(J.shape[1]):
            J[i, j] = 0.0
            for k in range(3):
                J[i, j] += B[3 + 3 * i + k] * (J_F[3 + k, j] - turn[k] * path.J[j])


@compiled
def direction(point: Array, work: float, travel: float, out: Array) -> None:
    """D = -cos(travel) m + sin(travel) t and two derivatives by s, into out (9,)."""
    cw, sw, ct, st = np.cos(work), np.sin(work), np.cos(travel), np.sin(travel)
    for k in range(3):
        for i in range(3):
            m = cw * point[k, 3 + i] + sw * point[k, 6 + i]
            out[3 * k + i] = -ct * m + st * point[k + 1, i]
