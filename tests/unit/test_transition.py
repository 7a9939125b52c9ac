"""Changes of a hierarchy, and of its tasks, while the robot runs."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tasks import (
    Damping,
    FramePosition,
    JointLimits,
    Line,
    Posture,
    TorqueLimits,
    TorqueRateLimits,
    TravelSpeed,
)
from tests.arms import seven_axis
from tests.catalogue import RawRows
from tests.tolerances import ROUND_OFF, SAME, TORQUE
from wbc import (
    PD,
    Controller,
    Damper,
    HierarchicalQP,
    InputError,
    NullSpace,
    SaturatedPD,
    SolverError,
    State,
    Status,
    Task,
    UnknownName,
    WeightedQP,
)

ARM = seven_axis()
HOME, STILL = ARM.q_home, np.zeros(ARM.nv)
AWAY = HOME + 0.3
OVER = 0.05
FAST = 1e9
TICKS = 50
families = pytest.mark.parametrize(
    "resolver", [HierarchicalQP(), NullSpace()], ids=["hqp", "nullspace"]
)


def held(target=HOME, name: str = "posture") -> Posture:
    return Posture(target, name=name)


def ticks(control: Controller, count: int, q=HOME, v=STILL) -> np.ndarray:
    """Torques (count, n) at a robot that does not move."""
    return np.array([control(q, v).torque for _ in range(count)])


# ---------------------------------------------------------------------- the hand-over


@families
def test_the_torque_goes_smoothly_from_one_hierarchy_to_the_other(resolver):
    control = Controller(ARM, TorqueLimits() >> held(), resolver)
    before = ticks(control, 1)[0]
    control.change(TorqueLimits() >> held(AWAY), OVER, rate=FAST)
    assert control.changing
    way = ticks(control, TICKS)
    assert not control.changing
    target = Controller(ARM, TorqueLimits() >> held(AWAY), resolver)
    after = ticks(target, 1)[0]
    assert_allclose(way[-1], after, rtol=0, atol=SAME * np.abs(after).max())
    steps = np.abs(np.diff(np.vstack([before, way]), axis=0)).max(axis=0)
    whole = np.abs(after - before)
    assert (steps <= 1.9 * whole / TICKS + TORQUE).all(), "the steepest of a quintic"
    share = np.linalg.norm(way - before, axis=1) / np.linalg.norm(after - before)
    assert (np.diff(share) >= -ROUND_OFF).all()


@families
def test_the_change_takes_longer_where_it_would_be_too_fast(resolver):
    control = Controller(ARM, held(), resolver)
    before = ticks(control, 1)
    control.change(held(AWAY), OVER, rate=100.0)
    way = [before]
    while control.changing:
        way.append(ticks(control, 1))
        assert len(way) < 2000
    rates = np.abs(np.diff(np.vstack(way), axis=0)) / control.dt
    assert len(way) > 2 * TICKS
    assert 50.0 < rates.max() <= 100.0 * (1.0 + TORQUE)


def test_changes_under_way_share_the_rate():
    control = Controller(ARM, held())
    way = [ticks(control, 1)]
    for target in (AWAY, HOME - 0.3, AWAY):
        control.change(held(target), OVER, rate=100.0)
        way.append(ticks(control, 10))
    way.append(ticks(control, 2000))
    rates = np.abs(np.diff(np.vstack(way), axis=0)) / control.dt
    assert rates.max() <= 100.0 * (1.0 + TORQUE)
    assert not control.changing


@families
def test_without_a_ramp_it_jumps_at_once(resolver):
    control = Controller(ARM, held(), resolver)
    control(HOME, STILL)
    control.change(held(AWAY), over=0.0)
    torque = ticks(control, 1)[0]
    assert_allclose(torque, ticks(Controller(ARM, held(AWAY), resolver), 1)[0])
    assert not control.changing


def test_the_solution_tells_how_far_the_change_is():
    control = Controller(ARM, held())
    assert control(HOME, STILL).share == 1.0
    control.change(held(AWAY), OVER, rate=FAST)
    shares = [control(HOME, STILL).share for _ in range(TICKS)]
    assert 0.0 < shares[0] < 1e-3
    assert (np.diff(shares) > 0.0).all()
    assert shares[-1] == 1.0


def test_the_blend_is_consistent_and_reports_on_the_new_tasks():
    control = Controller(ARM, held())
    control.change(held(AWAY, "other"), OVER, rate=FAST)
    for _ in range(TICKS // 2):
        solution = control(HOME, STILL)
    state = ARM.state(HOME)
    expected = state.M @ solution.acceleration + state.h
    assert_allclose(solution.torque, expected, rtol=0, atol=1e-9)
    assert [report.name for report in solution.reports()] == ["other"]
    assert np.linalg.norm(solution.report("other").residual) > 0.1
    assert solution.certificate().worst > 1e-3, "half way it is not optimal yet"


@families
def test_a_change_during_a_change_starts_from_the_blend(resolver):
    control = Controller(ARM, held(), resolver)
    torques = [ticks(control, 2)]
    for target in (AWAY, HOME - 0.2, HOME + 0.1, AWAY):
        control.change(held(target), OVER, rate=FAST)
        torques.append(ticks(control, 13))
    torques.append(ticks(control, TICKS))
    way = np.vstack(torques)
    reach = np.abs(np.diff(way, axis=0)).max()
    widest = max(
        np.abs(ticks(Controller(ARM, held(t), resolver), 1)[0] - way[0]).max()
        for t in (AWAY, HOME - 0.2, HOME + 0.1)
    )
    assert reach <= 4 * 1.9 * 2 * widest / TICKS, "four ramps at once, at most"
    assert_allclose(way[-1], ticks(Controller(ARM, held(AWAY), resolver), 1)[0])


def test_beyond_three_changes_under_way_the_last_one_waits():
    control = Controller(ARM, held())
    for k in range(30):
        control.change(held(HOME + 0.01 * k, f"number {k}"), OVER, rate=FAST)
    for _ in range(2 * TICKS):
        solution = control(HOME, STILL)
    assert not control.changing
    assert [report.name for report in solution.reports()] == ["number 29"]
    assert solution.certificate().holds()


def test_the_resolver_can_change_as_well():
    control = Controller(ARM, held())
    control.change(held(), OVER, NullSpace("tsid"), rate=FAST)
    before = ticks(control, TICKS)
    assert control.resolver.name == "nullspace:tsid"
    assert_allclose(before - before[0], 0.0, atol=TORQUE)


def test_limits_that_both_keep_are_kept_on_the_way():
    limits = TorqueLimits(0.3)
    control = Controller(ARM, limits >> Posture(AWAY, stiffness=1e4))
    control(HOME, STILL)
    control.change(limits >> Posture(HOME - 1.0, stiffness=1e4), OVER, rate=FAST)
    torques = ticks(control, TICKS)
    assert (np.abs(torques) <= 0.3 * ARM.tau_max * (1.0 + TORQUE)).all()
    assert (np.abs(torques) >= 0.29 * ARM.tau_max).any(), "the limits are at work"


@families
def test_a_task_that_stays_on_top_is_met_on_the_way(resolver):
    tip = FramePosition("tip", ARM.state(HOME).frame("tip").p + 0.05)
    control = Controller(ARM, tip >> held() >> Damping(), resolver)
    control(HOME, STILL)
    control.change(tip >> Damping(), OVER, resolver, rate=FAST)
    for _ in range(TICKS):
        residual = control(HOME, STILL).report(tip.name).residual
        assert_allclose(residual, 0.0, atol=SAME)


def test_an_old_hierarchy_that_fails_is_dropped():
    class Silent(RawRows):
        def update(self, state: State, rows) -> None:
            raise SolverError("the sensor fell silent.")

    silent = Silent("silent", np.eye(1, ARM.nv), [0.0])
    control = Controller(ARM, silent >> held())
    assert control(HOME, STILL).status is Status.SOLVER_FAILED
    control.change(held(AWAY), OVER, rate=FAST)
    assert control(HOME, STILL).ok
    assert not control.changing
    assert_allclose(
        control(HOME, STILL).torque, ticks(Controller(ARM, held(AWAY)), 1)[0]
    )


def test_a_new_hierarchy_that_fails_is_held_and_counted():
    broken = RawRows("broken", np.full((1, ARM.nv), np.nan), [0.0])
    control = Controller(ARM, held())
    control.change(broken, OVER, rate=FAST)
    assert control(HOME, STILL).status is Status.SOLVER_FAILED
    assert control.failures == 1


class Counter(Task):
    """Remembers how often it moved on."""

    count = 0

    def row_names(self, robot):
        return ("one",)

    def update(self, state, rows):
        rows.A[:] = np.eye(1, state.robot.nv)

    def advance(self, state, torque):
        self.count += 1
        torque[0] += 1.0


def test_a_task_with_a_memory_moves_on_once_a_tick():
    counter = Counter("counter", "-")
    control = Controller(ARM, counter >> held())
    control(HOME, STILL)
    control.change(held(AWAY) >> counter, OVER, rate=FAST)
    ticks(control, TICKS // 2)
    assert counter.count == 1 + TICKS // 2
    torque = control(HOME, STILL).torque
    free = Controller(ARM, RawRows("zero", np.eye(1, ARM.nv), [0.0]) >> held())
    assert torque[0] != pytest.approx(ticks(free, 1)[0][0]), "its push is counted on"


@pytest.mark.parametrize("over", [-0.1, np.nan, np.inf, "soon"])
def test_a_duration_that_is_none_is_refused(over):
    control = Controller(ARM, held())
    with pytest.raises(InputError, match="over must be"):
        control.change(held(AWAY), over)
    assert not control.changing


@pytest.mark.parametrize("rate", [0.0, -1.0, np.nan, np.inf])
def test_a_rate_that_is_none_is_refused(rate):
    control = Controller(ARM, held())
    with pytest.raises(InputError, match="rate must be"):
        control.change(held(AWAY), rate=rate)
    assert not control.changing


def test_a_hierarchy_that_does_not_fit_is_refused_and_all_stays():
    control = Controller(ARM, held())
    with pytest.raises(UnknownName, match="unknown frame 'nose'"):
        control.change(FramePosition("nose", HOME[:3]))
    assert not control.changing
    assert [task.name for task in control.hierarchy.tasks()] == ["posture"]


# ----------------------------------------------------------------------- torque rates


@pytest.mark.parametrize(
    "resolver", [HierarchicalQP(), NullSpace(), NullSpace("tsid"), WeightedQP()]
)
def test_a_rate_limit_bounds_a_switch_without_a_ramp(resolver):
    def stack(target):
        return TorqueLimits() >> TorqueRateLimits(800.0) >> held(target)

    control = Controller(ARM, stack(HOME), resolver)
    before = ticks(control, 1)
    control.change(stack(AWAY), over=0.0)
    way = np.vstack([before, ticks(control, 60)])
    rates = np.abs(np.diff(way, axis=0)) / 1e-3
    assert rates.max() <= 800.0 * (1.0 + TORQUE)
    assert rates.max() >= 799.0, "it was at work"


def test_rate_limits_know_blends_and_fallbacks():
    limit = TorqueRateLimits(np.full(ARM.nv, 500.0))
    control = Controller(ARM, limit >> held())
    control(HOME, STILL)
    control(HOME * np.nan, STILL)
    held_torque = ARM.state(HOME).gravity()
    after = control(HOME, STILL).torque
    assert (np.abs(after - held_torque) <= 0.5 * (1.0 + TORQUE)).all()
    control.change(TorqueRateLimits(500.0) >> held(AWAY), OVER, rate=FAST)
    way = np.vstack([after, ticks(control, 2 * TICKS)])
    assert (np.abs(np.diff(way, axis=0)) <= 0.5 * (1.0 + TORQUE)).all()


@pytest.mark.parametrize("rate", [0.0, -1.0, np.nan, [1.0, 0.0], "fast"])
def test_rates_that_are_not_positive_are_refused(rate):
    with pytest.raises(InputError, match="rate of 'torque rate limits'"):
        TorqueRateLimits(rate)


def test_rates_for_another_robot_are_refused():
    with pytest.raises(InputError, match=r"has 3 rates, but robot 'seven'"):
        Controller(ARM, TorqueRateLimits([1.0, 2.0, 3.0]) >> held())


def test_a_rate_can_change_on_the_way():
    limit = TorqueRateLimits(10.0)
    control = Controller(ARM, limit >> held(AWAY))
    control(HOME, STILL)
    limit.rate = 20.0
    assert float(limit.rate) == 20.0
    with pytest.raises(InputError, match="has 3 rates"):
        limit.rate = [1.0, 2.0, 3.0]
    assert float(limit.rate) == 20.0


# ------------------------------------------------------------------ what is explained


@families
def test_an_explanation_in_a_ramp_says_so_and_which_tasks_come_and_go(resolver):
    limits, stays = TorqueLimits(), Posture(HOME, name="stays")
    goes, comes = FramePosition("tip", [0.3, 0, 1]), FramePosition("tip", [0.5, 0.1, 1])
    goes.set_target([0.4, 0.0, 0.9])
    old, new = limits >> goes >> stays, limits >> comes + held(AWAY, "comes") >> stays
    control = Controller(ARM, old, resolver)
    assert control(HOME, STILL).explain().change is None
    control.change(new, OVER, rate=FAST)
    for _ in range(TICKS // 2):
        solution = control(HOME, STILL)
    told = solution.explain()
    assert 0.1 < told.change.share == solution.share < 0.9
    assert [name for name, _ in told.change.coming] == ["tip position", "comes"]
    (gone,) = told.change.going
    assert gone[0] == "tip position"
    assert gone[1] == pytest.approx(1.0 - solution.share)
    assert "ramp" in told.task("comes").reasons
    assert all("resolver" not in task.reasons for task in told.tasks)
    text = str(told)
    share = f"{solution.share:.1%}"
    assert text.startswith(
        f"a ramp is under way: the new hierarchy has a share of {share}"
    )
    assert "'comes' fades in, at" in text
    assert "resolver" not in text
    while control.changing:
        solution = control(HOME, STILL)
    assert solution.explain().change is None
    assert "ramp" not in str(solution.explain())


def test_shares_of_changes_in_a_row_add_up():
    control = Controller(ARM, held(HOME, "a"))
    control.change(held(AWAY, "b"), OVER, rate=FAST)
    for _ in range(TICKS // 2):
        control(HOME, STILL)
    control.change(held(-AWAY, "c"), OVER, rate=FAST)
    for _ in range(TICKS // 4):
        solution = control(HOME, STILL)
    change = solution.explain().change
    shares = dict([*change.coming, *change.going])
    assert set(shares) == {"a", "b", "c"}
    assert sum(shares.values()) == pytest.approx(1.0)
    assert shares["c"] == solution.share


# -------------------------------------------------------------- changes of tasks in use


@pytest.mark.parametrize(
    "law", [PD(900.0), PD(900.0, 10.0), Damper(3.0), SaturatedPD(400.0, 0.1, 1.0)]
)
@families
def test_a_new_law_takes_effect_at_the_next_tick(resolver, law):
    task = held(AWAY)
    control = Controller(ARM, TorqueLimits() >> task, resolver)
    v = np.full(ARM.nv, 0.1)
    control(HOME, v)
    task.law = law
    fresh = held(AWAY)
    fresh.law = law
    expected = Controller(ARM, TorqueLimits() >> fresh, resolver)(HOME, v).torque
    assert_allclose(control(HOME, v).torque, expected, rtol=0, atol=TORQUE)
    task.set_target(HOME)
    fresh.set_target(HOME)
    expected = Controller(ARM, TorqueLimits() >> fresh, resolver)(HOME, v).torque
    assert_allclose(control(HOME, v).torque, expected, rtol=0, atol=TORQUE)


def test_a_law_that_does_not_fit_is_refused_and_the_old_one_stays():
    task = held()
    control = Controller(ARM, task)
    law = task.law
    with pytest.raises(InputError, match="7 rows and 3 values of stiffness"):
        task.law = PD([1.0, 2.0, 3.0])
    with pytest.raises(InputError, match="law of 'posture' must be a Law, got 5"):
        task.law = 5
    assert task.law is law
    assert control(HOME, STILL).ok


@pytest.mark.parametrize("law", [PD(1.0), Damper(1.0), SaturatedPD(1.0, 1.0, 1.0)])
def test_gains_of_a_law_are_not_changed_in_place(law):
    with pytest.raises(InputError, match=r"'damping' of a law cannot change.*law = "):
        law.damping = np.ones(1)


def test_a_new_speed_takes_effect_or_is_refused():
    line = Line([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], length=5.0)
    task = TravelSpeed("tip", line, speed=0.1)
    control = Controller(ARM, task)
    slow = control(HOME, STILL, 5.0).report(task.name).error
    task.speed = 0.2
    fast = control(HOME, STILL, 5.0).report(task.name).error
    assert_allclose(fast, 2.0 * slow)
    with pytest.raises(InputError, match="speed must be finite and greater than 0"):
        task.speed = -1.0
    assert task.speed == 0.2


def test_a_new_fraction_takes_effect_or_is_refused():
    limits = TorqueLimits()
    control = Controller(ARM, limits >> Posture(HOME + 1.0, stiffness=1e5))
    assert np.isclose(np.abs(control(HOME, STILL).torque), ARM.tau_max).any()
    limits.fraction = 0.5
    torque = np.abs(control(HOME, STILL).torque)
    assert (torque <= 0.5 * ARM.tau_max * (1.0 + TORQUE)).all()
    with pytest.raises(InputError, match="at most 1"):
        limits.fraction = 1.5
    assert limits.fraction == 0.5


@pytest.mark.parametrize(
    ("task", "name", "value"),
    [
        (JointLimits(), "margin", 0.1),
        (JointLimits(), "braking", 0.5),
        (held(), "joints", ("a1",)),
        (
            TravelSpeed("tip", Line([0.0, 0, 0], [1.0, 0, 0], length=1.0), speed=0.1),
            "ramp",
            1.0,
        ),
    ],
)
def test_what_would_have_no_effect_is_refused(task, name, value):
    control = Controller(ARM, task)
    with pytest.raises(InputError, match=rf"'{name}' of task .* Controller.change"):
        setattr(task, name, value)
    assert control(HOME, STILL).ok
