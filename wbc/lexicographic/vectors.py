"""Inner loops of the solver.

Their counters are unsigned: an index that might be negative, and so count from the
end, keeps the compiler from using vector units (4 times slower at n = 50).
"""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array
from wbc.compiled import inner

__all__ = ["add_scaled", "copy", "dot", "length", "reflect", "reflect_back"]


@inner
def dot(a: Array, b: Array, i: int, n: int) -> float:
    """Sum of a[j] b[j] over i <= j < n."""
    total = 0.0
    for j in range(np.uintp(i), np.uintp(n)):
        total += a[j] * b[j]
    return total


@inner
def add_scaled(factor: float, a: Array, b: Array, i: int, n: int) -> None:
    """b[j] += factor a[j] over i <= j < n."""
    for j in range(np.uintp(i), np.uintp(n)):
        b[j] += factor * a[j]


@inner
def copy(a: Array, b: Array) -> None:
    """B <- a; assigning a slice would allocate, in case the two overlap."""
    for j in range(a.size):
        b[j] = a[j]


@inner
def length(a: Array) -> float:
    """Euclidean norm."""
    return float(np.sqrt(dot(a, a, 0, a.size)))


@inner
def reflect(a: Array, V: Array, beta: Array, count: int) -> None:
    """A <- H_count ... H_1 a: from x's coordinates to c's."""
    n = a.size
    for i in range(count):
        add_scaled(-beta[i] * dot(a, V[i], i, n), V[i], a, i, n)


@inner
def reflect_back(a: Array, V: Array, beta: Array, count: int) -> None:
    """A <- H_1 ... H_count a: from c's coordinates to x's."""
    n = a.size
    for i in range(count - 1, -1, -1):
        add_scaled(-beta[i] * dot(a, V[i], i, n), V[i], a, i, n)
