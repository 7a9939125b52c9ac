"""All of the catalogue's rows in one compiled call."""

from __future__ import annotations

from enum import IntEnum

from tasks.kernels.clearance import clearance
from tasks.kernels.constraints import constraint
from tasks.kernels.joints import at_rest, at_target, joint_bounds, torque_bounds
from tasks.kernels.paths import SCRATCH, along_path, on_curve, speed
from tasks.kernels.points import on_point
from tasks.kernels.rotations import along, orientation, pose
from wbc import slots
from wbc.approach import approach
from wbc.arrays import Array, IntArray
from wbc.assembly import measured
from wbc.compiled import compiled, inner
from wbc.frames import FrameState, frame_at, update_frame
from wbc.pointers import floats_at, integers_at, matrix
from wbc.program import ENTRY
from wbc.relative import MOVING_SIZE, moved, relative
from wbc.rows import Rows
from wbc.tick import conclude
from wbc.vectors import dot

__all__ = ["SCRATCH", "Code", "evaluate", "evaluate_alone", "run"]


class Code(IntEnum):
    """Which kernel computes a task's rows."""

    ON_POINT = 0
    CONSTRAINT = 1
    ORIENTATION = 2
    POSE = 3
    ALONG = 4
    ON_CURVE = 5
    SPEED = 6
    ALONG_PATH = 7
    AT_TARGET = 8
    AT_REST = 9
    JOINT_BOUNDS = 10
    TORQUE_BOUNDS = 11
    CLEARANCE = 12


@inner
def evaluate(
    code: int,
    p: Array,
    table: Array,
    F: FrameState,
    q: Array,
    v: Array,
    t: float,
    dt: float,
    scratch: Array,
    out: Rows,
) -> None:
    """Write one task's rows.

    Args:
        code: of the kernel.
        p: the task's parameters.
        table: more of them.
        F: its frame, as seen from its second one if it has two; any frame for tasks
            without one.
        q: (n,) positions.
        v: (n,) velocities.
        t: time [s].
        dt: control period [s].
        scratch: (96 + n,) numbers on the way.
        out: the rows; `rate` must be 0 on entry.
    """
    if code == 0:
        on_point(p, F, out)
    elif code == 1:
        constraint(p, F, v, scratch, out)
    elif code == 2:
        orientation(p, F, scratch, out, 0)
    elif code == 3:
        pose(p, F, scratch, out)
    elif code == 4:
        along(p, F, scratch, out)
    elif code == 5:
        on_curve(table, F, scratch, out)
    elif code == 6:
        speed(p, table, F, t, scratch, out)
    elif code == 7:
        along_path(p, table, F, scratch, out)
    elif code == 8:
        at_target(p, table, q, out)
    elif code == 9:
        at_rest(table, v, out)
    elif code == 10:
        joint_bounds(p, table, q, v, dt, out)
    elif code == 11:
        torque_bounds(p, out)
    elif code == 12:
        clearance(p, F, out)


@compiled
def evaluate_alone(
    code: int,
    p: Array,
    table: Array,
    flat: Array,
    q: Array,
    v: Array,
    t: float,
    dt: float,
    scratch: Array,
    out: Rows,
) -> None:
    """The same for a flat frame (24 + 6 n,), with fewer arrays to hand over."""
    F = frame_at(flat, q.size)
    evaluate(code, p, table, F, q, v, t, dt, scratch, out)


@compiled
def run(table: IntArray, q: Array, v: Array, t: float, dt: float, out: Array) -> int:
    """Update the frames, write the rows of all tasks, and conclude the tick.

    It is the runner of this catalogue's kernels; `wbc.tick` tells its arguments and
    what it returns.
    """
    if not measured(q, v, t):
        return slots.UNMEASURED
    n, m = table[slots.JOINTS], table[slots.ROWS]
    f, tasks, spare = table[slots.FRAMES], table[slots.TASKS], SCRATCH + 6 * n
    pointers = matrix(integers_at(table[slots.POINTERS], f * 6), f, 6)
    constants = matrix(floats_at(table[slots.CONSTANTS], f * (15 + n)), f, 15 + n)
    blocks = matrix(floats_at(table[slots.BLOCKS], f * (24 + 6 * n)), f, 24 + 6 * n)
    scratch = matrix(floats_at(table[slots.SCRATCH], 4 * spare), 4, spare)
    jacobian = table[slots.JACOBIAN]
    for i in range(f):
        update_frame(blocks[i], pointers[i], constants[i], jacobian, scratch[1], n)
    _write_rows(
        matrix(integers_at(table[slots.PROGRAM], tasks * ENTRY), tasks, ENTRY),
        matrix(floats_at(table[slots.GAINS], 2 * m), 2, m),
        blocks,
        scratch,
        q,
        v,
        t,
        dt,
        matrix(floats_at(table[slots.RAW], m * n), m, n),
        matrix(floats_at(table[slots.BANDS], 5 * m), 5, m),
    )
    return conclude(table, out)


@inner
def _write_rows(
    program: IntArray,
    gains: Array,
    blocks: Array,
    scratch: Array,
    q: Array,
    v: Array,
    t: float,
    dt: float,
    A: Array,
    bands: Array,
) -> None:
    """The rows of all tasks, and the accelerations that their laws want of them.

    Args:
        program: (k, 11) for each task: code, frame, first row, end, address and size of
            parameters, address and size of the table, second frame (-1 for none),
            address of a frame that moves by itself (0 for none; it takes the place of
            the frame that is -2), address of the gains of `approach` (0 for none).
        gains: (2, m) stiffness and damping of every row; negative for bounds.
        blocks: the frames, flat.
        scratch: (4, 96 + 6 n) numbers on the way; the last row starts as zeros.
        q: (n,) positions.
        v: (n,) velocities.
        t: time [s].
        dt: control period [s].
        A: (m, n) is written.
        bands: (5, m) error, rate, drift, lower, upper are written.
    """
    n = q.size
    for k in range(program.shape[0]):
        code, begin, end = program[k, 0], program[k, 2], program[k, 3]
        out = Rows(
            bands[0, begin:end],
            bands[1, begin:end],
            bands[2, begin:end],
            bands[3, begin:end],
            bands[4, begin:end],
            A[begin:end],
        )
        p = floats_at(program[k, 4], program[k, 5])
        table = floats_at(program[k, 6], program[k, 7])
        out.rate[:] = 0.0
        F = _seen(program[k], blocks, scratch, t, n)
        evaluate(code, p, table, F, q, v, t, dt, scratch[0], out)
        for i in range(begin, end):
            if gains[0, i] >= 0.0:
                bands[1, i] += dot(A[i], v, 0, n)
                wish = gains[0, i] * bands[0, i] + gains[1, i] * bands[1, i]
                bands[3, i] = bands[4, i] = -wish - bands[2, i]
        if program[k, 10] != 0:
            approach(out.error, out.rate, floats_at(program[k, 10], 4), out.upper)
            for i in range(begin, end):
                bands[4, i] -= bands[2, i]
                bands[3, i] = bands[4, i]


@inner
def _seen(
    entry: IntArray, blocks: Array, scratch: Array, t: float, n: int
) -> FrameState:
    """The frame that a task reads, as seen from its second one if it has two."""
    first, second = entry[1], entry[8]
    if second == -1:
        return frame_at(blocks[first], n)
    by_itself = scratch[3]
    if entry[9] != 0:
        moved(floats_at(entry[9], MOVING_SIZE), t, by_itself)
    F = by_itself if first == -2 else blocks[first]
    G = by_itself if second == -2 else blocks[second]
    relative(F, G, scratch[2], scratch[1], n)
    return frame_at(scratch[2], n)
