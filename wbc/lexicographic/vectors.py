"""Inner loops of the solver."""

from __future__ import annotations

from wbc.arrays import Array
from wbc.compiled import inner

__all__ = ["add_scaled", "dot", "reflect", "reflect_back"]


@inner
def dot(a: Array, b: Array, i: int, n: int) -> float:
    """Sum of a[j] b[j] over i <= j < n."""
    total = 0.0
    for j in range(i, n):
        total += a[j] * b[j]
    return total


@inner
def add_scaled(factor: float, a: Array, b: Array, i: int, n: int) -> None:
    """b[j] += factor a[j] over i <= j < n."""
    for j in range(i, n):
        b[j] += factor * a[j]


@inner
def reflect(w: Array, V: Array, beta: Array, count: int) -> None:
    """W <- H_count ... H_1 w: from x's coordinates to c's."""
    n = w.size
    for i in range(count):
        add_scaled(-beta[i] * dot(w, V[i], i, n), V[i], w, i, n)


@inner
def reflect_back(w: Array, V: Array, beta: Array, count: int) -> None:
    """W <- H_1 ... H_count w: from c's coordinates to x's."""
    n = w.size
    for i in range(count - 1, -1, -1):
        add_scaled(-beta[i] * dot(w, V[i], i, n), V[i], w, i, n)
