"""Tasks and limits in joint space."""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array
from wbc.compiled import inner
from wbc.rows import Rows

__all__ = ["at_rest", "at_target", "joint_bounds", "torque_bounds"]

RECOVERY = 0.1
"""Time constant [s] of the way back into the limits."""
RECOVERY_SPEED = 0.25
"""Share of the velocity limit that the way back may use."""


@inner
def at_target(p: Array, table: Array, q: Array, out: Rows) -> None:
    """E = q - q_d for the joints whose indices the table holds. Parameters: q_d."""
    J = out.A
    J[:] = 0.0
    for i in range(J.shape[0]):
        joint = int(table[i])
        out.error[i] = q[joint] - p[i]
        out.drift[i] = 0.0
        J[i, joint] = 1.0


@inner
def at_rest(table: Array, v: Array, out: Rows) -> None:
    """Velocity of the joints whose indices the table holds."""
    J = out.A
    J[:] = 0.0
    for i in range(J.shape[0]):
        joint = int(table[i])
        out.error[i] = v[joint]
        out.drift[i] = 0.0
        J[i, joint] = 1.0


@inner
def torque_bounds(p: Array, out: Rows) -> None:
    """-p <= tau <= p."""
    _identity(out.A)
    for i in range(p.size):
        out.lower[i], out.upper[i] = -p[i], p[i]


@inner
def joint_bounds(
    p: Array, table: Array, q: Array, v: Array, dt: float, out: Rows
) -> None:
    """Bounds on vdot. Parameters: braking share, exact (0 or 1); table: q_min, q_max,
    v_max, a_max of the joints, margins included.
    """
    n = q.size
    _identity(out.A)
    for i in range(n):
        low, high, V, A = table[i], table[n + i], table[2 * n + i], table[3 * n + i]
        if p[1] == 0.0:
            upper = semi_implicit(high - q[i], v[i], V, A, p[0] * A, dt)
            lower = -semi_implicit(q[i] - low, -v[i], V, A, p[0] * A, dt)
        else:
            upper = exact(high - q[i], v[i], V, A, p[0] * A, dt)
            lower = -exact(q[i] - low, -v[i], V, A, p[0] * A, dt)
        if lower > upper:
            lower = upper = 0.5 * (lower + upper)
        out.lower[i], out.upper[i] = lower, upper


@inner
def _identity(J: Array) -> None:
    J[:] = 0.0
    for i in range(J.shape[0]):
        J[i, i] = 1.0


@inner
def semi_implicit(
    gap: float, v: float, V: float, A: float, stop: float, dt: float
) -> float:
    """Largest acceleration towards a limit, for v+ = v + dt a, q+ = q + dt v+.

    v+ <= min(V, -stop dt + sqrt((stop dt)^2 + 2 stop gap)): after the step, braking
    with `stop` ends at the limit.

    Args:
        gap: distance to the limit, negative beyond it.
        v: velocity towards it.
        V: velocity limit.
        A: acceleration limit.
        stop: deceleration that braking counts on.
        dt: control period [s].
    """
    if gap < 0.0:
        after = _way_back(gap, V)
    else:
        after = min(V, -stop * dt + np.sqrt(stop * dt * stop * dt + 2.0 * stop * gap))
    return min(max((after - v) / dt, -A), A)


@inner
def exact(gap: float, v: float, V: float, A: float, stop: float, dt: float) -> float:
    """Largest acceleration towards a limit, constant over dt (Del Prete 2018).

    The least of the bounds by position within the step, by velocity, and by viability
    after it. Arguments as for `semi_implicit`.
    """
    if gap < 0.0:
        return min(max((_way_back(gap, V) - v) / dt, -A), A)
    a1, a3 = -v / dt, 2.0 * (gap - dt * v) / (dt * dt)
    position = a3
    if v > 0.0 and a3 <= a1:
        position = min(a1, -v * v / (2.0 * gap)) if gap > 0.0 else -A
    b = 2.0 * dt * v + stop * dt * dt
    c = v * v - 2.0 * stop * (gap - dt * v)
    root = b * b - 4.0 * dt * dt * c
    viable = a1
    if root >= 0.0:
        viable = max(a1, (-b + np.sqrt(root)) / (2.0 * dt * dt))
    return min(max(min(position, (V - v) / dt, viable), -A), A)


@inner
def _way_back(gap: float, V: float) -> float:
    """Velocity wanted beyond a limit: back in, at a share of the limit's speed."""
    return max(gap / RECOVERY, -RECOVERY_SPEED * V)
