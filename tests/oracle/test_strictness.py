"""The cost of strictness, against hierarchies that a QP backend resolves alone."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.arms import seven_axis
from tests.catalogue import (
    RawRows,
    hierarchy_of,
    random_equalities,
    random_inequalities,
    random_state,
)
from tests.tolerances import BRUTE_FORCE, BY_HAND, SAME
from wbc import (
    Controller,
    HierarchicalQP,
    NullSpace,
    StaleError,
    UnknownName,
    WeightedQP,
    resolve,
    solve_hierarchy,
)

N = 7
SEEDS = range(15)


def row(j: int) -> np.ndarray:
    return np.eye(1, N, j)


@pytest.mark.parametrize("make", [random_equalities, random_inequalities])
def test_every_best_is_that_of_the_level_under_its_uppers(make):
    for seed in SEEDS:
        rng = np.random.default_rng(seed)
        state, levels = random_state(seven_axis(), rng), make(rng, N)
        cost = resolve(state, hierarchy_of(levels)).cost_of_strictness()
        for k, found in enumerate(cost.levels):
            bests = [
                float(
                    np.linalg.norm(
                        solve_hierarchy([*levels[:j], levels[k]], "proxqp").slacks[-1]
                    )
                )
                for j in range(k + 1)
            ]
            close = {"rtol": 0, "atol": BRUTE_FORCE * (1.0 + found.asked)}
            assert_allclose(found.alone, bests[0], **close, err_msg=f"seed {seed}")
            assert_allclose(found.taken, np.diff(bests), **close)
            assert found.got == pytest.approx(found.best, abs=SAME * (1 + found.asked))
            assert found.shortfall == 0.0


@pytest.mark.parametrize("resolver", [NullSpace("uf"), WeightedQP(), HierarchicalQP()])
def test_the_parts_add_up_whatever_the_resolver(resolver):
    short = 0
    for seed in SEEDS:
        rng = np.random.default_rng(100 + seed)
        state, levels = random_state(seven_axis(), rng), random_equalities(rng, N)
        solution = resolve(state, hierarchy_of(levels), resolver)
        for cost in solution.cost_of_strictness().levels:
            whole = cost.alone + sum(cost.taken) + cost.shortfall
            assert cost.got == pytest.approx(whole, abs=SAME * (1.0 + cost.asked))
            assert min((cost.alone, *cost.taken)) >= 0.0
            short += cost.shortfall != 0.0
    assert (short == 0) == isinstance(resolver, HierarchicalQP)


def by_hand():
    top = RawRows("box", np.eye(N), np.full(N, -2.0), np.full(N, 2.0))
    one = RawRows("one", row(0), [1.0])
    two = RawRows("two", np.vstack([row(0), row(1)]), [3.0, 5.0])
    return top >> one >> two >> RawRows("far", row(2), [1.0])


def test_a_case_found_by_hand():
    # alone "two" misses nothing; the box leaves (2, 2) of (3, 5); then "one" pulls to 1
    solution = resolve(seven_axis().state(seven_axis().q_home), by_hand())
    cost = solution.cost_of_strictness().level("two")
    assert (cost.level, cost.alone) == (3, 0.0)
    assert cost.asked == pytest.approx(np.hypot(3.0, 5.0))
    boxed, strict = np.hypot(1.0, 3.0), np.hypot(2.0, 3.0)
    assert_allclose(cost.taken, [boxed, strict - boxed], atol=BY_HAND)
    assert cost.got == pytest.approx(strict)


def test_what_is_free_costs_nothing():
    solution = resolve(seven_axis().state(seven_axis().q_home), by_hand())
    cost = solution.cost_of_strictness().level("far")
    assert (cost.alone, cost.got, cost.shortfall) == (0.0, 0.0, 0.0)
    assert cost.taken == (0.0, 0.0, 0.0)


def test_the_table_names_who_took_how_much():
    solution = resolve(seven_axis().state(seven_axis().q_home), by_hand())
    lines = repr(solution.cost_of_strictness()).splitlines()
    assert len(lines) == 2 + 4
    assert "level 1 (box): 3.16; level 2 (one): 0.443" in lines[4]
    assert lines[5].endswith("-")


def test_a_task_that_is_not_there_is_refused():
    solution = resolve(seven_axis().state(seven_axis().q_home), by_hand())
    with pytest.raises(UnknownName, match=r"unknown task 'too'.*two"):
        solution.cost_of_strictness().level("too")


def test_weighted_tasks_share_a_level_and_have_no_unit():
    level = 2.0 * RawRows("a", row(0), [1.0]) + RawRows("b", row(0), [3.0])
    solution = resolve(seven_axis().state(seven_axis().q_home), level)
    cost = solution.cost_of_strictness().levels[0]
    assert (cost.name, cost.unit) == ("a + b", "weighted")
    # min (2 (x - 1))^2 + (x - 3)^2 at x = 7 / 5
    assert cost.alone == pytest.approx(np.hypot(0.8, 1.6))


def test_it_is_asked_before_the_next_tick():
    arm = seven_axis()
    control = Controller(arm, by_hand())
    old = control(arm.q_home, np.zeros(N))
    control(arm.q_home, np.zeros(N))
    with pytest.raises(StaleError):
        old.cost_of_strictness()
