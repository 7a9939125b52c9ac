"""A frame seen from another one, which the same robot carries or which moves by itself.

Every kernel that reads a frame F in the world can so read it in the axes of G: with
r from G to F, velocities lose what G's own motion makes of r, and the Jacobian is that
of F less that of G at the same place (J = J_1 - J_2).
"""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array
from wbc.compiled import compiled, inner
from wbc.frames import FrameState, cross_into, frame_at

__all__ = ["MOVING_SIZE", "moved", "relative"]

POSE_AND_MOTION = 24
"""A flat frame begins with p, R, V and drift; the Jacobian follows."""
MOVING_SIZE = POSE_AND_MOTION + 2
"""A frame that moves by itself: these, when it was there, and 1 if it goes on."""


@compiled
def moved(moving: Array, t: float, flat: Array) -> None:
    """Where a frame that moves by itself is at time t, as a flat frame; J is left.

    One that goes on does so with constant linear acceleration and constant angular
    velocity; any other is where it was put.

    Args:
        moving: (26,) p, R, V, drift, time of these [s], whether it goes on.
        t: time [s].
        flat: (24,) or more; its first 24 numbers are written.
    """
    for i in range(POSE_AND_MOTION):
        flat[i] = moving[i]
    if moving[25] == 0.0:
        return
    late = t - moving[24]
    for i in range(3):
        flat[i] += (moving[12 + i] + 0.5 * moving[18 + i] * late) * late
        flat[12 + i] += moving[18 + i] * late
    _turned(moving[3:12], moving[15:18], late, flat[3:12])


@inner
def _turned(R: Array, omega: Array, late: float, out: Array) -> None:
    """Out = exp(late omega) R, all by rows (Rodrigues)."""
    rate = np.sqrt(omega[0] * omega[0] + omega[1] * omega[1] + omega[2] * omega[2])
    if rate == 0.0:
        return
    x, y, z = omega[0] / rate, omega[1] / rate, omega[2] / rate
    s, c = np.sin(rate * late), np.cos(rate * late)
    for j in range(3):
        a, b, d = R[j], R[3 + j], R[6 + j]
        along = (x * a + y * b + z * d) * (1.0 - c)
        out[j] = c * a + s * (y * d - z * b) + along * x
        out[3 + j] = c * b + s * (z * a - x * d) + along * y
        out[6 + j] = c * d + s * (x * b - y * a) + along * z


@compiled
def relative(first: Array, second: Array, out: Array, scratch: Array, n: int) -> None:
    """F seen from G, in G's axes: a flat frame of its own.

    Args:
        first: F as a flat frame (24 + 6 n,).
        second: G, likewise.
        out: (24 + 6 n,) is written.
        scratch: (18,) or more.
        n: number of joints.
    """
    F, G, S = frame_at(first, n), frame_at(second, n), frame_at(out, n)
    r, swept, v = scratch[0:3], scratch[3:6], scratch[6:9]
    spin, lift, swing = scratch[9:12], scratch[12:15], scratch[15:18]
    omega = G.V[3:6]
    for i in range(3):
        r[i] = F.p[i] - G.p[i]
    cross_into(omega, r, swept)
    for i in range(3):
        v[i] = F.V[i] - G.V[i] - swept[i]
        swept[i] += 2.0 * v[i]
    cross_into(omega, swept, swing)  # centripetal and Coriolis
    cross_into(G.drift[3:6], r, lift)
    cross_into(omega, F.V[3:6], spin)
    for i in range(3):
        S.p[i] = S.V[i] = S.V[3 + i] = S.drift[i] = S.drift[3 + i] = 0.0
        for k in range(3):
            R = G.R[k, i]
            S.p[i] += R * r[k]
            S.V[i] += R * v[k]
            S.V[3 + i] += R * (F.V[3 + k] - omega[k])
            S.drift[i] += R * (F.drift[k] - G.drift[k] - lift[k] - swing[k])
            S.drift[3 + i] += R * (F.drift[3 + k] - G.drift[3 + k] - spin[k])
        for j in range(3):
            S.R[i, j] = 0.0
            for k in range(3):
                S.R[i, j] += G.R[k, i] * F.R[k, j]
    _jacobian(F, G, r, S.J)


@inner
def _jacobian(F: FrameState, G: FrameState, r: Array, J: Array) -> None:
    """J = R_G^T (J_F - J_G at F's origin)."""
    J_F, J_G, R = F.J, G.J, G.R
    for j in range(J.shape[1]):
        w0, w1, w2 = J_G[3, j], J_G[4, j], J_G[5, j]
        x = J_F[0, j] - J_G[0, j] - (w1 * r[2] - w2 * r[1])
        y = J_F[1, j] - J_G[1, j] - (w2 * r[0] - w0 * r[2])
        z = J_F[2, j] - J_G[2, j] - (w0 * r[1] - w1 * r[0])
        w0, w1, w2 = J_F[3, j] - w0, J_F[4, j] - w1, J_F[5, j] - w2
        for i in range(3):
            J[i, j] = R[0, i] * x + R[1, i] * y + R[2, i] * z
            J[3 + i, j] = R[0, i] * w0 + R[1, i] * w1 + R[2, i] * w2
