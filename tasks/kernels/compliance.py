"""A mass, a damper and a spring that answer a measured force.

Their parameters go on with mass, stiffness and damping (3,) each; an admittance's
with stiffness and damping (3,) of the PD that follows its reference.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from tasks.kernels.touch import FORCE, OWN, TARGET, component, felt_at, in_axes
from wbc.arrays import Array
from wbc.compiled import compiled, inner
from wbc.frames import frame_at
from wbc.rows import Rows

__all__ = [
    "FOLLOWING",
    "GAINS",
    "MEMORY",
    "SIZE",
    "admittance",
    "give_way",
    "impedance",
]

GAINS: Final = OWN
FOLLOWING: Final = OWN + 9
SIZE: Final = OWN + 15
"""Where they begin; and how many parameters there are in all."""
MEMORY: Final = 10
"""Numbers that an admittance remembers."""


@inner
def _response(p: Array, error: float, rate: float, h: float, i: int) -> float:
    """Acceleration along axis i of D under h, at x - x_d and its rate."""
    gains = p[GAINS : GAINS + 9]
    pull = p[FORCE + i] - h - gains[6 + i] * rate - gains[3 + i] * error
    ahead = component(p, p[TARGET + 6 : TARGET + 9], i)
    return float(ahead + pull / gains[i])


@compiled
def impedance(
    p: Array, flat: Array, sensor: Array, measured: Array, h: Array, out: Rows
) -> None:
    """Md (xdd - xdd_d) + Kd (xd - xd_d) + Kp (x - x_d) = h_d - h as three rows.

    Args:
        p: (48,) parameters.
        flat: the frame.
        sensor: the sensor's frame.
        measured: (6,) wrench of the robot on its surroundings there, world axes.
        h: (6,) the same about the frame's origin, written.
        out: the rows.
    """
    F = frame_at(flat, out.A.shape[1])
    in_axes(p, F, out)
    felt_at(F, sensor, measured, h)
    goal, speed = p[TARGET : TARGET + 3], p[TARGET + 3 : TARGET + 6]
    for i in range(3):
        out.error[i] = component(p, F.p, i) - component(p, goal, i)
        out.rate[i] -= component(p, speed, i)
        wish = _response(p, out.error[i], out.rate[i], component(p, h, i), i)
        out.lower[i] = out.upper[i] = wish - out.drift[i]


@compiled
def admittance(
    p: Array, flat: Array, measured: Array, memory: Array, out: Rows
) -> None:
    """Three rows that follow the reference, and what moves the reference.

    Args:
        p: (48,) parameters.
        flat: the frame.
        measured: (6,) wrench of the robot on its surroundings, world axes.
        memory: (10,) the reference x_c and its velocity, in the world; its acceleration
            in D, written; 0 if there is none yet: then it starts where the frame is.
        out: the rows.
    """
    F = frame_at(flat, out.A.shape[1])
    in_axes(p, F, out)
    x, v, a = memory[0:3], memory[3:6], memory[6:9]
    if memory[9] == 0.0:
        for i in range(3):
            x[i], v[i] = F.p[i], F.V[i]
        memory[9] = 1.0
    goal, speed = p[TARGET : TARGET + 3], p[TARGET + 3 : TARGET + 6]
    kp, kd = p[FOLLOWING : FOLLOWING + 3], p[FOLLOWING + 3 : FOLLOWING + 6]
    for i in range(3):
        error = component(p, x, i) - component(p, goal, i)
        rate = component(p, v, i) - component(p, speed, i)
        a[i] = _response(p, error, rate, component(p, measured, i), i)
        out.error[i] = component(p, F.p, i) - component(p, x, i)
        out.rate[i] -= component(p, v, i)
        wish = a[i] - kp[i] * out.error[i] - kd[i] * out.rate[i]
        out.lower[i] = out.upper[i] = wish - out.drift[i]


@compiled
def give_way(p: Array, memory: Array, dt: float) -> None:
    """Move the reference on by dt [s]; not by what is not finite, nor if there is none.

    Args:
        p: (48,) parameters.
        memory: (10,) as for `admittance`.
        dt: [s].
    """
    x, v, a = memory[0:3], memory[3:6], memory[6:9]
    if memory[9] == 0.0 or not np.isfinite(a[0] + a[1] + a[2]):
        return
    for j in range(3):
        v[j] += dt * (p[3 * j] * a[0] + p[3 * j + 1] * a[1] + p[3 * j + 2] * a[2])
        x[j] += dt * v[j]
