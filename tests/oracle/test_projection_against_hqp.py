"""Projection against strict hierarchical QP, both against their certificate."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.arms import seven_axis
from tests.catalogue import (
    hierarchy_of,
    random_equalities,
    random_inequalities,
    random_state,
)
from tests.tolerances import (
    AGREEMENT,
    BY_HAND,
    PROOF_OF_EQUALITIES,
    PROOF_OF_INEQUALITIES,
)
from wbc import (
    HierarchicalQP,
    InputError,
    NullSpace,
    Status,
    UnknownName,
    backends,
    resolve,
    solve_hierarchy,
)
from wbc.linalg import factorise

STACKS = 500
PLAIN = 60
N = 7
INF = np.inf


def equality_problems():
    """(seed, state of the seven-axis arm, levels)."""
    for seed in range(STACKS):
        rng = np.random.default_rng(seed)
        yield seed, random_state(seven_axis(), rng), random_equalities(rng, N)


def test_projection_and_hqp_agree_on_random_equality_stacks():
    worst = (0.0, -1)
    for seed, state, levels in equality_problems():
        hierarchy = hierarchy_of(levels)
        projected = resolve(state, hierarchy, NullSpace()).acceleration
        strict = resolve(state, hierarchy, HierarchicalQP()).acceleration
        gap = np.linalg.norm(projected - strict) / max(1.0, np.linalg.norm(strict))
        worst = max(worst, (float(gap), seed))
    assert worst[0] <= AGREEMENT, f"seed {worst[1]}: {worst[0]:.1e} relative"


@pytest.mark.parametrize("resolver", [NullSpace(), HierarchicalQP()], ids=["ns", "hqp"])
def test_the_certificate_holds_on_random_equality_stacks(resolver):
    worst = (0.0, -1)
    for seed, state, levels in equality_problems():
        solution = resolve(state, hierarchy_of(levels), resolver)
        assert solution.status is Status.SOLVED, f"seed {seed}"
        worst = max(worst, (solution.certificate().worst, seed))
    assert worst[0] <= PROOF_OF_EQUALITIES, f"seed {worst[1]}: {worst[0]:.1e}"


def test_the_certificate_holds_with_inequalities_at_every_level():
    worst = (0.0, -1)
    for seed in range(STACKS):
        rng = np.random.default_rng(10_000 + seed)
        state, levels = random_state(seven_axis(), rng), random_inequalities(rng, N)
        solution = resolve(state, hierarchy_of(levels), HierarchicalQP())
        worst = max(worst, (solution.certificate().worst, seed))
    assert worst[0] <= PROOF_OF_INEQUALITIES, f"seed {worst[1]}: {worst[0]:.1e}"


def test_the_random_stacks_contain_singular_and_conflicting_levels():
    singular = conflicting = inactive = 0
    for _, state, levels in equality_problems():
        solution = resolve(state, hierarchy_of(levels), HierarchicalQP())
        for k, (A, lower, _) in enumerate(levels):
            missed = A @ solution.acceleration - lower
            full = np.linalg.matrix_rank(A) == min(A.shape)
            singular += not full
            conflicting += full and np.linalg.norm(missed) > 1e-3
            inactive += solution.ranks[k] == 0
    assert min(singular, conflicting, inactive) > STACKS // 10


@pytest.mark.parametrize("backend", backends())
def test_every_backend_is_certified_on_plain_equalities(backend):
    for seed in range(PLAIN):
        levels = random_equalities(np.random.default_rng(20_000 + seed), N)
        worst = solve_hierarchy(levels, backend).certificate().worst
        assert worst <= PROOF_OF_EQUALITIES, f"seed {seed}"


@pytest.mark.parametrize("backend", backends())
def test_every_backend_is_certified_on_plain_inequalities(backend):
    for seed in range(PLAIN):
        levels = random_inequalities(np.random.default_rng(30_000 + seed), N)
        worst = solve_hierarchy(levels, backend).certificate().worst
        assert worst <= PROOF_OF_INEQUALITIES, f"seed {seed}"


@pytest.mark.parametrize("backend", backends())
def test_all_backends_give_the_same_point(backend):
    for seed in range(PLAIN):
        levels = random_inequalities(np.random.default_rng(40_000 + seed), N)
        x = solve_hierarchy(levels, backend).x
        reference = solve_hierarchy(levels, backends()[0]).x
        size = max(1.0, float(np.abs(reference).max()))
        assert_allclose(x, reference, rtol=0, atol=1e-7 * size, err_msg=f"{seed}")


def test_plain_equalities_are_the_textbook_recursion():
    for seed in range(PLAIN):
        levels = random_equalities(np.random.default_rng(50_000 + seed), N)
        x, P = np.zeros(N), np.eye(N)
        for A, b, _ in levels:
            factor = factorise(A @ P, float(np.linalg.norm(A)) or 1.0)
            inverse = factor.V1 @ (factor.U / factor.sigma).T
            x = x + inverse @ (b - A @ x)
            P = P - inverse @ (A @ P)
        found = solve_hierarchy(levels).x
        assert_allclose(found, x, rtol=0, atol=AGREEMENT * (1 + np.abs(x).max()))


# ------------------------------------------------------------- optima found by hand


def point(levels, backend) -> list[float]:
    result = solve_hierarchy(levels, backend)
    assert result.status is Status.SOLVED
    assert result.certificate().holds()
    return result.x.tolist()


@pytest.mark.parametrize("backend", backends())
def test_rows_of_a_level_keep_the_metric_that_was_given(backend):
    # min x1^2 + (10 x1 - 10)^2: a solver that normalises rows would say 0.5
    x = point([([[1, 0], [10, 0]], [0, 10], [0, 10])], backend)
    assert_allclose(x, [100 / 101, 0.0], atol=BY_HAND)


@pytest.mark.parametrize("backend", backends())
def test_a_zero_row_that_cannot_be_met_keeps_its_whole_slack(backend):
    levels = [([[0.0, 0.0]], [1.0], [1.0]), ([[1.0, 1.0]], [2.0], [2.0])]
    result = solve_hierarchy(levels, backend)
    assert_allclose(result.slacks[0], [1.0], atol=BY_HAND)
    assert_allclose(result.x, [1.0, 1.0], atol=BY_HAND)
    assert result.ranks == (0, 1)


@pytest.mark.parametrize("backend", backends())
def test_a_bound_stops_the_target_below_it(backend):
    levels = [([[1.0]], [-1.0], [1.0]), ([[1.0]], [3.0], [3.0])]
    result = solve_hierarchy(levels, backend)
    assert_allclose(result.x, [1.0], atol=BY_HAND)
    assert_allclose(result.slacks[1], [2.0], atol=BY_HAND)
    assert [a.tolist() for a in result.active] == [[True], [True]]


@pytest.mark.parametrize("backend", backends())
def test_the_multiplier_of_a_bound_is_its_price(backend):
    # d/db of 1/2 (3 - b)^2 = -(3 - b) at the upper bound b = 1
    levels = [([[2.0]], [-2.0], [2.0]), ([[1.0]], [3.0], [3.0])]
    result = solve_hierarchy(levels, backend)
    assert_allclose(result.multipliers[1][0], [1.0], atol=BY_HAND)


@pytest.mark.parametrize("backend", backends())
def test_an_upper_target_wins_over_a_lower_bound(backend):
    x = point([([[1.0]], [3.0], [3.0]), ([[1.0]], [-1.0], [1.0])], backend)
    assert_allclose(x, [3.0], atol=BY_HAND)


@pytest.mark.parametrize("backend", backends())
def test_two_bounds_of_one_level_that_exclude_each_other_meet_half_way(backend):
    x = point([([[1.0], [1.0]], [2.0, -INF], [INF, 1.0])], backend)
    assert_allclose(x, [1.5], atol=BY_HAND)


@pytest.mark.parametrize("backend", backends())
def test_a_released_bound_does_not_stick(backend):
    # level 2 alone would stop at x1 = 2, its bound; level 3 pulls back to x1 = 0
    levels = [
        ([[1.0, 1.0]], [2.0], [2.0]),
        ([[1.0, 0.0]], [-INF], [2.0]),
        ([[1.0, 0.0]], [0.0], [0.0]),
    ]
    assert_allclose(point(levels, backend), [0.0, 2.0], atol=BY_HAND)


@pytest.mark.parametrize("backend", backends())
def test_a_row_without_bounds_asks_for_nothing(backend):
    x = point([([[1.0, 0.0]], [-INF], [INF]), ([[1.0, 1.0]], [4.0], [4.0])], backend)
    assert_allclose(x, [2.0, 2.0], atol=BY_HAND)


@pytest.mark.parametrize("backend", backends())
def test_freedom_that_is_left_gives_the_least_norm(backend):
    x = point([([[1.0, 2.0, 2.0]], [9.0], [9.0])], backend)
    assert_allclose(x, [1.0, 2.0, 2.0], atol=BY_HAND)


@pytest.mark.parametrize("backend", backends())
def test_the_least_norm_is_taken_within_the_bounds(backend):
    # x1 + x2 >= 4 and x1 <= 1
    levels = [([[1.0, 1.0], [1.0, 0.0]], [4.0, -INF], [INF, 1.0])]
    assert_allclose(point(levels, backend), [1.0, 3.0], atol=BY_HAND)


# ------------------------------------------------------------------------ bad input


@pytest.mark.parametrize(
    ("levels", "message"),
    [
        ([], "needs at least one level"),
        ([([1.0, 2.0], [0.0], [0.0])], r"level 1: A has shape \(2,\)"),
        (
            [([[1.0, 2.0]], [0.0], [0.0]), ([[1.0]], [0.0], [0.0])],
            r"level 2: A has shape \(1, 1\); it must be \(m, 2\)",
        ),
        ([([[1.0]], [0.0, 1.0], [0.0])], r"level 1: bounds have shapes \(2,\)"),
        ([([[np.nan]], [0.0], [0.0])], "level 1 contains NaN"),
        ([([[np.inf]], [0.0], [0.0])], "an infinite coefficient"),
        ([([[1.0]], [np.nan], [0.0])], "level 1 contains NaN"),
        ([([[1.0], [1.0]], [0.0, 2.0], [0.0, 1.0])], "level 1, row 1: lower bound 2.0"),
        ([([[1.0]], [INF], [INF])], "leave no number between them"),
        ([([[1.0]], [-INF], [-INF])], "leave no number between them"),
    ],
)
def test_matrices_that_cannot_be_meant_are_refused(levels, message):

    with pytest.raises(InputError, match=message):
        solve_hierarchy(levels)


def test_an_unknown_backend_is_refused_with_the_installed_ones():

    with pytest.raises(UnknownName, match=r"unknown QP backend 'proxpq'.*'proxqp'"):
        solve_hierarchy([([[1.0]], [0.0], [0.0])], "proxpq")
