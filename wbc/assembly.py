"""From the tasks' rows to the rows of a stack: torque rows, weights, kinetic metric."""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array
from wbc.compiled import compiled, inner

__all__ = [
    "assemble", "back_substitute", "finite", "inverse_dynamics", "kept", "measured",
]  # fmt: skip

BEYOND, TINY = 1e-4, 1e-8
"""Shares of a torque's bound and of the largest torque; outside by more is no
round-off."""


@compiled
def measured(q: Array, v: Array, t: float) -> bool:
    """Whether no number of q (n,), v (n,) and t is NaN or infinite."""
    return bool(finite(q) and finite(v) and np.isfinite(t))


@compiled
def finite(x: Array) -> bool:
    """Whether no number of x (n,) is NaN or infinite."""
    good = True
    for value in x:
        good = good and np.isfinite(value)
    return bool(good)


@inner
def assemble(
    raw: Array,
    bands: Array,
    weights: Array,
    torque: Array,
    M: Array,
    h: Array,
    A: Array,
    Ay: Array,
    bounds: Array,
    L_inv: Array,
) -> int:
    """Weighted rows in vdot, and in y = L^T vdot with M = L L^T.

    Torque rows become acceleration rows through tau = M vdot + h.

    Args:
        raw: (m, n) rows as the tasks wrote them.
        bands: (5, m) error, rate, drift, lower, upper, likewise.
        weights: (m,) what each row is multiplied by.
        torque: (m,) 1 for rows that bind tau, else 0.
        M: (n, n) inertia.
        h: (n,) Coriolis and gravity torques.
        A: (m, n) is written.
        Ay: (m, n) is written.
        bounds: (2, m) lower and upper bounds are written.
        L_inv: (n, n) inverse of the Cholesky factor is written.

    Returns:
        -1 if all is well, -2 if the inertia is not positive definite, else the index of
        a row that is not finite (bounds may be infinite, but not NaN).
    """
    m, n = A.shape
    if not _invert_cholesky(M, L_inv):
        return -2
    for i in range(m):
        bias, weight = 0.0, weights[i]
        if torque[i] == 0.0:
            for j in range(n):
                A[i, j] = weight * raw[i, j]
        else:
            A[i] = 0.0
            for k in range(n):
                if raw[i, k] != 0.0:
                    bias += raw[i, k] * h[k]
                    for j in range(n):
                        A[i, j] += weight * raw[i, k] * M[j, k]
        bounds[0, i] = weight * (bands[3, i] - bias)
        bounds[1, i] = weight * (bands[4, i] - bias)
        for j in range(n):
            total = 0.0
            for k in range(j + 1):
                total += A[i, k] * L_inv[j, k]
            Ay[i, j] = total
        if not finite(Ay[i]) or np.isnan(bounds[0, i]) or np.isnan(bounds[1, i]):
            return i
    return -1


@inner
def _invert_cholesky(M: Array, L_inv: Array) -> bool:
    """Inverse of L with M = L L^T, lower triangular; False if there is no such L."""
    n = M.shape[0]
    L = L_inv  # the factor first, then its inverse, in the same memory
    for j in range(n):
        for i in range(j, n):
            total = M[i, j]
            for k in range(j):
                total -= L[i, k] * L[j, k]
            if i > j:
                L[i, j] = total / L[j, j]
            elif total > 0.0:
                L[j, j] = np.sqrt(total)
            else:
                return False
    for j in range(n):
        L[j, j] = 1.0 / L[j, j]
        for i in range(j + 1, n):
            total = 0.0
            for k in range(j, i):
                total -= L[i, k] * L_inv[k, j]
            L_inv[i, j] = total / L[i, i]
    return True


@compiled
def back_substitute(L_inv: Array, y: Array, vdot: Array) -> None:
    """Vdot = L^-T y, into vdot (n,)."""
    n = y.size
    for i in range(n):
        vdot[i] = 0.0
        for j in range(i, n):
            vdot[i] += L_inv[j, i] * y[j]


@compiled
def inverse_dynamics(M: Array, h: Array, vdot: Array, tau: Array) -> bool:
    """Tau = M vdot + h, into tau (n,); whether it is finite."""
    n = vdot.size
    for i in range(n):
        tau[i] = h[i]
        for j in range(n):
            tau[i] += M[i, j] * vdot[j]
    return finite(tau)


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
