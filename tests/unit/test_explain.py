"""Explanations of stacks whose answers are known by hand, as data and as text."""

from __future__ import annotations

from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from tasks import Damping, FramePose, FramePosition, JointLimits, Posture, TorqueLimits
from tests.arms import seven_axis
from tests.catalogue import RawRows
from tests.tolerances import BY_HAND
from wbc import (
    Controller,
    DampedInverse,
    Explanation,
    NullSpace,
    StaleError,
    UnknownName,
    WeightedQP,
    resolve,
)
from wbc.explain.findings import OPTIMAL

N = 7
HOME = seven_axis().q_home
INF = np.inf
UP = np.array([0.0, 0.0, 1.0])


def row(*coefficients: float) -> np.ndarray:
    """One row on the first joints, zero on the others."""
    return np.pad(coefficients, (0, N - len(coefficients)))[None]


def at_most(bound: float, *on: float, name: str = "cap") -> RawRows:
    return RawRows(name, row(*(on or (1.0,))), [-INF], [bound])


def at_least(bound: float, *on: float, name: str = "floor") -> RawRows:
    return RawRows(name, row(*(on or (1.0,))), [bound], [INF])


def want(target: float, *on: float, name: str = "goal") -> RawRows:
    return RawRows(name, row(*(on or (1.0,))), [target])


def explained(hierarchy, resolver=None, q=HOME) -> Explanation:
    return resolve(seven_axis().state(q), hierarchy, resolver).explain()


def only(explanation: Explanation, name: str = "goal"):
    (blocker,) = explanation.blocked(name)
    return blocker


# --------------------------------------------------------------- blocked by bounds


def test_a_bound_of_one_under_a_target_of_three_costs_two_per_unit():
    explanation = explained(at_most(1.0) >> want(3.0))
    goal, blocker = explanation.task("goal"), only(explanation)
    assert (goal.met, goal.reasons) == (False, ("bounds",))
    assert goal.missing == pytest.approx([2.0])
    assert goal.wanted == pytest.approx([3.0])
    assert (blocker.level, blocker.task, blocker.row) == (1, "cap", "cap 0")
    assert (blocker.side, blocker.towards, blocker.held_for) == ("upper", 1, 0)
    assert blocker.price == pytest.approx(2.0, abs=BY_HAND)
    assert blocker.relief == pytest.approx(1.0, abs=BY_HAND)


def test_its_table_says_so():
    assert str(explained(at_most(1.0) >> want(3.0))).splitlines() == [
        "level  task  met  error  gets                   blocked by (relief)",
        "1      cap   yes",
        "2      goal  NO          goal 0 1 instead of 3  "
        "1 cap/cap 0 at upper (1 per unit)",
        "",
        "why",
        "  goal: active bounds above leave no more",
        "",
        "bounds in force, and who pays per unit",
        "  1 cap/cap 0 at upper: level 2 pays 2 per unit",
    ]


def test_a_lower_bound_is_relieved_downwards():
    blocker = only(explained(at_least(1.0) >> want(-1.0)))
    assert (blocker.side, blocker.towards) == ("lower", -1)
    assert blocker.price == pytest.approx(2.0, abs=BY_HAND)


def test_the_longer_the_row_the_more_a_unit_of_its_bound_is_worth():
    # 4 x <= 4: x = 1, and a unit more allows only a quarter
    blocker = only(explained(at_most(4.0, 4.0) >> want(3.0)))
    assert blocker.relief == pytest.approx(0.25, abs=BY_HAND)
    assert blocker.price == pytest.approx(0.5, abs=BY_HAND)


def test_weights_scale_the_price_of_a_level_but_not_what_its_task_gains():
    # 1/2 (3 * 2)^2 falls by 9 * 2 a unit; the weight of the bound does not matter
    blocker = only(explained(5.0 * at_most(1.0) >> 3.0 * want(3.0)))
    assert blocker.relief == pytest.approx(1.0, abs=BY_HAND)
    assert blocker.price == pytest.approx(18.0, abs=BY_HAND)


def test_two_bounds_share_the_blame():
    caps = at_most(1.0, name="one") + at_most(2.0, 0.0, 1.0, name="two")
    explanation = explained(caps >> want(10.0, 1.0, 1.0))
    blockers = {b.task: b for b in explanation.blocked("goal")}
    assert blockers.keys() == {"one", "two"}
    for blocker in blockers.values():
        assert blocker.price == pytest.approx(7.0, abs=BY_HAND)
        assert blocker.relief == pytest.approx(1.0, abs=BY_HAND)


def test_blockers_come_from_every_level_above():
    stack = at_most(1.0, name="one") >> at_most(2.0, 0.0, 1.0, name="two")
    explanation = explained(stack >> want(10.0, 1.0, 1.0))
    assert {b.level for b in explanation.blocked("goal")} == {1, 2}


def test_bounds_away_from_the_point_block_nothing():
    caps = at_most(1.0, name="near") + at_most(50.0, name="far")
    assert only(explained(caps >> want(3.0))).task == "near"


def test_a_bound_below_a_task_is_never_to_blame():
    stack = at_most(1.0) >> want(3.0) >> at_most(1.0, name="late")
    explanation = explained(stack)
    assert only(explanation).task == "cap"
    assert explanation.task("goal").unique


def test_bounds_that_exclude_each_other_block_as_what_cannot_be_met():
    # x <= 1 and x >= 2 settle at 1.5, and share every move
    explanation = explained(at_most(1.0) + at_least(2.0) >> want(3.0))
    assert explanation.task("goal").reasons == ("bounds",)
    for blocker in explanation.blocked("goal"):
        assert (blocker.side, blocker.towards) == ("cannot be met itself", 1)
        assert blocker.relief == pytest.approx(0.5, abs=BY_HAND)
    assert explanation.task("cap").reasons == ("conflict",)
    assert "1 cap/cap 0, which cannot be met itself (0.5 per unit)" in str(explanation)


def test_bounds_that_say_the_same_are_not_called_the_only_answer():
    twice = at_most(1.0, name="one") + at_most(2.0, 2.0, name="two")
    goal = explained(twice >> want(3.0)).task("goal")
    assert not goal.unique
    assert "other prices are possible" in goal.why
    assert explained(at_most(1.0) >> want(3.0)).task("goal").unique


# --------------------------------------------------- blocked by tasks, or by neighbours


def test_a_target_above_blocks_like_a_bound_with_two_sides():
    explanation = explained(want(1.0, name="first") >> want(3.0))
    blocker = only(explanation)
    assert explanation.task("goal").reasons == ("tasks",)
    assert (blocker.side, blocker.towards) == ("equality", 1)
    assert blocker.price == pytest.approx(2.0, abs=BY_HAND)
    below = only(explained(want(1.0, name="first") >> want(-1.0)))
    assert (below.towards, below.price) == (-1, pytest.approx(2.0, abs=BY_HAND))


def test_what_a_task_above_gave_up_cannot_block():
    # the second target lost against the first: moving it changes nothing
    stack = want(1.0, name="first") >> want(3.0, name="second") >> want(5.0)
    assert only(explained(stack)).task == "first"


def test_a_bound_that_a_task_above_presses_is_blamed_on_that_task():
    # x <= 1, then x = 3 presses it there, then x = 0 would rather have it lower
    explanation = explained(at_most(1.0) >> want(3.0, name="press") >> want(0.0))
    blocker = only(explanation)
    assert (blocker.task, blocker.side, blocker.held_for) == ("cap", "upper", 2)
    assert blocker.towards == -1
    assert explanation.task("goal").reasons == ("tasks",)
    assert "1 cap/cap 0 held at upper by level 2 (1 per unit)" in str(explanation)


def test_a_conflict_within_a_level_is_each_others_fault():
    # x = 1 and x = 3 meet at 2: half of every move is shared
    explanation = explained(want(1.0, name="low") + want(3.0, name="high"))
    low, high = only(explanation, "low"), only(explanation, "high")
    assert explanation.task("low").reasons == ("conflict",)
    assert (low.task, low.towards, high.task, high.towards) == ("high", -1, "low", 1)
    for blocker in (low, high):
        assert blocker.relief == pytest.approx(0.5, abs=BY_HAND)
        assert blocker.price == pytest.approx(1.0, abs=BY_HAND)


def test_a_neighbour_that_presses_a_bound_is_a_conflict():
    # x <= 1, and 3 (x = 9) + (x = 0): the heavy neighbour holds x at 1
    level = want(0.0) + 3.0 * want(9.0, name="heavy")
    explanation = explained(at_most(1.0) >> level)
    assert explanation.task("goal").reasons == ("conflict",)
    assert only(explanation).held_for == 2
    assert only(explanation).price < 0.0
    assert explanation.task("heavy").reasons == ("bounds",)


def test_a_task_that_shares_its_level_has_blockers_of_its_own():
    caps = at_most(1.0, name="one") + at_most(2.0, 0.0, 1.0, name="two")
    level = want(5.0, name="x") + want(5.0, 0.0, 1.0, name="y")
    explanation = explained(caps >> level)
    assert only(explanation, "x").task == "one"
    assert only(explanation, "x").price == pytest.approx(4.0, abs=BY_HAND)
    assert only(explanation, "y").task == "two"
    assert only(explanation, "y").price == pytest.approx(3.0, abs=BY_HAND)


def test_several_reasons_are_all_told():
    stack = at_most(1.0) + want(1.0, 0.0, 1.0, name="hold")
    explanation = explained(stack >> want(9.0, 1.0, 1.0))
    assert explanation.task("goal").reasons == ("bounds", "tasks")
    assert "no more; tasks of higher levels" in explanation.task("goal").why


# ------------------------------------------------------------------ directions lost


def test_a_stretched_arm_is_blocked_by_nothing_but_itself():
    robot = seven_axis()
    q = np.zeros(N)
    p = robot.state(q).frame("tip").p
    reach = FramePosition("tip", p + 0.2 * UP, stiffness=100.0)
    explanation = explained(TorqueLimits() >> reach >> Posture(), q=q)
    task = explanation.task("tip position")
    assert not task.met
    assert (task.reasons, task.blockers) == (("lost",), ())
    assert task.missing == pytest.approx([0.0, 0.0, 20.0], abs=BY_HAND)
    assert task.lost == pytest.approx(20.0)
    assert "the robot itself cannot move that way here" in str(explanation)
    assert "NO   0.2 m     z 0 instead of 20 m/s^2" in str(explanation)


def test_a_task_that_contradicts_itself_is_lost_to_no_one_else():
    rows = np.vstack([row(1.0), row(1.0)])
    task = explained(RawRows("goal", rows, [1.0, 3.0])).task("goal")
    assert task.reasons == ("lost",)
    assert task.lost == pytest.approx(np.sqrt(2.0))


def test_a_loss_and_a_bound_are_told_apart():
    rows = np.vstack([row(1.0), row(0.0)])
    task = explained(at_most(1.0) >> RawRows("goal", rows, [3.0, 7.0])).task("goal")
    assert task.reasons == ("bounds", "lost")
    assert task.lost == pytest.approx(7.0)


# --------------------------------------------------------------- bounds and payers


def test_where_everything_is_met_the_bounds_in_force_are_still_listed():
    explanation = explained(at_least(1.0) >> want(2.0, 0.0, 1.0))
    (bound,) = explanation.bounds
    assert all(task.met for task in explanation.tasks)
    assert (bound.task, bound.side) == ("floor", "lower")
    assert "every task is met" in str(explanation)
    assert "least norm pays" in str(explanation)


def test_the_least_norm_pays_by_the_inertia_that_a_bound_moves():
    # least 1/2 a^T M a with a_1 >= 1: its slope is 1 / (M^-1)_11
    explanation = explained(at_least(1.0))
    ((level, price),) = explanation.bounds[0].payers
    M = seven_axis().state(HOME).M
    assert level == 2
    assert price == pytest.approx(1.0 / np.linalg.inv(M)[0, 0])


def test_a_bound_that_only_touches_costs_nobody_anything():
    rows = np.eye(N)
    explanation = explained(at_most(1.0) >> RawRows("all", rows, np.ones(N)))
    assert explanation.bounds[0].payers == ()
    assert "nobody, it only touches" in str(explanation)


def test_every_level_that_a_bound_costs_something_pays():
    stack = at_most(1.0) >> want(3.0, 1.0, 1.0, name="sum") >> want(9.0)
    (bound,) = explained(stack).bounds
    assert [level for level, _ in bound.payers] == [3, 4]  # 4: the least norm
    stack = at_most(1.0) >> want(3.0, name="first") >> want(9.0)
    (bound,) = explained(stack).bounds
    assert bound.payers == ((2, pytest.approx(2.0)), (3, pytest.approx(8.0)))


def test_nothing_in_force_is_nothing_listed():
    explanation = explained(at_most(9.0) >> Posture())
    assert explanation.bounds == ()
    assert "bounds" not in str(explanation)


# -------------------------------------------------------------------- units and text


def test_torque_limits_are_priced_per_newton_metre():
    robot = seven_axis()
    goal = Posture(HOME + 3.0, stiffness=900.0)
    explanation = explained(TorqueLimits() >> goal)
    assert explanation.bounds
    assert {bound.unit for bound in explanation.bounds} == {"Nm"}
    assert {b.unit for b in explanation.blocked("posture")} == {"Nm"}
    assert "per Nm" in str(explanation)
    assert explanation.task("torque limits").wanted == pytest.approx(
        resolve(robot.state(HOME), TorqueLimits() >> goal).torque
    )


@pytest.mark.parametrize(
    ("task", "units"),
    [
        (Posture(), ("rad/s^2",) * N),
        (Damping(), ("rad/s^2",) * N),
        (JointLimits(), ("rad/s^2",) * N),
        (TorqueLimits(), ("Nm",) * N),
        (FramePose("tip", [0, 0, 1], np.eye(3)), ("m/s^2",) * 3 + ("rad/s^2",) * 3),
        (want(1.0), ("",)),
    ],
    ids=lambda item: getattr(item, "name", ""),
)
def test_rows_bind_accelerations_or_torques_in_units_of_their_own(task, units):
    (explained_task,) = explained(task).tasks
    assert explained_task.units == units
    assert explained_task.unit == (units[0] if len(set(units)) == 1 else "")


def test_a_unit_that_does_not_divide_the_rows_is_kept_whole():
    task = want(1.0)
    task.unit = "m, rad"
    assert explained(task).task("goal").units == ("m/s^2, rad/s^2",)


def test_the_error_is_told_where_the_task_has_one():
    explanation = explained(JointLimits() >> Posture(HOME + np.eye(1, N)[0]))
    assert explanation.task("posture").error == pytest.approx(1.0)
    assert explanation.task("posture").error_unit == "rad"
    assert explanation.task("joint limits").error is None


def test_the_worst_row_comes_first_and_a_long_list_is_cut_short():
    top = RawRows("top", np.eye(N), np.zeros(N))
    goal = RawRows("goal", np.eye(N), np.arange(1.0, N + 1))
    lines = str(explained(top >> goal)).splitlines()
    assert "goal 6 0 instead of 7" in lines[2]
    assert "goal 5 0 instead of 6" in lines[3]
    assert lines[5].split() == ["and", "4", "more", "and", "4", "more"]
    assert len(explained(top >> goal).blocked("goal")) == N


def test_the_text_is_what_print_and_the_prompt_show():
    explanation = explained(at_most(1.0) >> want(3.0))
    assert str(explanation) == repr(explanation)


def test_data_cannot_be_changed():
    explanation = explained(at_most(1.0) >> want(3.0))
    with pytest.raises(FrozenInstanceError):
        explanation.tasks = ()
    with pytest.raises(FrozenInstanceError):
        only(explanation).price = 0.0


# ----------------------------------------------------------------- other resolvers


def test_a_projection_explains_itself_like_the_quadratic_program():
    stack = at_most(1.0) >> want(3.0) >> Posture()
    assert str(explained(stack, NullSpace())) == str(explained(stack))


def test_an_answer_that_is_not_optimal_is_called_so():
    stack = want(1.0, 1.0, 0.5, name="first") >> want(3.0, 0.5, 1.0)
    goal = explained(stack, NullSpace("uf")).task("goal")
    assert goal.proof > OPTIMAL
    assert goal.reasons[-1] == "resolver"
    assert "not optimal here (residual of its proof" in goal.why
    assert explained(stack).task("goal").met


def test_prices_of_an_answer_that_is_not_optimal_are_called_a_hint():
    goal = RawRows("goal", np.vstack([row(1.0), row(0.5, 1.0)]), [3.0, 3.0])
    explanation = explained(want(1.0, 1.0, 0.5, name="first") >> goal, NullSpace("uf"))
    assert explanation.task("goal").reasons == ("tasks", "resolver")
    assert explanation.task("goal").why.endswith("; take the prices as a hint")


def test_damping_is_no_lost_direction():
    rows = np.vstack([row(1.0), row(0.0, 1e-3)])
    stack = RawRows("goal", rows, [1.0, 1.0]) >> Posture()
    damped = NullSpace(damping=DampedInverse(0.1, 0.05))
    assert explained(stack).task("goal").met
    assert explained(stack, damped).task("goal").reasons == ("resolver",)


def test_soft_priorities_leak_upwards_and_are_called_not_optimal():
    stack = want(1.0, name="first") >> want(3.0)
    explanation = explained(stack, WeightedQP())
    assert explanation.task("first").reasons == ("resolver",)
    assert explained(stack).task("first").met


def test_a_norm_that_is_not_the_kinetic_one_pays_no_price():
    stack = at_least(1.0) >> want(0.0, 0.0, 1.0)
    assert explained(stack).bounds[0].payers != ()
    assert explained(stack, NullSpace("tsid")).bounds[0].payers == ()


# ------------------------------------------------------------------------ refusals


def test_a_task_that_is_not_there_is_refused_with_those_that_are():
    explanation = explained(at_most(1.0) >> want(3.0))
    with pytest.raises(UnknownName, match=r"unknown task 'gaol'.*'goal'"):
        explanation.blocked("gaol")


def test_a_met_task_is_blocked_by_nothing():
    explanation = explained(at_most(1.0) >> want(3.0))
    assert explanation.blocked("cap") == ()
    assert explanation.task("cap").why == ""


def test_a_solution_of_an_earlier_tick_explains_nothing():
    control = Controller(seven_axis(), Posture())
    old = control(HOME, np.zeros(N))
    control(HOME, np.zeros(N))
    with pytest.raises(StaleError, match="a later tick has rewritten"):
        old.explain()


def test_a_fallback_has_nothing_to_explain():
    solution = Controller(seven_axis(), Posture())(HOME * np.nan, np.zeros(N))
    with pytest.raises(StaleError, match="this tick fell back"):
        solution.explain()


def test_an_explanation_outlives_its_tick():
    control = Controller(seven_axis(), at_most(1.0) >> want(3.0) >> Posture())
    explanation = control(HOME, np.zeros(N)).explain()
    before = str(explanation)
    control(HOME + 0.3, np.ones(N))
    assert str(explanation) == before


def test_explaining_leaves_the_solution_as_it_was():
    solution = resolve(seven_axis().state(HOME), JointLimits() >> Posture(HOME + 2.0))
    before = solution.acceleration.copy(), solution.certificate().worst
    solution.explain()
    np.testing.assert_array_equal(solution.acceleration, before[0])
    assert solution.certificate().worst == before[1]
