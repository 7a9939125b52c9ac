"""From the tasks' rows to the rows of a stack: torque rows, weights, kinetic metric."""

from __future__ import annotations

import numpy as np

from wbc import slots
from wbc.arrays import Array, IntArray
from wbc.compiled import compiled, inner
from wbc.inertia import factorise
from wbc.pointers import floats_at, integers_at, matrix
from wbc.vectors import add_scaled, finite, fours

__all__ = ["NOTHING", "assemble", "kept", "measured"]

NOTHING = 1e-13
"""Round-off of Jacobians, in SI units: a stretched arm has no such direction left."""
BEYOND, TINY = 1e-4, 1e-8
"""Shares of a torque's bound and of the largest torque; outside by more is no
round-off."""


@compiled
def measured(q: Array, v: Array, t: float) -> bool:
    """Whether no number of q (n,), v (n,) and t is NaN or infinite."""
    return bool(finite(q) and finite(v) and np.isfinite(t))


@inner
def assemble(table: IntArray) -> int:
    """Weighted rows in vdot, and in y = L^T vdot with M = L L^T.

    There vdot = U y with U = L^-T. Torque rows become acceleration rows through
    tau = M vdot + h.

    Args:
        table: of `wbc.slots`.

    Returns:
        how it ended, as `wbc.slots` lists; bounds may be infinite, but not NaN.
    """
    n, m = table[slots.JOINTS], table[slots.ROWS]
    M = matrix(floats_at(table[slots.INERTIA], n * n), n, n)
    h = floats_at(table[slots.BIAS], n)
    L = matrix(floats_at(table[slots.FACTOR], n * n), n, n)
    U = matrix(floats_at(table[slots.INVERSE], n * n), n, n)
    if not factorise(M, L, U):
        return slots.NOT_POSITIVE
    raw = matrix(floats_at(table[slots.RAW], m * n), m, n)
    bands = matrix(floats_at(table[slots.BANDS], 5 * m), 5, m)
    weights = floats_at(table[slots.WEIGHTS], m)
    torque = floats_at(table[slots.TORQUE], m)
    joint = integers_at(table[slots.JOINT], m)
    A = matrix(floats_at(table[slots.VDOT_ROWS], m * n), m, n)
    numbers = floats_at(table[slots.Y_ROWS], m * n)
    Ay = matrix(numbers, m, n)
    bounds = matrix(floats_at(table[slots.BOUNDS], 2 * m), 2, m)
    for i in range(m):
        weight, bias = weights[i], 0.0
        if torque[i] == 0.0:
            _motion_row(weight, raw[i], joint[i], U, A[i], Ay[i])
        else:
            bias = _torque_row(weight, raw[i], joint[i], M, h, L, A[i], Ay[i])
        bounds[0, i] = weight * (bands[3, i] - bias)
        bounds[1, i] = weight * (bands[4, i] - bias)
    if finite(numbers) and not _any_nan(bounds):
        return slots.SOLVED
    return slots.BAD_ROW


@inner
def _motion_row(
    weight: float, raw: Array, joint: int, U: Array, a: Array, ay: Array
) -> None:
    """A row (n,) on vdot; on y it is a U.

    Of a row about one joint, what never changes is 0 already. Coefficients that are
    `NOTHING` count as 0; not so NaN.
    """
    n = raw.size
    if joint >= 0:
        a[joint] = weight
        for j in range(joint, n):
            ay[j] = weight * U[joint, j]
        return
    ay[:] = 0.0
    for k in range(n):
        something = not abs(raw[k]) <= NOTHING
        a[k] = weight * raw[k] if something else 0.0
        if something:
            add_scaled(a[k], U[k], ay, fours(k), n)


@inner
def _torque_row(
    weight: float,
    raw: Array,
    joint: int,
    M: Array,
    h: Array,
    L: Array,
    a: Array,
    ay: Array,
) -> float:
    """A row (n,) on M vdot + h; on y it is raw L. Returns raw h."""
    n, bias = raw.size, 0.0
    if joint >= 0:
        for j in range(n):
            a[j] = weight * M[joint, j]
        for j in range(joint + 1):
            ay[j] = weight * L[joint, j]
        return float(h[joint])
    a[:] = 0.0
    ay[:] = 0.0
    for k in range(n):
        if raw[k] != 0.0:
            bias += raw[k] * h[k]
            add_scaled(weight * raw[k], M[k], a, 0, n)
            add_scaled(weight * raw[k], L[k], ay, 0, k + 1)
    return bias


@inner
def _any_nan(bounds: Array) -> bool:
    found = False
    for i in range(bounds.shape[1]):
        found |= np.isnan(bounds[0, i]) | np.isnan(bounds[1, i])
    return bool(found)


@compiled
def kept(raw: Array, bands: Array, rows: int, tau: Array) -> bool:
    """Whether torques tau (n,) keep the bounds of the first so many rows on them.

    Rows that forbid rest are passed over. What is more than `BEYOND` outside is no
    round-off of a solver: the numbers were too large for it.
    """
    largest = 0.0
    for i in range(tau.size):
        largest = max(largest, abs(tau[i]))
    for r in range(rows):
        lower, upper = bands[3, r], bands[4, r]
        if lower > 0.0 or upper < 0.0:
            continue
        value = 0.0
        for j in range(tau.size):
            value += raw[r, j] * tau[j]
        bound = upper if value > 0.0 else -lower
        if abs(value) > bound * (1.0 + BEYOND) + TINY * (1.0 + largest):
            return False
    return True
