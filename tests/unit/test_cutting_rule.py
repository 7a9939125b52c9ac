"""The cutting rule against hand cases and a dense sampling of the knife's way."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from sims.cutting.meat.rule import cut, segment_distance
from tests.tolerances import ROUND_OFF

WIDTH = 2e-3
LINK = (np.array([[0.50, 0.10, 0.32]]), np.array([[0.50, 0.11, 0.33]]))


def cuts(before, after, ends=LINK) -> bool:
    return cut(np.array(before), np.array(after), *ends, WIDTH).size > 0


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        ((0.499, 0.105, 0.31), (0.501, 0.105, 0.31), True),  # crosses below
        ((0.499, 0.105, 0.325), (0.501, 0.105, 0.325), False),  # below one end only
        ((0.499, 0.105, 0.32), (0.501, 0.105, 0.32), True),  # level with the lower end
        ((0.499, 0.113, 0.31), (0.501, 0.113, 0.31), False),  # 3 mm beyond an end
        ((0.499, 0.1119, 0.31), (0.501, 0.1119, 0.31), True),  # 1.9 mm beyond it
        ((0.503, 0.105, 0.31), (0.5021, 0.105, 0.31), False),  # stops 2.1 mm short
        ((0.503, 0.105, 0.31), (0.5019, 0.105, 0.31), True),  # comes within d
        ((0.40, 0.105, 0.31), (0.60, 0.105, 0.31), True),  # 0.2 m in one step
        ((0.40, 0.105, 0.40), (0.60, 0.105, 0.30), False),  # low only past the link
        ((0.40, 0.105, 0.32), (0.60, 0.105, 0.30), True),  # low early enough
        ((0.60, 0.105, 0.30), (0.40, 0.105, 0.32), True),  # the same way back
        ((0.500, 0.105, 0.40), (0.500, 0.105, 0.31), True),  # straight down
        ((0.500, 0.105, 0.31), (0.500, 0.105, 0.40), True),  # and up
    ],
)
def test_a_link_is_cut_where_the_way_passes_under_it(before, after, expected):
    assert cuts(before, after) is expected


def test_mated_ends_and_links_along_an_axis_can_be_cut():
    """P0 eqs. 4 and 5 give a box without width for both."""
    for other in ([0.5, 0.1, 0.32], [0.5, 0.11, 0.32], [0.51, 0.1, 0.32]):
        ends = np.array([[0.5, 0.1, 0.32]]), np.array([other])
        assert cuts((0.499, 0.1005, 0.31), (0.501, 0.1005, 0.31), ends)


def test_rule_agrees_with_a_dense_sampling_of_the_way():
    """P0 eq. 6 as corrected, abs(cross) / L <= d, and eq. 3 at each sample."""
    rng = np.random.default_rng(0)
    base = rng.uniform(-0.01, 0.01, (400, 3))
    ends = base, base + rng.uniform(-0.008, 0.008, (400, 3))
    for _ in range(8):
        before, after = rng.uniform(-0.012, 0.012, (2, 3))
        hit = np.zeros(400, dtype=bool)
        hit[cut(before, after, *ends, WIDTH)] = True
        way = before + np.linspace(0, 1, 2001)[:, None] * (after - before)
        expected, margin = sampled(way, ends)
        assert (hit == expected)[margin].all()
        assert margin.sum() > 300


def sampled(way, ends):
    """Which links a dense way cuts, and of which that is certain."""
    a, b = ends
    along = (b - a)[:, :2]
    length2 = (along**2).sum(axis=1)
    d = way[:, None, :2] - a[:, :2]
    t = np.clip((d * along).sum(axis=2) / length2, 0, 1)
    cross = np.linalg.norm(d - t[..., None] * along, axis=2)
    low = np.minimum(a[:, 2], b[:, 2])

    def found(width, slack):
        return ((cross <= width) & (way[:, 2:] <= low + slack)).any(axis=0)

    sure = found(WIDTH - 2e-5, -2e-5) == found(WIDTH + 2e-5, 2e-5)
    return found(WIDTH, 0.0), sure


def test_distance_of_segments_is_that_of_their_nearest_points():
    unit = (0.0, 0.0, 1.0, 0.0)
    for other, distance in (
        ((0.5, -1.0, 0.5, 1.0), 0.0),  # they cross
        ((2.0, 1.0, 2.0, -1.0), 1.0),
        ((0.2, 0.3, 0.8, 0.1), 0.1),
        ((0.3, 0.2, 0.3, 0.2), 0.2),  # a point
        ((0.4, 0.0, 3.0, 0.0), 0.0),  # on one line
    ):
        assert_allclose(segment_distance(*unit, *other), distance, atol=ROUND_OFF)
        assert_allclose(segment_distance(*other, *unit), distance, atol=ROUND_OFF)
