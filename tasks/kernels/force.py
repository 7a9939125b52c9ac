"""Motion along some axes of D and force along the others.

Their parameters go on with the selection (6,), 1 for force rows; stiffness and damping
of the motion rows (6,) each, in the order of these; damping of the force rows (6,), in
theirs; and the speed of the search.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from tasks.kernels.forcelaw import command, integrate
from tasks.kernels.mobility import least_squares
from tasks.kernels.rotations import rotation_vector
from tasks.kernels.touch import (
    FORCE,
    OWN,
    TARGET,
    TARGET_ROTATION,
    component,
    felt_at,
    in_axes,
    press,
)
from wbc.arrays import Array
from wbc.compiled import compiled, inner
from wbc.frames import FrameState, frame_at
from wbc.inertia import factorise
from wbc.pointers import matrix
from wbc.rows import Rows
from wbc.vectors import add_scaled, dot, fours, length

__all__ = [
    "APPROACH", "DAMPING", "FELT", "FORCE_DAMPING", "HELD", "MEMORY", "PLACE",
    "SELECTION", "SIZE", "STIFFNESS", "lean", "move_and_press", "work_size",
]  # fmt: skip

SELECTION, STIFFNESS, DAMPING, FORCE_DAMPING, APPROACH = range(OWN, OWN + 25, 6)
SIZE: Final = APPROACH + 1
"""Where the parameters begin; and how many there are in all."""
MEMORY: Final = 7
HELD, HELD_RATE, MEASURED, DESIRED, FELT, PRESSED, PLACE = range(MEMORY)
"""Rows of a memory (7, 6). Of the force rows, in their order: integral term, its rate,
F_s and F_d. Then the wrench felt about F's origin, the part of it in force rows, both
in world axes, and F's origin."""
HEAD: Final = 60
"""Numbers on the way before those whose count depends on the robot."""


def work_size(n: int) -> int:
    """Numbers on the way of `move_and_press`, for n joints."""
    return 2 * n * n + 7 * n + 2 * max(n, 6) + 36 + 6 * 4


@compiled
def move_and_press(
    p: Array,
    flat: Array,
    sensor: Array,
    measured: Array,
    M: Array,
    memory: Array,
    work: Array,
    proportional: float,
    integral: float,
    touching: bool,
    out: Rows,
) -> float:
    """Motion rows by a PD, force rows by a `ForceLaw` or, before contact, a search.

    Args:
        p: (58,) parameters.
        flat: the frame.
        sensor: the sensor's frame.
        measured: (6,) wrench of the robot on its surroundings there, world axes.
        M: (n, n) inertia.
        memory: (7, 6) the integral term is read, all others are written.
        work: (`work_size`,) numbers on the way.
        proportional: kp of the force [1].
        integral: ki of the force [1/s].
        touching: whether there is contact.
        out: the rows.

    Returns:
        Size of the measured force in the force rows [N, Nm].
    """
    n = out.A.shape[1]
    F = frame_at(flat, n)
    in_axes(p, F, out)
    felt_at(F, sensor, measured, memory[FELT])
    count = _measure(p, out.rate, memory, work)
    _move(p, F, work, out)
    for i in range(3):
        memory[PLACE, i] = F.p[i]
    if count > 0:
        if touching:
            _hold(memory, work, proportional, integral, count)
        else:
            _search(p, memory, work, count)
        _accelerate(p, M, memory, work, touching, count, out)
    for row in range(out.lower.size):
        out.upper[row] = out.lower[row]
    return length(memory[MEASURED, :count])


@inner
def _measure(p: Array, twist: Array, memory: Array, work: Array) -> int:
    """Sort out what belongs to force rows; returns their number.

    The first numbers on the way become their speeds.
    """
    felt, pressed, count = memory[FELT], memory[PRESSED], 0
    for i in range(6):
        pressed[i] = 0.0
    for row in range(twist.size):
        if p[SELECTION + row] == 0.0:
            continue
        begin, i = row - row % 3, row % 3
        force = component(p, felt[begin : begin + 3], i)
        memory[MEASURED, count], memory[DESIRED, count] = force, p[FORCE + row]
        for j in range(3):
            pressed[begin + j] += p[3 * j + i] * force
        work[count] = twist[row]
        count += 1
    return count


@inner
def _move(p: Array, F: FrameState, work: Array, out: Rows) -> None:
    """Write the motion rows."""
    turned, e = work[6:15], work[15:21]
    for i in range(3):
        e[i] = F.p[i] - p[TARGET + i]
        for j in range(3):
            R_d = p[TARGET_ROTATION + 3 * j : TARGET_ROTATION + 3 * j + 3]
            turned[3 * i + j] = dot(F.R[i], R_d, 0, 3)
    rotation_vector(turned, e[3:6])
    v, a, k = p[TARGET + 3 : TARGET + 6], p[TARGET + 6 : TARGET + 9], 0
    for row in range(out.error.size):
        if p[SELECTION + row] != 0.0:
            continue
        begin, i = row - row % 3, row % 3
        linear = 1.0 if begin == 0 else 0.0
        out.error[row] = component(p, e[begin : begin + 3], i)
        out.rate[row] -= linear * component(p, v, i)
        wish = p[STIFFNESS + k] * out.error[row] + p[DAMPING + k] * out.rate[row]
        out.lower[row] = linear * component(p, a, i) - wish - out.drift[row]
        k += 1


@inner
def _hold(
    memory: Array, work: Array, proportional: float, integral: float, count: int
) -> None:
    """In contact: the law's force beyond what is felt already, and damping."""
    actual, desired = memory[MEASURED, :count], memory[DESIRED, :count]
    late, push = work[:count], work[6 : 6 + count]
    command(proportional, desired, actual, memory[HELD, :count], push)
    for k in range(count):
        late[k] = -late[k]
        push[k] -= actual[k]
        memory[HELD_RATE, k] = integral * (desired[k] - actual[k])


@inner
def _search(p: Array, memory: Array, work: Array, count: int) -> None:
    """Before contact: the speed that is missing along F_d, angular rows at rest."""
    desired, late, push = memory[DESIRED], work[0:6], work[6:12]
    linear = int(p[SELECTION] + p[SELECTION + 1] + p[SELECTION + 2])
    size = length(desired[:linear])
    share = p[APPROACH] / size if size > 0.0 else 0.0
    for k in range(count):
        late[k] = (share * desired[k] if k < linear else 0.0) - late[k]
        push[k] = memory[HELD, k]


@inner
def _accelerate(
    p: Array,
    M: Array,
    memory: Array,
    work: Array,
    touching: bool,
    count: int,
    out: Rows,
) -> None:
    """Write the force rows; before contact, also what the integral term learns.

    With M^-1 = U U^T the mobility is J M^-1 J^T = B B^T, B = J U.
    """
    n = M.shape[0]
    late, push, y = work[0:6], work[6:12], work[HEAD : HEAD + n]
    L, U = matrix(work[HEAD + n :], n, n), matrix(work[HEAD + n + n * n :], n, n)
    B = matrix(work[HEAD + n + 2 * n * n :], count, n)
    spoilt = 0.0 if factorise(M, L, U) else np.nan
    y[:] = 0.0
    k = 0
    for row in range(out.error.size):
        if p[SELECTION + row] != 0.0:
            B[k] = 0.0
            for j in range(n):
                add_scaled(out.A[row, j], U[j], B[k], fours(j), n)
            add_scaled(push[k], B[k], y, 0, n)
            k += 1
    k = 0
    for row in range(out.error.size):
        if p[SELECTION + row] != 0.0:
            out.error[row] = memory[MEASURED, k] - memory[DESIRED, k]
            out.rate[row] = 0.0
            wish = p[FORCE_DAMPING + k] * late[k] + dot(B[k], y, 0, n)
            out.lower[row] = wish - out.drift[row] + spoilt
            k += 1
    if not touching:
        width = max(n, 6)
        spare = matrix(work[work.size - 2 * width :], 2, width)
        Z, sigma = matrix(work[24:HEAD], count, count), work[18 : 18 + count]
        for k in range(count):  # late speed dies out, critically damped
            push[k] = 0.25 * p[FORCE_DAMPING + k] * p[FORCE_DAMPING + k] * late[k]
        least_squares(B, push[:count], memory[HELD_RATE, :count], Z, sigma, spare)


@compiled
def lean(
    flat: Array,
    memory: Array,
    count: int,
    touching: bool,
    dt: float,
    limit: float,
    torque: Array,
) -> None:
    """Once a tick: add J_f^T F_s to the torques in contact, and move the integral on.

    Args:
        flat: the frame.
        memory: (7, 6) as of `move_and_press`; the integral term is moved on.
        count: number of force rows.
        touching: whether there was contact.
        dt: [s].
        limit: of the integral term [N, Nm].
        torque: (n,) is added to.
    """
    if touching:
        press(flat, memory[PRESSED], torque)
    integrate(memory[HELD, :count], memory[HELD_RATE, :count], dt, limit)
