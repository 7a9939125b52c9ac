"""The certificate accepts optima, found independently, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import lsq_linear, minimize

from tests.arms import seven_axis
from tests.catalogue import (
    RawRows,
    hierarchy_of,
    random_equalities,
    random_inequalities,
    random_state,
)
from tests.tolerances import BRUTE_FORCE, BY_HAND, PROOF_OF_INEQUALITIES, REFUSED
from wbc import HierarchicalQP, NullSpace, WeightedQP, resolve, solve_hierarchy
from wbc.certificate import certify, slack_of

N = 5
PROBLEMS = range(40)

LINE = np.array([[1.0, 1.0]])
FIRST = np.array([[1.0, 0.0]])


def rows(A, lower, upper=None):
    lower = np.array(lower, dtype=float)
    return np.array(A, dtype=float), lower, lower if upper is None else np.array(upper)


def arm_and_levels(seed: int, make):
    rng = np.random.default_rng(seed)
    return random_state(seven_axis(), rng), make(rng, 7)


# ----------------------------------------------------------------------- it refuses


@pytest.mark.parametrize("seed", PROBLEMS)
def test_it_refuses_a_perturbed_optimum(seed):
    rng = np.random.default_rng(seed)
    levels = random_inequalities(rng, N)
    x = solve_hierarchy(levels).x
    assert certify(levels, x).holds(PROOF_OF_INEQUALITIES)
    nudged = x + 1e-3 * rng.normal(size=N)
    assert not certify(levels, nudged).holds(REFUSED)


@pytest.mark.parametrize("seed", PROBLEMS)
def test_it_refuses_the_optimum_of_another_order(seed):
    rng = np.random.default_rng(seed)
    A, b = rng.normal(size=(2, 3, N)), rng.normal(size=(2, 3))
    levels = [rows(A[0], b[0]), rows(A[1], b[1])]
    x = solve_hierarchy(levels[::-1]).x
    assert certify(levels[::-1], x).holds()
    proof = certify(levels, x)
    assert proof.levels[0].residual > REFUSED


def test_it_refuses_a_feasible_point_that_is_not_the_best():
    # within |x1| <= 1 as close to x1 = 3 as possible: 1, not 0.5
    levels = [rows(FIRST, [-1.0], [1.0]), rows(FIRST, [3.0])]
    proof = certify(levels, np.array([0.5, 0.0]))
    assert proof.levels[0].residual == 0.0
    assert proof.levels[1].residual > 0.1


def test_it_refuses_a_point_that_leans_on_the_wrong_side_of_a_bound():
    # at the upper bound x1 = 1 although the target pulls inwards
    levels = [rows(FIRST, [-1.0], [1.0]), rows(FIRST, [0.0])]
    proof = certify(levels, np.array([1.0, 0.0]))
    assert proof.levels[1].residual > 0.1


def test_it_refuses_a_bound_that_is_broken_for_a_lower_target():
    levels = [rows(FIRST, [-1.0], [1.0]), rows(FIRST, [3.0])]
    proof = certify(levels, np.array([3.0, 0.0]))
    assert proof.levels[0].residual > 0.1


def test_it_refuses_a_point_that_is_not_of_least_norm():
    levels = [rows(LINE, [2.0])]
    proof = certify(levels, np.array([2.0, 0.0]))
    assert proof.levels[0].residual == pytest.approx(0.0, abs=BY_HAND)
    assert proof.levels[1].residual > 0.1


def test_it_refuses_a_level_that_was_disturbed_after_it_was_solved():
    levels = [rows(FIRST, [3.0]), rows(LINE, [1.0])]
    x = solve_hierarchy(levels).x
    proof = certify(levels, x, [np.array([0.5]), np.array([0.0])])
    assert proof.levels[0].disturbed == pytest.approx(0.5)
    assert not proof.holds(REFUSED)


def test_it_refuses_soft_priorities_on_conflicting_levels():
    state, levels = arm_and_levels(3, lambda rng, n: random_equalities(rng, n, 4))
    top = rows(np.eye(3, 7), [1.0, 2.0, 3.0])
    clash = rows(np.eye(3, 7), [3.0, 2.0, 1.0])
    hierarchy = hierarchy_of([top, clash, *levels])
    assert resolve(state, hierarchy, HierarchicalQP()).certificate().holds()
    assert not resolve(state, hierarchy, WeightedQP()).certificate().holds(REFUSED)


def test_it_refuses_the_uf_family_on_compatible_tasks():
    rng = np.random.default_rng(0)
    state = random_state(seven_axis(), rng)
    hierarchy = RawRows("a", rng.normal(size=(3, 7)), rng.normal(size=3)) >> RawRows(
        "b", rng.normal(size=(3, 7)), rng.normal(size=3)
    )
    assert resolve(state, hierarchy, NullSpace()).certificate().holds()
    proof = resolve(state, hierarchy, NullSpace(law="uf")).certificate()
    assert proof.levels[0].residual <= REFUSED
    assert proof.levels[1].residual > REFUSED


# ----------------------------------------------------------------------- it accepts


def test_it_accepts_the_optimum_by_hand_with_its_multipliers():
    levels = [rows(FIRST, [-1.0], [1.0]), rows(FIRST, [3.0])]
    proof = certify(levels, np.array([1.0, 0.0]))
    assert proof.holds()
    assert_allclose(proof.levels[1].multipliers[0], [2.0], atol=BY_HAND)


def test_it_accepts_a_level_that_cannot_be_met():
    levels = [rows(FIRST, [3.0]), rows(FIRST, [5.0]), rows(LINE, [4.0])]
    assert certify(levels, np.array([3.0, 1.0])).holds()


def test_its_text_names_the_worst_of_every_level():
    proof = certify([rows(FIRST, [3.0])], np.array([3.0, 0.5]))
    assert "level 1: residual 0.0e+00" in repr(proof)
    assert f"worst {proof.worst:.1e}" in repr(proof)


def test_the_slack_is_the_least_that_closes_the_gap():
    A, lower, upper = rows(np.eye(3), [-1.0, -1.0, -np.inf], [1.0, 1.0, 1.0])
    slack = slack_of(A, np.array([0.0, 2.0, -9.0]), lower, upper)
    assert_allclose(slack, [0.0, -1.0, 0.0])


# ------------------------------------------------- optima that scipy finds by itself


def brute_force(bounds, targets):
    """min |A x - b|^2 where lower <= C x <= upper can be met, by SLSQP."""
    (C, lower, upper), (A, b, _) = bounds, targets
    constraints = {
        "type": "ineq",
        "fun": lambda x: np.concatenate([C @ x - lower, upper - C @ x]),
        "jac": lambda x: np.vstack([C, -C]),
    }
    found = minimize(
        lambda x: 0.5 * np.sum((A @ x - b) ** 2),
        np.zeros(C.shape[1]),
        jac=lambda x: A.T @ (A @ x - b),
        constraints=constraints,
        method="SLSQP",
        options={"ftol": 1e-15, "maxiter": 500},
    )
    return found.x


@pytest.mark.parametrize("seed", PROBLEMS)
def test_bounds_over_a_target_are_what_slsqp_finds(seed):
    rng = np.random.default_rng(seed)
    C, A = rng.normal(size=(6, 3)), rng.normal(size=(4, 3))
    levels = [
        rows(C, -rng.uniform(0.1, 1, 6), rng.uniform(0.1, 1, 6)),
        rows(A, 3 * rng.normal(size=4)),
    ]
    expected = brute_force(*levels)
    assert certify(levels, expected).holds(1e-4)
    assert_allclose(solve_hierarchy(levels).x, expected, rtol=0, atol=BRUTE_FORCE)


@pytest.mark.parametrize("seed", PROBLEMS)
def test_a_box_over_a_target_is_what_lsq_linear_finds(seed):
    rng = np.random.default_rng(seed)
    A, b = rng.normal(size=(5, 3)), 3 * rng.normal(size=5)
    low, high = -rng.uniform(0.1, 1, 3), rng.uniform(0.1, 1, 3)
    expected = lsq_linear(A, b, (low, high), method="bvls", tol=1e-14).x
    levels = [rows(np.eye(3), low, high), rows(A, b)]
    assert_allclose(solve_hierarchy(levels).x, expected, rtol=0, atol=BRUTE_FORCE)
    assert certify(levels, expected).holds(BRUTE_FORCE)


@pytest.mark.parametrize("seed", PROBLEMS)
def test_bounds_that_exclude_each_other_are_missed_by_the_least_squares(seed):
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(6, 2))
    lower = rng.normal(size=6)
    level = rows(A, lower, lower + 0.2)
    found = minimize(
        lambda x: 0.5 * np.sum(slack_of(A, x, level[1], level[2]) ** 2),
        np.zeros(2),
        jac=lambda x: -A.T @ slack_of(A, x, level[1], level[2]),
        method="BFGS",
        options={"gtol": 1e-11},
    )
    result = solve_hierarchy([level])
    assert_allclose(result.x, found.x, rtol=0, atol=BRUTE_FORCE)
