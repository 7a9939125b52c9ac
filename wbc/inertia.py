"""The joint-space inertia M = L L^T: its factor, what it inverts to, what it moves."""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array
from wbc.compiled import compiled, inner
from wbc.vectors import add_scaled, dot, finite, fours

__all__ = ["back_substitute", "factorise", "inverse_dynamics"]


@inner
def factorise(M: Array, L: Array, U: Array) -> bool:
    """Cholesky's factor L and U = L^-T; False if there is no such L.

    Row by row from the top, so that little waits for what was computed just before.

    Args:
        M: (n, n) inertia.
        L: (n, n) its lower triangle is written.
        U: (n, n) is written; 0 below the diagonal.
    """
    n = M.shape[0]
    for i in range(n):
        for j in range(i, n):
            U[i, j] = M[i, j]  # what is left of M above the diagonal, for now
    for k in range(n):
        pivot = U[k, k]
        if not pivot > 0.0:
            return False
        L[k, k] = np.sqrt(pivot)
        U[k, k] = 1.0 / L[k, k]
        for i in range(k + 1, n):
            L[i, k] = U[k, i] * U[k, k]
        for i in range(k + 1, n):
            add_scaled(-L[i, k] * U[k, k], U[k], U[i], fours(i), n)
    for i in range(n):
        for j in range(i):
            U[i, j] = 0.0
            U[j, i] = -dot(L[i], U[j], fours(j), i) * U[i, i]
    return True


@compiled
def back_substitute(U: Array, y: Array, vdot: Array) -> None:
    """Vdot = L^-T y, into vdot (n,)."""
    n = y.size
    for i in range(n):
        vdot[i] = dot(U[i], y, fours(i), n)


@compiled
def inverse_dynamics(M: Array, h: Array, vdot: Array, tau: Array) -> bool:
    """Tau = M vdot + h, into tau (n,); whether it is finite."""
    n = vdot.size
    for i in range(n):
        tau[i] = h[i] + dot(M[i], vdot, 0, n)
    return finite(tau)
