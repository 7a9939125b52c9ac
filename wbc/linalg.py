"""Rank-revealing least squares, the one numerical kernel under both resolvers."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from wbc.arrays import Array

__all__ = ["RANK_TOLERANCE", "Factor", "cross", "factorise", "norm", "recursion"]

RANK_TOLERANCE = 1e-9
"""A singular value below this times the norm of the task's own matrix, *before*
any projection, counts as zero. Relative to the projected matrix instead, a task
that conflicts fully with those above would have its round-off inverted."""


class Factor(NamedTuple):
    """Thin singular value decomposition A = U diag(sigma) V1^T, rank revealed.

    Attributes:
        U: (m, r) basis of the range.
        sigma: (r,) singular values above the tolerance, in decreasing order.
        V1: (n, r) basis of the row space.
        V2: (n, n - r) basis of the null space.
        lost: largest singular value that was dropped, 0 if none.
    """

    U: Array
    sigma: Array
    V1: Array
    V2: Array
    lost: float

    @property
    def rank(self) -> int:
        """Number of singular values kept."""
        return int(self.sigma.size)

    def solve(self, b: Array) -> Array:
        """Least-squares solution of least norm of A x = b, (n,)."""
        return self.V1 @ ((self.U.T @ b) / self.sigma)


def factorise(A: Array, scale: float, tolerance: float = RANK_TOLERANCE) -> Factor:
    """Decompose A (m, n), dropping singular values below `tolerance * scale`.

    Args:
        A: the matrix, usually a task's rows times the basis that is left to it.
        scale: norm of the same rows before projection.
        tolerance: relative threshold.
    """
    m, n = A.shape
    if m == 0 or n == 0:
        return Factor(np.zeros((m, 0)), np.zeros(0), np.zeros((n, 0)), np.eye(n), 0.0)
    U, sigma, Vt = np.linalg.svd(A, full_matrices=True)
    rank = int(np.count_nonzero(sigma > tolerance * scale))
    lost = float(sigma[rank]) if rank < sigma.size else 0.0
    return Factor(U[:, :rank], sigma[:rank], Vt[:rank].T, Vt[rank:].T, lost)


def recursion(
    levels: Iterable[tuple[Array, Array]], n: int, tolerance: float = RANK_TOLERANCE
) -> tuple[Array, list[int]]:
    """Lexicographic least squares of equalities, of least norm where free.

    For each level x <- x + Z (J Z)^+ (b - J x), then Z <- Z null(J Z).

    Args:
        levels: (J (m, n), b (m,)) from the top.
        n: number of unknowns.
        tolerance: relative rank tolerance.

    Returns:
        x (n,) and the rank of every level.
    """
    x, Z = np.zeros(n), np.eye(n)
    ranks = []
    for J, b in levels:
        factor = factorise(J @ Z, norm(J), tolerance)
        x = x + Z @ factor.solve(b - J @ x)
        Z = Z @ factor.V2
        ranks.append(factor.rank)
    return x, ranks


def norm(A: Array) -> float:
    """Frobenius norm; 1 for a matrix of zeros, so that it can divide."""
    flat = A.ravel()
    return float(np.sqrt(flat @ flat)) or 1.0


def cross(a: Array, b: Array) -> Array:
    """Product a x b of two (3,) vectors; np.cross pays for its generality."""
    a0, a1, a2 = a
    b0, b1, b2 = b
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])
