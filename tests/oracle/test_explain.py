"""Every price and relief of an explanation, against re-solved, perturbed stacks.

All quantities are smooth where no bound changes sides, so central differences tell
their slopes; rows that an explanation does not list must have none.
"""

from __future__ import annotations

from functools import cache
from typing import get_args

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tasks import JointLimits
from tests.arms import TIPS, seven_axis, six_axis
from tests.catalogue import RawRows, random_inequalities, random_state
from tests.tolerances import DIFFERENCE, PROOF_OF_EQUALITIES, SAME, STEP
from wbc import (
    Explanation,
    Hierarchy,
    Level,
    NullSpace,
    State,
    allocate_rows,
    resolve,
)
from wbc.explain.data import Reason, Side

SEEDS = range(100)
CLOSE = {"rtol": DIFFERENCE, "atol": DIFFERENCE}


class TorqueRows(RawRows):
    """lower <= A tau <= upper."""

    space = "torque"


class Problem:
    """Levels of weighted tasks on an arm, whose bounds can be moved and re-solved."""

    def __init__(self, state: State, levels: list[list[tuple[RawRows, float]]]) -> None:
        self.state, self.levels = state, levels
        self.tasks = {task.name: task for level in levels for task, _ in level}
        self.weights = {task.name: w for level in levels for task, w in level}

    def solution(self, resolver=None):
        hierarchy = Hierarchy(*(Level(tuple(level)) for level in self.levels))
        return resolve(self.state, hierarchy, resolver)

    def measured(self) -> dict[str | int, float]:
        """|missing| of every task by name; cost of every level by number."""
        solution = self.solution()
        found: dict[str | int, float] = dict.fromkeys(range(1, len(self.levels) + 1), 0)
        for report in solution.reports():
            missing = float(np.linalg.norm(report.residual))
            found[report.name] = missing
            found[report.level] += 0.5 * (self.weights[report.name] * missing) ** 2
        a = solution.acceleration
        found[len(self.levels) + 1] = 0.5 * float(a @ self.state.M @ a)
        return found

    def slopes(self, name: str, i: int, side: str) -> dict[str | int, float]:
        """Central differences of all that is measured by one bound or target."""
        task = self.tasks[name]
        kept = task.lower, task.upper
        ends = []
        for step in (STEP, -STEP):
            task.lower, task.upper = kept[0].copy(), kept[1].copy()
            task.lower[i] += step * (side in ("lower", "equality"))
            task.upper[i] += step * (side in ("upper", "equality"))
            ends.append(self.measured())
        task.lower, task.upper = kept
        return {key: (ends[0][key] - ends[1][key]) / (2 * STEP) for key in ends[0]}


def split(rng, name: str, rows, kind=RawRows) -> list[tuple[RawRows, float]]:
    """One level as one or two tasks of random weights."""
    A, lower, upper = rows
    cut = int(rng.integers(1, lower.size + 1))
    parts = [slice(0, cut), slice(cut, None)][: 1 if cut == lower.size else 2]
    return [
        (kind(f"{name}{'ab'[i]}", A[p], lower[p], upper[p]), rng.uniform(0.5, 2.0))
        for i, p in enumerate(parts)
    ]


def random_problem(seed: int) -> Problem:
    rng = np.random.default_rng(seed)
    state = random_state(seven_axis(), rng)
    levels = random_inequalities(rng, 7)
    return Problem(state, [split(rng, str(k), rows) for k, rows in enumerate(levels)])


def robot_problem(seed: int) -> Problem:
    """Torque and joint limits over a tip that wants far, and a posture."""
    rng = np.random.default_rng(seed)
    robot = six_axis()
    state = random_state(robot, rng)
    n, eye = robot.nv, np.eye(robot.nv)
    room = np.abs(state.h) + rng.uniform(0.02, 0.2, n) * robot.tau_max
    torque = TorqueRows("torque", eye, -room, room)
    limits = allocate_rows(n, n)
    JointLimits().update(state, limits)
    joints = RawRows("joints", eye, limits.lower, limits.upper)
    F = state.frame(TIPS[robot.name])
    tip = RawRows("tip", F.J[:3], 100.0 * rng.normal(size=3))
    posture = RawRows("posture", eye, 20.0 * rng.normal(size=n))
    levels = ((torque, 1.0), (joints, 2.0), (tip, 3.0), (posture, 1.0))
    return Problem(state, [[term] for term in levels])


Slopes = dict[tuple[str, str], dict[str | int, float]]


@cache
def differenced(make, seed: int) -> tuple[Explanation, Slopes]:
    """A stack explained, and its slopes by every (task, row) that could matter."""
    case = make(seed)
    explanation = case.solution().explain()
    found = {
        (name, row): case.slopes(name, i, side)
        for name, row, i, side in sides(case, explanation)
    }
    return explanation, found


def sides(case: Problem, explanation: Explanation):
    """Task, row, its index and its side: equalities, bounds active or broken."""
    active = {(bound.task, bound.row): bound.side for bound in explanation.bounds}
    for told in explanation.tasks:
        task = case.tasks[told.name]
        for i, row in enumerate(told.rows):
            if task.lower[i] == task.upper[i]:
                yield told.name, row, i, "equality"
            elif (told.name, row) in active:
                yield told.name, row, i, active[told.name, row]
            elif told.missing[i] != 0.0:
                yield told.name, row, i, "upper" if told.missing[i] < 0.0 else "lower"


CASES = [(random_problem, seed) for seed in SEEDS]
CASES += [(robot_problem, seed) for seed in range(20)]
every_stack = pytest.mark.parametrize(("make", "seed"), CASES)


@every_stack
def test_moving_a_bound_changes_what_a_task_misses_by_its_relief(make, seed):
    explanation, found = differenced(make, seed)
    for told in explanation.tasks:
        blockers = {(b.task, b.row): b for b in told.blockers}
        for row, slopes in found.items():
            if told.met or row[0] == told.name:
                continue
            blocker = blockers.get(row)
            expected = -blocker.towards * blocker.relief if blocker else 0.0
            assert_allclose(slopes[told.name], expected, **CLOSE)


@every_stack
def test_moving_a_bound_changes_the_cost_of_the_level_by_its_price(make, seed):
    explanation, found = differenced(make, seed)
    for told in explanation.tasks:
        for b in told.blockers:
            slope = found[b.task, b.row][told.level]
            assert_allclose(slope, -b.towards * b.price, **CLOSE)


@every_stack
def test_relaxing_a_bound_helps_those_that_pay_for_it_and_no_others(make, seed):
    explanation, found = differenced(make, seed)
    for bound in explanation.bounds:
        outwards = 1 if bound.side == "upper" else -1
        prices = dict(bound.payers)
        for level in range(1, explanation.levels + 2):
            gain = -outwards * found[bound.task, bound.row][level]
            assert_allclose(max(gain, 0.0), prices.get(level, 0.0), **CLOSE)


@every_stack
def test_what_is_not_met_is_blocked_or_lost(make, seed):
    explanation, _ = differenced(make, seed)
    for told in explanation.tasks:
        assert told.met == (not told.reasons)
        assert told.met or bool(told.blockers) or told.reasons == ("lost",)
        assert "resolver" not in told.reasons


def test_the_stacks_have_blockers_of_every_kind():
    told = [task for make, seed in CASES for task in differenced(make, seed)[0].tasks]
    blockers = [blocker for task in told for blocker in task.blockers]
    assert {b.side for b in blockers} == set(get_args(Side))
    assert {r for task in told for r in task.reasons} == set(get_args(Reason)) - {
        "ramp",
        "resolver",
    }
    assert any(b.held_for for b in blockers)
    assert any(b.price < 0.0 for b in blockers)
    assert any(
        len(told.payers) > 1
        for make, seed in CASES
        for told in differenced(make, seed)[0].bounds
    )


@pytest.mark.parametrize("seed", SEEDS)
def test_on_two_levels_prices_are_the_multipliers_of_the_certificate(seed):
    rng = np.random.default_rng(seed)
    b = rng.normal(size=6)
    caps = RawRows("caps", rng.normal(size=(6, 7)), b, b + rng.exponential(1.0, 6))
    goal = RawRows("goal", rng.normal(size=(5, 7)), 9.0 * rng.normal(size=5))
    solution = resolve(random_state(seven_axis(), rng), caps >> goal)
    multipliers = solution.certificate().levels[1].multipliers[0]
    prices = np.zeros(6)
    for blocker in solution.explain().blocked("goal"):
        prices[int(blocker.row.split()[1])] = blocker.towards * blocker.price
    assert_allclose(prices, multipliers, rtol=SAME, atol=SAME)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_projection_has_the_prices_of_the_quadratic_program(seed):
    case = random_problem(seed)
    answer = case.solution(NullSpace())
    if answer.certificate().worst > PROOF_OF_EQUALITIES:
        return  # it says so itself
    expected, told = case.solution().explain(), answer.explain()
    for one, other in zip(expected.tasks, told.tasks, strict=True):
        assert one.reasons == other.reasons
        prices = [{(b.task, b.row): b.price for b in t.blockers} for t in (one, other)]
        assert prices[0].keys() == prices[1].keys()
        for row, price in prices[0].items():
            assert_allclose(prices[1][row], price, rtol=DIFFERENCE, atol=DIFFERENCE)
