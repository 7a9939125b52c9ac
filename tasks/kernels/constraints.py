"""One kernel for all constraints between two geometric features.

The first feature is fixed in a frame F, the second in a frame G; F comes as seen from
G (`wbc.relative`), so that the second feature stands still. With a the first feature's
point and b the second's, x = a - b, the rows are in this order:

- along: n_i . x, for 0 to 3 unit vectors n_i fixed in G;
- apart: sqrt(sum of (n_i . x)^2) - distance, over the next vectors n_i, if any;
- parallel: two rows that turn an axis of F to one of G, or
- angle: one row, the angle between the two axes less a wanted one.
"""

from __future__ import annotations

import numpy as np

from tasks.kernels.rotations import in_world, turn_to
from wbc.arrays import Array
from wbc.compiled import inner
from wbc.frames import FrameState, cross_into
from wbc.rows import Rows

__all__ = ["constraint"]

SINGULAR = 1e-9
"""Below this distance [m], or sine, any direction serves as well as another."""
CLOSE = 0.01
"""Share of the wanted distance, or sine, below which the curvature no longer grows: on
the axis it is infinite, and who passes there must not be thrown about."""


@inner
def constraint(p: Array, S: FrameState, v: Array, scratch: Array, out: Rows) -> None:
    """Rows of a constraint between two features.

    Parameters (34,): number of rows along, of vectors in apart, kind of direction (0
    none, 1 parallel, 2 angle), sense (1 same, -1 opposite, 0 the nearer), distance,
    angle, a in F, b in G, three vectors n_i in G, axis of F and two directions across
    it, axis of G, and 1 if a frame moves by itself.

    Args:
        p: the parameters.
        S: F seen from G.
        v: (n,) joint velocities.
        scratch: (30,) or more.
        out: the rows.
    """
    along, apart = int(p[0]), int(p[1])
    row, motion = 0, scratch[:12]
    if along + apart > 0:
        _motion_of_point(p, S.p, S.R, S.V, S.drift, motion)
        for i in range(along):
            _along(p[12 + 3 * i : 15 + 3 * i], motion, S.J, out, row)
            row += 1
    if apart > 0:
        _apart(p, along, apart, motion, S.J, scratch[12:15], out, row)
        row += 1
    if p[2] == 1.0:
        _parallel(p, S, scratch[15:30], out, row)
    elif p[2] == 2.0:
        _angle(p, S, scratch[15:30], out, row)
    if p[33] == 0.0:
        out.rate[:] = 0.0
    else:
        _subtract(out.A, v, out.rate)


@inner
def _subtract(J: Array, v: Array, rate: Array) -> None:
    """Leave of the whole rate what changes by time alone."""
    for i in range(J.shape[0]):
        for j in range(J.shape[1]):
            rate[i] -= J[i, j] * v[j]


@inner
def _motion_of_point(
    p: Array, origin: Array, R: Array, V: Array, drift: Array, motion: Array
) -> None:
    """Of the first feature's point: arm r from F, x, velocity, acceleration drift.

    x = origin + r - b, xd = v + omega x r, xdd = a + alpha x r + omega x (omega x r).
    """
    w0, w1, w2 = V[3], V[4], V[5]
    r0 = R[0, 0] * p[6] + R[0, 1] * p[7] + R[0, 2] * p[8]
    r1 = R[1, 0] * p[6] + R[1, 1] * p[7] + R[1, 2] * p[8]
    r2 = R[2, 0] * p[6] + R[2, 1] * p[7] + R[2, 2] * p[8]
    s0, s1, s2 = w1 * r2 - w2 * r1, w2 * r0 - w0 * r2, w0 * r1 - w1 * r0
    motion[0], motion[1], motion[2] = r0, r1, r2
    motion[3] = origin[0] + r0 - p[9]
    motion[4] = origin[1] + r1 - p[10]
    motion[5] = origin[2] + r2 - p[11]
    motion[6], motion[7], motion[8] = V[0] + s0, V[1] + s1, V[2] + s2
    d3, d4, d5 = drift[3], drift[4], drift[5]
    motion[9] = drift[0] + d4 * r2 - d5 * r1 + w1 * s2 - w2 * s1
    motion[10] = drift[1] + d5 * r0 - d3 * r2 + w2 * s0 - w0 * s2
    motion[11] = drift[2] + d3 * r1 - d4 * r0 + w0 * s1 - w1 * s0


@inner
def _along(n: Array, motion: Array, J_S: Array, out: Rows, row: int) -> None:
    """N . x; its whole rate goes to out.rate."""
    n0, n1, n2 = n[0], n[1], n[2]
    r0, r1, r2 = motion[0], motion[1], motion[2]
    out.error[row] = n0 * motion[3] + n1 * motion[4] + n2 * motion[5]
    out.rate[row] = n0 * motion[6] + n1 * motion[7] + n2 * motion[8]
    out.drift[row] = n0 * motion[9] + n1 * motion[10] + n2 * motion[11]
    J = out.A[row]
    for j in range(J.size):
        J[j] = n0 * J_S[0, j] + n1 * J_S[1, j] + n2 * J_S[2, j]
    if r0 == 0.0 and r1 == 0.0 and r2 == 0.0:
        return
    m0, m1, m2 = r1 * n2 - r2 * n1, r2 * n0 - r0 * n2, r0 * n1 - r1 * n0
    for j in range(J.size):  # n . (omega x r) = omega . (r x n)
        J[j] += m0 * J_S[3, j] + m1 * J_S[4, j] + m2 * J_S[5, j]


@inner
def _apart(
    p: Array,
    first: int,
    count: int,
    motion: Array,
    J_S: Array,
    u: Array,
    out: Rows,
    row: int,
) -> None:
    """Length of x in the space of some vectors, along its direction u there.

    The drift is u . xdd + (|xd|^2 - (u . xd)^2) / length, within that space. On the
    axis itself the length has no slope, and the first vector serves as u.
    """
    length, speed = 0.0, 0.0
    u[0] = u[1] = u[2] = 0.0
    for k in range(12 + 3 * first, 12 + 3 * (first + count), 3):
        n0, n1, n2 = p[k], p[k + 1], p[k + 2]
        across = n0 * motion[3] + n1 * motion[4] + n2 * motion[5]
        rate = n0 * motion[6] + n1 * motion[7] + n2 * motion[8]
        length += across * across
        speed += rate * rate
        u[0] += across * n0
        u[1] += across * n1
        u[2] += across * n2
    length = np.sqrt(length)
    for k in range(3):
        u[k] = u[k] / length if length > SINGULAR else p[12 + 3 * first + k]
    _along(u, motion, J_S, out, row)
    out.error[row] = length - p[4]
    rate, least = out.rate[row], max(length, CLOSE * p[4])
    out.drift[row] += max(speed - rate * rate, 0.0) * length / (least * least)


@inner
def _parallel(p: Array, S: FrameState, scratch: Array, out: Rows, row: int) -> None:
    """The axis of F along that of G, on two directions across it fixed in F."""
    B, n = scratch[:9], scratch[9:12]
    in_world(p[21:30], S, B)
    cosine = B[0] * p[30] + B[1] * p[31] + B[2] * p[32]
    sense = p[3] if p[3] != 0.0 else (1.0 if cosine >= 0.0 else -1.0)
    for i in range(3):
        n[i] = sense * p[30 + i]
    turn_to(B, n, scratch[12:15], out, row)
    for i in range(2):
        u = B[3 + 3 * i : 6 + 3 * i]
        _turning(u, S.V, S.drift, S.J, out, row + i)


@inner
def _angle(p: Array, S: FrameState, scratch: Array, out: Rows, row: int) -> None:
    """The angle between two axes a and n, about u = n x a over its length.

    Where the axes are parallel, any direction across them serves as u.
    """
    B, c, change = scratch[:9], scratch[9:12], scratch[12:15]
    in_world(p[21:30], S, B)
    n = p[30:33]
    cross_into(n, B[:3], c)
    sine = np.sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2])
    cosine = n[0] * B[0] + n[1] * B[1] + n[2] * B[2]
    if sine <= SINGULAR:
        _turning(B[3:6], S.V, S.drift, S.J, out, row)
    else:
        cross_into(S.V[3:6], B[:3], change)
        cross_into(n, change, B[3:6])
        for i in range(3):
            c[i] /= sine
        _turning(c, S.V, S.drift, S.J, out, row)
        inward = c[0] * B[3] + c[1] * B[4] + c[2] * B[5]
        least = max(sine, CLOSE * np.sin(p[5]))
        for i in range(3):
            turned = (B[3 + i] - inward * c[i]) * sine / (least * least)
            out.drift[row] += turned * S.V[3 + i]
    out.error[row] = np.arctan2(sine, cosine) - p[5]


@inner
def _turning(u: Array, V: Array, drift: Array, J_S: Array, out: Rows, row: int) -> None:
    """Rate, drift and Jacobian of a row that turns about u; not the error."""
    u0, u1, u2 = u[0], u[1], u[2]
    out.rate[row] = u0 * V[3] + u1 * V[4] + u2 * V[5]
    out.drift[row] = u0 * drift[3] + u1 * drift[4] + u2 * drift[5]
    J = out.A[row]
    for j in range(J.size):
        J[j] = u0 * J_S[3, j] + u1 * J_S[4, j] + u2 * J_S[5, j]
