from __future__ import annotations

import numpy as np

from wbc.bounds import at_bounds

INF = np.inf


def found(A, x, lower, upper) -> tuple[bool, list[bool]]:
    A, x, lower, upper = (np.array(a, dtype=float) for a in (A, x, lower, upper))
    at = np.ones(lower.size, dtype=bool)
    return at_bounds(A, x, lower, upper, at), at.tolist()


def test_a_row_at_a_bound_or_beyond_it_is_found():
    A = [[1, 0], [1, 0], [0, 2], [0, 2]]
    lower, upper = [-INF, 0, 3, -INF], [1, INF, 5, 3]
    assert found(A, [1.0, 2.0], lower, upper) == (True, [True, False, False, True])


def test_nearness_is_relative_to_the_value():
    assert found([[1.0]], [1e6 - 0.05], [-1e6], [1e6]) == (True, [True])
    assert found([[1.0]], [0.95], [-1], [1]) == (False, [False])


def test_equalities_and_rows_without_bounds_never_are():
    assert found([[1], [1]], [2], [2, -INF], [2, INF]) == (False, [False, False])


def test_without_rows_there_is_nothing_to_find():
    assert found(np.zeros((0, 3)), np.zeros(3), [], []) == (False, [])
