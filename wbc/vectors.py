"""Inner loops of the tick, for vectors of a few to a few dozen numbers.

They go by four, which fits the vector units, and end without a loop: with so few
numbers, what the processor cannot foresee costs more than the arithmetic. Their
counters are unsigned: an index that might be negative, and so count from the end,
keeps the compiler from using vector units (4 times slower at n = 50).
"""

from __future__ import annotations

from typing import Final

import numpy as np

from wbc.arrays import Array
from wbc.compiled import compiled, inner

__all__ = [
    "add_scaled", "copy", "dot", "finite", "fours", "length", "reflect", "reflect_back",
]  # fmt: skip

ONE: Final = np.uintp(1)
TWO: Final = np.uintp(2)
THREE: Final = np.uintp(3)
FOUR: Final = np.uintp(4)


@inner
def dot(a: Array, b: Array, i: int, n: int) -> float:
    """Sum of a[j] b[j] over i <= j < n."""
    j, end = np.uintp(i), np.uintp(n)
    s0 = s1 = s2 = s3 = 0.0
    while j + FOUR <= end:
        s0 += a[j] * b[j]
        s1 += a[j + ONE] * b[j + ONE]
        s2 += a[j + TWO] * b[j + TWO]
        s3 += a[j + THREE] * b[j + THREE]
        j += FOUR
    if j + TWO <= end:
        s0 += a[j] * b[j]
        s1 += a[j + ONE] * b[j + ONE]
        j += TWO
    if j < end:
        s2 += a[j] * b[j]
    return (s0 + s1) + (s2 + s3)


@inner
def add_scaled(factor: float, a: Array, b: Array, i: int, n: int) -> None:
    """b[j] += factor a[j] over i <= j < n."""
    j, end = np.uintp(i), np.uintp(n)
    while j + FOUR <= end:
        b0, b1 = b[j] + factor * a[j], b[j + ONE] + factor * a[j + ONE]
        b2 = b[j + TWO] + factor * a[j + TWO]
        b3 = b[j + THREE] + factor * a[j + THREE]
        b[j], b[j + ONE], b[j + TWO], b[j + THREE] = b0, b1, b2, b3
        j += FOUR
    if j + TWO <= end:
        b0, b1 = b[j] + factor * a[j], b[j + ONE] + factor * a[j + ONE]
        b[j], b[j + ONE] = b0, b1
        j += TWO
    if j < end:
        b[j] += factor * a[j]


@inner
def fours(i: int) -> int:
    """The multiple of four at or before i.

    Reflector i begins with i zeros. Reflections that begin here instead take some of
    them along, and have the same few lengths.
    """
    return i & -4


@inner
def copy(a: Array, b: Array) -> None:
    """B <- a; assigning a slice would allocate, in case the two overlap."""
    for j in range(a.size):
        b[j] = a[j]


@compiled
def finite(a: Array) -> bool:
    """Whether no number of a (n,) is NaN or infinite: 0 times any other is 0."""
    j, end = np.uintp(0), np.uintp(a.size)
    s0 = s1 = s2 = s3 = 0.0
    while j + FOUR <= end:
        s0 += 0.0 * a[j]
        s1 += 0.0 * a[j + ONE]
        s2 += 0.0 * a[j + TWO]
        s3 += 0.0 * a[j + THREE]
        j += FOUR
    while j < end:
        s0 += 0.0 * a[j]
        j += ONE
    return bool((s0 + s1) + (s2 + s3) == 0.0)


@inner
def length(a: Array) -> float:
    """Euclidean norm."""
    return float(np.sqrt(dot(a, a, 0, a.size)))


@inner
def reflect(a: Array, V: Array, beta: Array, count: int) -> None:
    """A <- H_count ... H_1 a: from x's coordinates to c's."""
    n = a.size
    for i in range(count):
        j = fours(i)
        add_scaled(-beta[i] * dot(a, V[i], j, n), V[i], a, j, n)


@inner
def reflect_back(a: Array, V: Array, beta: Array, count: int) -> None:
    """A <- H_1 ... H_count a: from c's coordinates to x's."""
    n = a.size
    for i in range(count - 1, -1, -1):
        j = fours(i)
        add_scaled(-beta[i] * dot(a, V[i], j, n), V[i], a, j, n)
