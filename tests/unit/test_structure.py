"""Arrays behind one address, and inner loops, as compiled code sees them."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numba
import numpy as np
import pytest

from tests.tolerances import ROUND_OFF
from wbc.arrays import Array, IntArray
from wbc.pointers import address_of, matrix
from wbc.structure import ENTRIES, Structure
from wbc.vectors import add_scaled, copy, dot

ROWS, COLUMNS = 3, 4


class First(NamedTuple):
    numbers: Annotated[IntArray, "rows"]
    table: Annotated[Array, "rows, columns"]


class Second(NamedTuple):
    numbers: Annotated[Array, "columns"]


FIRST = Structure(First)
SECOND = Structure(Second, after=FIRST)
first_at, second_at = FIRST.at, SECOND.at


@numba.njit
def fill(address):
    first, second = first_at(address), second_at(address)
    for i in range(first.numbers.size):
        first.numbers[i] = 10 * (i + 1)
        for j in range(first.table.shape[1]):
            first.table[i, j] = i + 0.1 * j
    for j in range(second.numbers.size):
        second.numbers[j] = -j


@numba.njit
def summed(a, b, i, n):
    return dot(a, b, i, n)


@numba.njit
def added(factor, a, b, i, n):
    add_scaled(factor, a, b, i, n)


@numba.njit
def copied(a, b):
    copy(a, b)


@numba.njit
def corner(numbers, rows, columns):
    return matrix(numbers, rows, columns)[rows - 1, 1]


@numba.njit
def unknown(address):
    return first_at(address).missing


def laid_out():
    """A block, its layout, and the table with the block's addresses."""
    layout, size = SECOND.layout({"rows": ROWS, "columns": COLUMNS})
    block = np.zeros(size)
    table = layout.ravel().copy()
    table[::ENTRIES] += address_of(block)
    return block, layout, table


def test_compiled_code_and_python_see_the_same_arrays():
    block, layout, table = laid_out()
    fill(address_of(table))
    assert FIRST.view("numbers", block, layout).tolist() == [10, 20, 30]
    wanted = np.arange(ROWS)[:, None] + 0.1 * np.arange(COLUMNS)
    found = FIRST.view("table", block, layout)
    np.testing.assert_allclose(found, wanted, atol=ROUND_OFF)
    assert SECOND.view("numbers", block, layout).tolist() == [0.0, -1.0, -2.0, -3.0]


def test_arrays_lie_end_to_end():
    block, _, _ = laid_out()
    assert block.size == ROWS + ROWS * COLUMNS + COLUMNS


def test_a_name_that_is_not_there_does_not_compile():
    _, _, table = laid_out()
    with pytest.raises(numba.TypingError, match="missing"):
        unknown(address_of(table))


@pytest.mark.parametrize("n", range(11))
@pytest.mark.parametrize("i", [0, 1, 4])
def test_loops_by_four_reach_every_number_once(n, i):
    rng = np.random.default_rng([n, i])
    a, b = rng.normal(size=n), rng.normal(size=n)
    assert summed(a, b, i, n) == pytest.approx(float(a[i:] @ b[i:]), abs=ROUND_OFF)
    wanted = b.copy()
    wanted[i:] += 2.5 * a[i:]
    added(2.5, a, b, i, n)
    np.testing.assert_allclose(b, wanted, atol=ROUND_OFF)
    copied(a, b)
    assert np.array_equal(a, b)


def test_a_vector_in_rows_is_a_view_by_rows():
    assert corner(np.arange(6.0), 3, 2) == 5.0
