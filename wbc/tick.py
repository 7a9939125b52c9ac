"""What every compiled tick ends with: assembly, solver, inverse dynamics."""

from __future__ import annotations

from wbc import slots
from wbc.arrays import Array, IntArray
from wbc.assembly import assemble, kept, measured
from wbc.compiled import compiled, inner
from wbc.inertia import back_substitute, inverse_dynamics
from wbc.lexicographic.solver import lexicographic
from wbc.lexicographic.work import work_at
from wbc.pointers import floats_at, matrix

__all__ = ["conclude", "without_kernels"]


@inner
def conclude(table: IntArray, out: Array) -> int:
    """Assemble the rows that were written, and solve them if `out` has room for it.

    Args:
        table: of `wbc.slots`.
        out: (2 n + m + p,) torques, accelerations, slacks and ranks are written; or
            (0,) for the rows alone.

    Returns:
        how it ended, as `wbc.slots` lists.
    """
    n, m = table[slots.JOINTS], table[slots.ROWS]
    M = matrix(floats_at(table[slots.INERTIA], n * n), n, n)
    h = floats_at(table[slots.BIAS], n)
    U = matrix(floats_at(table[slots.INVERSE], n * n), n, n)
    Ay = matrix(floats_at(table[slots.Y_ROWS], m * n), m, n)
    bounds = matrix(floats_at(table[slots.BOUNDS], 2 * m), 2, m)
    outcome = assemble(table)
    if outcome != slots.SOLVED or out.size == 0:
        return int(outcome)
    sweeps = lexicographic(Ay, bounds[0], bounds[1], table[slots.SOLVER])
    w, vdot = work_at(table[slots.SOLVER]), out[n : 2 * n]
    back_substitute(U, w.x, vdot)
    for i in range(m):
        out[2 * n + i] = w.slack[i]
    for k in range(w.count.size):
        out[2 * n + m + k] = w.first[k + 1] - w.first[k]
    if not inverse_dynamics(M, h, vdot, out[:n]):
        return slots.NOT_FINITE
    raw = matrix(floats_at(table[slots.RAW], m * n), m, n)
    bands = matrix(floats_at(table[slots.BANDS], 5 * m), 5, m)
    if not kept(raw, bands, table[slots.GUARDED], out[:n]):
        return slots.BEYOND
    return slots.SOLVED if sweeps > 0 else slots.UNSOLVED


@compiled
def without_kernels(
    table: IntArray, q: Array, v: Array, t: float, dt: float, out: Array
) -> int:
    """The tick of a stack whose tasks are all plain Python."""
    if not measured(q, v, t):
        return slots.UNMEASURED
    return conclude(table, out)
