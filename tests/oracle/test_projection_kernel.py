"""The compiled projection against its textbook form by singular value decomposition."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.catalogue import Levels, random_equalities, random_inequalities
from tests.tolerances import AGREEMENT, ROUND_OFF, SAME
from wbc import DampedInverse
from wbc.lexicographic import Lexicographic
from wbc.linalg import RANK_TOLERANCE, Factor, factorise, norm
from wbc.projection import Projection

INF = np.inf
SEEDS = range(60)
SIZES = (1, 3, 7, 14, 30)
DAMPED = DampedInverse(threshold=0.3, factor=0.2)
LAWS = {
    "exact": (None, False),
    "damped": (DAMPED, False),
    "alone": (None, True),
    "alone, damped": (DAMPED, True),
}
laws = pytest.mark.parametrize(("damping", "alone"), LAWS.values(), ids=LAWS)


def damped_answer(damping, factor: Factor, b, scale: float, rest) -> np.ndarray:
    """Minimiser z of |A z - b|^2 + lambda^2 |z - rest|^2 in the row space of A."""
    if damping is None:
        return factor.solve(b)
    s = factor.sigma / scale
    square = np.maximum(1.0 - (s / damping.threshold) ** 2, 0.0) * damping.factor**2
    wanted = s / scale * (factor.U.T @ b)
    return factor.V1 @ ((wanted + square * (factor.V1.T @ rest)) / (s * s + square))


def blocks_of(levels: Levels, side: np.ndarray) -> Iterator[tuple]:
    """(level, whether it holds bounds, rows, targets): held bounds, then equalities."""
    first = 0
    for k, (A, lower, upper) in enumerate(levels):
        sides = side[first : first + lower.size]
        first += lower.size
        for held, rows in ((True, sides != 0), (False, lower == upper)):
            if rows.any():
                yield k, held, A[rows], np.where(sides > 0, upper, lower)[rows]


def textbook(levels: Levels, side, rest, damping, alone) -> tuple[np.ndarray, list]:
    """Y <- y + Z (J Z)^+ (b - J y), Z <- Z null(J Z), and the ranks."""
    n = levels[0][0].shape[1]
    y, Z, ranks = np.zeros(n), np.eye(n), [0] * len(levels)
    for k, held, J, b in blocks_of(levels, side):
        scale = norm(J)
        factor = factorise(J @ Z, scale)
        if held:
            y = y + Z @ factor.solve(b - J @ y)
        elif alone:
            answer = damped_answer(damping, factorise(J, scale), b, scale, rest)
            y = y + Z @ (Z.T @ answer)
        else:
            toward = Z.T @ (rest - y)
            y = y + Z @ damped_answer(damping, factor, b - J @ y, scale, toward)
        Z = Z @ factor.V2
        ranks[k] += factor.rank
    return y, ranks


def stacked(levels: Levels) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    A, lower, upper = (np.concatenate(arrays) for arrays in zip(*levels, strict=True))
    return A, lower, upper


def projection_of(levels: Levels, damping=None, alone=False) -> Projection:
    sizes = [lower.size for _, lower, _ in levels]
    return Projection(sizes, levels[0][0].shape[1], damping, alone)


def scaled(levels: Levels, rng: np.random.Generator) -> Levels:
    """Every level by a factor of its own, over twelve orders of magnitude."""
    factors = 10.0 ** rng.uniform(-6, 6, len(levels))
    return [(f * A, f * b, f * c) for f, (A, b, c) in zip(factors, levels, strict=True)]


@laws
@pytest.mark.parametrize("n", SIZES)
def test_equalities_are_projected_as_in_the_textbook(n, damping, alone):
    # levels that are singular, have rows of zeros, repeat others or contradict them
    for seed in SEEDS:
        rng = np.random.default_rng(seed)
        levels = scaled(random_equalities(rng, n), rng)
        rest, nothing = rng.normal(size=n), np.zeros(sum(b.size for _, b, _ in levels))
        projection = projection_of(levels, damping, alone)
        assert projection.solve(*stacked(levels), rest)
        y, ranks = textbook(levels, nothing, rest, damping, alone)
        size = 1.0 + np.abs(y).max()
        assert_allclose(
            projection.y, y, rtol=0, atol=AGREEMENT * size, err_msg=f"{seed}"
        )
        assert projection.ranks.tolist() == ranks, f"seed {seed}"


@laws
def test_whatever_bounds_it_holds_come_first_and_exactly(damping, alone):
    held = 0
    for seed in SEEDS:
        rng = np.random.default_rng(1000 + seed)
        levels = scaled(random_inequalities(rng, 7), rng)
        rest = rng.normal(size=7)
        projection = projection_of(levels, damping, alone)
        if not projection.solve(*stacked(levels), rest):
            continue
        held += np.count_nonzero(projection.side)
        y, ranks = textbook(levels, projection.side, rest, damping, alone)
        size = 1.0 + np.abs(y).max()
        assert_allclose(
            projection.y, y, rtol=0, atol=AGREEMENT * size, err_msg=f"{seed}"
        )
        assert projection.ranks.tolist() == ranks, f"seed {seed}"
    assert held > len(SEEDS)


def graded_equalities(rng: np.random.Generator, n: int) -> Levels:
    """Levels whose rows differ by eight orders of magnitude, some hardly at all."""
    levels: Levels = []
    for m in (max(n // 2, 1), max(n // 3, 1), n):
        A = rng.normal(size=(m, n)) * 10.0 ** rng.uniform(-4, 4, (m, 1))
        A[-1] = A[0] * (1.0 + 1e-6 * rng.normal(size=n))
        levels.append((A, np.ones(m), np.ones(m)))
    return levels


@pytest.mark.parametrize("make", [random_equalities, graded_equalities])
@pytest.mark.parametrize("n", SIZES)
def test_the_directions_stay_orthonormal_and_reach_no_level_above_them(n, make):
    for seed in SEEDS:
        rng = np.random.default_rng(2000 + seed)
        levels = make(rng, n)
        projection = projection_of(levels)
        projection.solve(*stacked(levels), np.zeros(n))
        Z = projection.directions
        assert_allclose(Z @ Z.T, np.eye(n), rtol=0, atol=ROUND_OFF)
        taken = 0
        for (A, _, _), rank in zip(levels, projection.ranks, strict=True):
            taken += rank
            leak = np.abs(A @ Z[taken:].T).max(initial=0.0)
            lost = RANK_TOLERANCE if make is graded_equalities else ROUND_OFF
            assert leak <= lost * norm(A), f"seed {seed}"


def test_the_scale_of_a_level_decides_nothing():
    for seed in SEEDS:
        rng = np.random.default_rng(3000 + seed)
        levels, rest = random_inequalities(rng, 7), np.zeros(7)
        plain, other = projection_of(levels), projection_of(levels)
        settled = plain.solve(*stacked(levels), rest)
        assert other.solve(*stacked(scaled(levels, rng)), rest) == settled
        if settled:
            assert other.side.tolist() == plain.side.tolist(), f"seed {seed}"
            assert_allclose(other.y, plain.y, atol=SAME * (1.0 + np.abs(plain.y).max()))


def test_a_box_over_tasks_is_resolved_as_by_the_hierarchical_qp():
    held = 0
    for seed in SEEDS:
        rng = np.random.default_rng(4000 + seed)
        box = (np.eye(7), -rng.uniform(1, 4, 7), rng.uniform(1, 4, 7))
        levels = [box, *random_equalities(rng, 7)]
        sizes, rows = [b.size for _, b, _ in levels], stacked(levels)
        strict, projection = Lexicographic(sizes, 7), projection_of(levels)
        assert strict.solve(*rows)
        if projection.solve(*rows, np.zeros(7)):
            held += np.count_nonzero(projection.side)
            assert_allclose(
                projection.y, strict.x, rtol=0, atol=1e-7, err_msg=f"{seed}"
            )
    assert held > len(SEEDS)


def test_a_bound_that_tasks_no_longer_push_against_is_let_go():
    e = np.eye(1, 3)
    levels = [(e, -np.ones(1), np.ones(1)), (e, 3 * np.ones(1), 3 * np.ones(1))]
    projection, rest = projection_of(levels), np.zeros(3)
    A, lower, upper = stacked(levels)
    assert projection.solve(A, lower, upper, rest)
    assert projection.side.tolist() == [1, 0]
    assert projection.y[0] == pytest.approx(1.0)
    lower[1] = upper[1] = 0.5
    assert projection.solve(A, lower, upper, rest)
    assert projection.side.tolist() == [0, 0]
    assert projection.y[0] == pytest.approx(0.5)


def test_what_must_be_kept_is_not_let_go():
    e = np.eye(1, 3)
    levels = [(e, -np.ones(1), np.ones(1)), (e, 0.5 * np.ones(1), 0.5 * np.ones(1))]
    projection, rest = projection_of(levels), np.zeros(3)
    projection.side[0] = 1
    assert projection.keep(*stacked(levels), rest)
    assert projection.y[0] == pytest.approx(1.0)
    assert projection.solve(*stacked(levels), rest)
    assert projection.y[0] == pytest.approx(0.5)


def test_a_bound_that_becomes_an_equality_is_one():
    levels = [(np.eye(2), np.array([-1.0, 2.0]), np.array([1.0, INF]))]
    projection, rest = projection_of(levels), np.zeros(2)
    A, lower, upper = stacked(levels)
    assert projection.solve(A, lower, upper, rest)
    assert projection.side.tolist() == [0, -1]
    upper[1] = 2.0
    assert projection.solve(A, lower, upper, rest)
    assert projection.side.tolist() == [0, 0]
    assert_allclose(projection.y, [0.0, 2.0], atol=ROUND_OFF)


def test_without_rows_nothing_moves():
    projection = Projection([0], 3)
    none = np.zeros(0)
    assert projection.solve(np.zeros((0, 3)), none, none, np.zeros(3))
    assert projection.y.tolist() == [0.0, 0.0, 0.0]
    assert projection.ranks.tolist() == [0]


def test_bounds_that_exclude_each_other_meet_half_way():
    A = np.array([[1.0, 0.0], [1.0, 0.0]])
    projection = Projection([2], 2)
    lower, upper = np.array([2.0, -INF]), np.array([INF, 1.0])
    assert projection.solve(A, lower, upper, np.zeros(2))
    assert projection.side.tolist() == [-1, 1]
    assert_allclose(projection.y, [1.5, 0.0], atol=ROUND_OFF)


def test_a_row_of_zeros_that_cannot_be_met_stops_nothing():
    levels = [(np.zeros((1, 2)), np.ones(1), np.full(1, INF))]
    levels.append((np.eye(2), np.ones(2), np.ones(2)))
    projection = projection_of(levels)
    assert projection.solve(*stacked(levels), np.zeros(2))
    assert projection.ranks.tolist() == [0, 2]
    assert_allclose(projection.y, [1.0, 1.0], atol=ROUND_OFF)
