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
        scratch: (33,) or more.
        out: the rows.
    """
    along, apart = int(p[0]), int(p[1])
    row = 0
    if along + apart > 0:
        _motion_of_point(p, S, scratch)
        for i in range(along):
            _along(p[12 + 3 * i : 15 + 3 * i], S, scratch, out, row)
            row += 1
    if apart > 0:
        _apart(p, along, apart, S, scratch, out, row)
        row += 1
    if p[2] == 1.0:
        _parallel(p, S, scratch[18:33], out, row)
    elif p[2] == 2.0:
        _angle(p, S, scratch[18:33], out, row)
    J = out.A
    for i in range(J.shape[0]):
        if p[33] == 0.0:
            out.rate[i] = 0.0
        for j in range(J.shape[1] if p[33] != 0.0 else 0):
            out.rate[i] -= J[i, j] * v[j]  # what changes by time alone


@inner
def _motion_of_point(p: Array, S: FrameState, scratch: Array) -> None:
    """Of the first feature's point: arm from F, x, velocity, acceleration drift."""
    r, x, velocity, drift = scratch[0:3], scratch[3:6], scratch[6:9], scratch[9:12]
    spin, lift = scratch[12:15], scratch[15:18]
    for i in range(3):
        r[i] = S.R[i, 0] * p[6] + S.R[i, 1] * p[7] + S.R[i, 2] * p[8]
    cross_into(S.V[3:6], r, spin)
    cross_into(S.drift[3:6], r, lift)
    for i in range(3):
        x[i] = S.p[i] + r[i] - p[9 + i]
        velocity[i] = S.V[i] + spin[i]
        drift[i] = S.drift[i] + lift[i]
    cross_into(S.V[3:6], spin, lift)
    for i in range(3):
        drift[i] += lift[i]


@inner
def _along(n: Array, S: FrameState, scratch: Array, out: Rows, row: int) -> None:
    """N . x; its whole rate goes to out.rate."""
    r, x, velocity, drift = scratch[0:3], scratch[3:6], scratch[6:9], scratch[9:12]
    out.error[row] = n[0] * x[0] + n[1] * x[1] + n[2] * x[2]
    out.rate[row] = n[0] * velocity[0] + n[1] * velocity[1] + n[2] * velocity[2]
    out.drift[row] = n[0] * drift[0] + n[1] * drift[1] + n[2] * drift[2]
    m0 = r[1] * n[2] - r[2] * n[1]  # n . (omega x r) = omega . (r x n)
    m1 = r[2] * n[0] - r[0] * n[2]
    m2 = r[0] * n[1] - r[1] * n[0]
    J, J_S = out.A, S.J
    for j in range(J.shape[1]):
        linear = n[0] * J_S[0, j] + n[1] * J_S[1, j] + n[2] * J_S[2, j]
        J[row, j] = linear + m0 * J_S[3, j] + m1 * J_S[4, j] + m2 * J_S[5, j]


@inner
def _apart(
    p: Array,
    first: int,
    count: int,
    S: FrameState,
    scratch: Array,
    out: Rows,
    row: int,
) -> None:
    """Length of x in the space of some vectors, along its direction u there.

    The drift is u . xdd + (|xd|^2 - (u . xd)^2) / length, within that space. On the
    axis itself the length has no slope, and the first vector serves as u.
    """
    x, velocity, u = scratch[3:6], scratch[6:9], scratch[12:15]
    length, speed = 0.0, 0.0
    for k in range(3):
        u[k] = 0.0
    for i in range(first, first + count):
        n = p[12 + 3 * i : 15 + 3 * i]
        across = n[0] * x[0] + n[1] * x[1] + n[2] * x[2]
        rate = n[0] * velocity[0] + n[1] * velocity[1] + n[2] * velocity[2]
        length += across * across
        speed += rate * rate
        for k in range(3):
            u[k] += across * n[k]
    length = np.sqrt(length)
    for k in range(3):
        u[k] = u[k] / length if length > SINGULAR else p[12 + 3 * first + k]
    _along(u, S, scratch, out, row)
    out.error[row] = length - p[4]
    if length > SINGULAR:
        rate = out.rate[row]
        out.drift[row] += max(speed - rate * rate, 0.0) / length


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
        _turning(B[3 + 3 * i : 6 + 3 * i], S, out, row + i)


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
        _turning(B[3:6], S, out, row)
    else:
        cross_into(S.V[3:6], B[:3], change)
        cross_into(n, change, B[3:6])
        for i in range(3):
            c[i] /= sine
        _turning(c, S, out, row)
        inward = c[0] * B[3] + c[1] * B[4] + c[2] * B[5]
        for i in range(3):
            out.drift[row] += (B[3 + i] - inward * c[i]) / sine * S.V[3 + i]
    out.error[row] = np.arctan2(sine, cosine) - p[5]


@inner
def _turning(u: Array, S: FrameState, out: Rows, row: int) -> None:
    """Rate, drift and Jacobian of a row that turns about u; not the error."""
    out.rate[row] = u[0] * S.V[3] + u[1] * S.V[4] + u[2] * S.V[5]
    out.drift[row] = u[0] * S.drift[3] + u[1] * S.drift[4] + u[2] * S.drift[5]
    J, J_S = out.A, S.J
    for j in range(J.shape[1]):
        J[row, j] = u[0] * J_S[3, j] + u[1] * J_S[4, j] + u[2] * J_S[5, j]
