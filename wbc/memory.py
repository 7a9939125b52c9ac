"""The memory of a compiled solver: all arrays of its structures, in one block."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, final

import numpy as np

from wbc.arrays import IntArray
from wbc.pointers import address_of
from wbc.structure import ENTRIES, Structure

__all__ = ["Memory"]


@final
class Memory:
    """Arrays for p levels of m rows in n unknowns, allocated once.

    Args:
        sizes: number of rows of every level.
        n: number of unknowns.
        structures: each after the one before; the first has a vector `table`, for the
            table of them all, and `start` (p + 1,), the first row of every level.

    Attributes:
        address: of that table, which compiled code takes for any of the structures.
    """

    __slots__ = ("_block", "_first", "_layout", "address")

    def __init__(self, sizes: Sequence[int], n: int, *structures: Structure) -> None:
        self._first, last = structures[0], structures[-1]
        self._layout, size = _layout(last, len(sizes), int(sum(sizes)), n)
        self._block = np.zeros(size)
        table = self["table"]
        table[:] = self._layout.ravel()
        table[::ENTRIES] += address_of(self._block)
        self.address = address_of(table)
        self["start"][1:] = np.cumsum(np.array(sizes, np.int_))

    def __getitem__(self, name: str) -> Any:
        """An array of the first structure, as a view."""
        return self._first.view(name, self._block, self._layout)


@lru_cache(maxsize=64)
def _layout(of: Structure, p: int, m: int, n: int) -> tuple[IntArray, int]:
    """Where everything lies, and the words that shapes are given in."""
    sizes = {"1": 1, "2": 2, "p": p, "p + 1": p + 1, "2 p + 1": 2 * p + 1}
    sizes |= {"m": m, "n": n, "n + 1": n + 1, "table": ENTRIES * of.size}
    return of.layout(sizes)
