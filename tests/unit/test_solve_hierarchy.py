"""`solve_hierarchy` on input that is wrong, empty or without bounds."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tolerances import BY_HAND
from wbc import InputError, Status, UnknownName, solve_hierarchy

INF = np.inf
ROW = [[1.0, 2.0]]


@pytest.mark.parametrize(
    ("levels", "words"),
    [
        ([], "at least one level"),
        ([([[np.nan, 0.0]], [0.0], [0.0])], "level 1 contains NaN"),
        ([([[INF, 0.0]], [0.0], [0.0])], "infinite coefficient"),
        ([(ROW, [np.nan], [0.0])], "level 1 contains NaN"),
        ([(ROW, [0.0], [0.0]), (ROW, [1.0], [0.5])], "level 2, row 0: lower bound 1.0"),
        ([(ROW, [INF], [INF])], "no number between"),
        ([(ROW, [-INF], [-INF])], "no number between"),
        ([(ROW, [0.0, 0.0], [0.0])], "bounds have shapes"),
        ([(ROW, [0.0], [0.0]), ([[1.0]], [0.0], [0.0])], r"must be \(m, 2\)"),
        ([(np.zeros((1, 0)), [0.0], [0.0])], r"shape \(1, 0\)"),
        ([([1.0, 2.0], [0.0], [0.0])], r"shape \(2,\)"),
    ],
)
def test_what_cannot_be_solved_is_named(levels, words):
    with pytest.raises(InputError, match=words):
        solve_hierarchy(levels)


def test_an_unknown_backend_lists_the_installed_ones():
    with pytest.raises(UnknownName, match="daqp"):
        solve_hierarchy([(ROW, [0.0], [0.0])], "simplex")


def test_a_level_without_rows_takes_no_freedom():
    nothing = (np.zeros((0, 2)), [], [])
    result = solve_hierarchy([nothing, (ROW, [5.0], [5.0]), nothing])
    np.testing.assert_allclose(result.x, [1.0, 2.0], atol=BY_HAND)
    assert result.ranks == (0, 1, 0)
    assert [slack.size for slack in result.slacks] == [0, 1, 0]


def test_a_row_of_zeros_misses_by_its_bound():
    result = solve_hierarchy([([[0.0, 0.0]], [1.0], [1.0]), (ROW, [5.0], [5.0])])
    np.testing.assert_allclose(result.x, [1.0, 2.0], atol=BY_HAND)
    np.testing.assert_allclose(result.slacks[0], [1.0], atol=BY_HAND)
    assert result.ranks == (0, 1)


def test_a_row_without_bounds_is_as_if_it_were_not_there():
    result = solve_hierarchy([(ROW, [-INF], [INF])])
    np.testing.assert_array_equal(result.x, [0.0, 0.0])
    assert result.status is Status.SOLVED
    assert not result.active[0].any()


def test_nothing_but_unbounded_levels_gives_the_point_of_least_norm():
    box = (np.eye(3), np.full(3, -INF), np.full(3, INF))
    np.testing.assert_array_equal(solve_hierarchy([box, box]).x, np.zeros(3))
