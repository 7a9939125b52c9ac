"""Orientation of a frame, and an axis of it along a direction."""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array
from wbc.compiled import inner
from wbc.frames import FrameState, cross_into
from wbc.rows import Rows

__all__ = [
    "along",
    "in_world",
    "orientation",
    "pose",
    "rotation_between",
    "rotation_vector",
    "turn_to",
]


@inner
def orientation(p: Array, F: FrameState, scratch: Array, out: Rows, first: int) -> None:
    """E = log(R_WF R_d^T). Parameters: R_d, angular velocity and acceleration of it.

    Args:
        p: (15,) parameters.
        F: the frame.
        scratch: (12,) or more.
        out: rows `first` to `first + 2` are written.
        first: of the rows.
    """
    R, e = scratch[:9], scratch[9:12]
    for i in range(3):
        for j in range(3):
            R[3 * i + j] = 0.0
            for k in range(3):
                R[3 * i + j] += F.R[i, k] * p[3 * j + k]
    rotation_vector(R, e)
    J, J_F = out.A, F.J
    for i in range(3):
        out.error[first + i] = e[i]
        out.rate[first + i] = -p[9 + i]
        out.drift[first + i] = F.drift[3 + i] - p[12 + i]
        for j in range(J.shape[1]):
            J[first + i, j] = J_F[3 + i, j]


@inner
def rotation_vector(R: Array, out: Array) -> None:
    """Logarithm of R (9,), row by row, through the quaternion of largest component.

    Exact to round-off at every angle; at half a turn one of the two ways is taken.
    """
    trace = R[0] + R[4] + R[8]
    if trace > 0.0:
        w, x = 1.0 + trace, R[7] - R[5]
        y, z = R[2] - R[6], R[3] - R[1]
    elif R[0] >= R[4] and R[0] >= R[8]:
        w, x = R[7] - R[5], 1.0 + R[0] - R[4] - R[8]
        y, z = R[1] + R[3], R[2] + R[6]
    elif R[4] >= R[8]:
        w, x = R[2] - R[6], R[1] + R[3]
        y, z = 1.0 - R[0] + R[4] - R[8], R[5] + R[7]
    else:
        w, x = R[3] - R[1], R[2] + R[6]
        y, z = R[5] + R[7], 1.0 - R[0] - R[4] + R[8]
    if w < 0.0:
        w, x, y, z = -w, -x, -y, -z
    sine = np.sqrt(x * x + y * y + z * z)
    factor = 2.0 * np.arctan2(sine, w) / sine if sine > 0.0 else 0.0
    out[0], out[1], out[2] = factor * x, factor * y, factor * z


@inner
def pose(p: Array, F: FrameState, scratch: Array, out: Rows) -> None:
    """Position, then orientation. Parameters: those of both, one after the other."""
    J, J_F = out.A, F.J
    for i in range(3):
        out.error[i] = F.p[i] - p[i]
        out.rate[i] = -p[3 + i]
        out.drift[i] = F.drift[i] - p[6 + i]
        for j in range(J.shape[1]):
            J[i, j] = J_F[i, j]
    orientation(p[9:], F, scratch, out, 3)


@inner
def along(p: Array, F: FrameState, scratch: Array, out: Rows) -> None:
    """An axis a of F along a direction n; turning about a is free.

    Parameters: a and two directions across it, in F; n, its angular velocity and
    acceleration, in the world.
    """
    B, swept = scratch[:9], scratch[9:12]
    in_world(p, F, B)
    turn_to(B, p[9:12], scratch[12:15], out, 0)
    cross_into(F.V[3:6], p[12:15], swept)
    J, J_F = out.A, F.J
    for i in range(2):
        b = B[3 + 3 * i : 6 + 3 * i]
        out.rate[i] = -(b[0] * p[12] + b[1] * p[13] + b[2] * p[14])
        out.drift[i] = 0.0
        for k in range(3):
            out.drift[i] += b[k] * (F.drift[3 + k] - p[15 + k] + swept[k])
        for j in range(J.shape[1]):
            J[i, j] = b[0] * J_F[3, j] + b[1] * J_F[4, j] + b[2] * J_F[5, j]


@inner
def in_world(triad: Array, F: FrameState, B: Array) -> None:
    """Three directions of F (9,), one after the other, in the world's axes."""
    for k in range(3):
        for i in range(3):
            B[3 * k + i] = 0.0
            for j in range(3):
                B[3 * k + i] += F.R[i, j] * triad[3 * k + j]


@inner
def turn_to(B: Array, n: Array, e: Array, out: Rows, first: int) -> None:
    """Errors of the axis B[:3] against n on the two directions across it."""
    rotation_between(B[:3], n, B[3:6], e)
    for i in range(2):
        b = B[3 + 3 * i : 6 + 3 * i]
        out.error[first + i] = -(b[0] * e[0] + b[1] * e[1] + b[2] * e[2])


@inner
def rotation_between(a: Array, n: Array, spare: Array, out: Array) -> None:
    """Rotation vector of the shortest turn from a to n, unit vectors.

    Args:
        a: (3,) from.
        n: (3,) to.
        spare: (3,) unit vector across a, the axis where n = -a.
        out: (3,) the vector [rad].
    """
    cross_into(a, n, out)
    sine = np.sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2])
    cosine = a[0] * n[0] + a[1] * n[1] + a[2] * n[2]
    angle = np.arctan2(sine, cosine)
    for i in range(3):
        if sine > 1e-12:
            out[i] *= angle / sine
        elif cosine < 0.0:
            out[i] = spare[i] * angle
