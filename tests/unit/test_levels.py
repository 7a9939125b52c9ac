"""What tasks went without: per tick, over runs, and as lanes of a figure."""

from __future__ import annotations

import numpy as np
import pytest

from robots import racer
from sims import welding
from sims.compare.transitions import events
from sims.course import Course
from sims.levels import EVERY, LevelLog
from sims.report.runs import compared_figures, level_figures
from sims.run import run
from sims.welding.parts import READY
from tasks import Damping, JointLimits, Posture, TorqueLimits
from tests.arms import seven_axis
from tests.catalogue import RawRows
from wbc import Controller, NullSpace, StaleError, resolve

INF = np.inf
EXACT = 1e-9


def row(name: str, lower: float, upper: float, *on: float) -> RawRows:
    """One row on the first joints of seven."""
    return RawRows(name, np.pad(on, (0, 7 - len(on)))[None], [lower], [upper])


def shares(*levels, resolver=None) -> dict[tuple[int, str], float]:
    stack = levels[0]
    for level in levels[1:]:
        stack = stack >> level
    solution = resolve(seven_axis().state(seven_axis().q_home), stack, resolver)
    return {(level, task): share for level, task, share in solution.shortfalls()}


@pytest.mark.parametrize("resolver", [None, NullSpace()], ids=["hqp", "nullspace"])
def test_a_target_of_three_under_a_bound_of_one_misses_two_thirds(resolver):
    found = shares(
        row("cap", -INF, 1.0, 1.0), row("goal", 3.0, 3.0, 1.0), resolver=resolver
    )
    assert found[1, "cap"] == 0.0
    assert found[2, "goal"] == pytest.approx(2.0 / 3.0, abs=EXACT)


def test_a_task_that_gets_the_opposite_misses_all_and_no_more():
    found = shares(row("first", -5.0, -5.0, 1.0), row("second", 1.0, 1.0, 1.0))
    assert found == {(1, "first"): 0.0, (2, "second"): 1.0}


def test_weights_do_not_change_what_a_task_misses():
    cap, goal = row("cap", -INF, 1.0, 1.0), row("goal", 3.0, 3.0, 1.0)
    assert shares(cap, 7.0 * goal) == pytest.approx(shares(cap, goal), abs=EXACT)


def test_of_bounds_the_broken_ones_alone_count():
    broken = row("floor", 4.0, INF, 1.0)
    found = shares(row("cap", -INF, 1.0, 1.0), broken, row("wide", -INF, 9.0, 0.0, 1.0))
    assert found[2, "floor"] == pytest.approx(3.0 / 4.0, abs=EXACT)
    assert found[3, "wide"] == 0.0


def test_shortfalls_of_a_tick_are_asked_before_the_next_one():
    arm = seven_axis()
    controller = Controller(arm, TorqueLimits() >> Damping())
    solution = controller(arm.q_home, np.zeros(7))
    controller(arm.q_home, np.zeros(7))
    with pytest.raises(StaleError):
        solution.shortfalls()


def test_a_log_keeps_every_tenth_tick_and_what_a_fallback_could_not_say():
    arm = seven_axis()
    controller, log = Controller(arm, Posture(arm.q_home + 0.1)), LevelLog(4 * EVERY)
    for tick in range(3 * EVERY - 5):
        q = np.full(7, np.nan) if tick == EVERY else arm.q_home
        log.record(tick, 1e-3 * tick, controller(q, np.zeros(7)))
    log.trim()
    np.testing.assert_allclose(log.t, [0.0, 1e-3 * EVERY, 2e-3 * EVERY])
    assert list(log.shortfall) == [(1, "posture")]
    np.testing.assert_array_equal(
        log.arrays()["shortfall/level 1: posture"], [0, np.nan, 0]
    )


def switched(first: str, second: str) -> Course:
    """A run in which one hierarchy hands over to another after 0.1 s."""
    arm = racer.load()
    cell = welding.cell(arm)
    cell.reset(READY)
    stacks = {name: stack for name, _, stack in events(arm, limited=False)}
    controller = Controller(arm, stacks[first])

    def script(t: float) -> None:
        if abs(t - 0.1) < 1e-9:
            controller.change(stacks[second], 0.02)

    return Course.of(run(cell, controller, 0.2, script=script))


@pytest.fixture(scope="module")
def changed() -> Course:
    """Two tasks trade places."""
    return switched("task replaced", "priorities swapped")


def test_the_error_of_a_task_that_comes_later_has_its_unit():
    errors = switched("start", "task added above").errors
    assert list(errors) == ["posture [rad]", "near [m]"]
    assert np.isnan(errors["near [m]"][:100]).all()
    assert np.isfinite(errors["near [m]"][101:]).all()


def test_a_task_that_changes_its_level_has_a_lane_at_each(changed):
    far = {
        level: share
        for (level, task), share in changed.shortfall.items()
        if task == "far"
    }
    assert list(far) == [3, 4]
    there, here = (np.isfinite(share) for share in far.values())
    assert (there ^ here).all()
    assert changed.sampled[there].max() < changed.sampled[here].min()
    assert far[4][-1] > 0.1  # the posture above leaves it nothing


def test_consecutive_runs_join_into_one_course():
    arm = racer.load()
    cell = welding.cell(arm)
    cell.reset(READY)
    first = run(cell, Controller(arm, Posture(READY)), 0.03)
    second = run(cell, Controller(arm, JointLimits() >> Damping()), 0.02)
    course = Course.of(first, second)
    assert course.t.size == 50
    assert (np.diff(course.t) > 0.0).all()
    assert set(course.errors) == {"posture [rad]", "damping [rad/s]"}
    assert np.isnan(course.errors["damping [rad/s]"][:30]).all()
    assert np.isfinite(course.errors["damping [rad/s]"][30:]).all()
    assert list(course.shortfall) == [
        (1, "posture"),
        (1, "joint limits"),
        (2, "damping"),
    ]
    assert (
        np.isfinite(course.shortfall[1, "posture"]).tolist() == [True] * 3 + [False] * 2
    )


def test_figures_name_lanes_by_level_and_limits_that_were_active(changed):
    ((caption, svg),) = level_figures({"swap": changed})
    assert "'swap'" in caption
    for text in ("1 torque limits", "3 far", "4 far", "limit active", "time [s]"):
        assert text in svg.replace("  ", " ")
    assert "task error" in svg
    assert "of limit [1]" in svg


def test_runs_with_active_limits_come_first():
    quiet = Course(
        t=np.array([0.0, 1.0]),
        torque=np.zeros(2),
        speed=np.zeros(2),
        errors={},
        active={},
        sampled=np.array([0.0, 1.0]),
        shortfall={(1, "limits"): np.zeros(2)},
    )
    active = {"level 1: limits: joint2": np.array([True, False])}
    pressed = Course(
        quiet.t, quiet.torque, quiet.speed, {}, active, quiet.sampled, quiet.shortfall
    )
    captions = [
        caption for caption, _ in level_figures({"calm": quiet, "hard": pressed})
    ]
    assert ["hard" in caption for caption in captions] == [True, False]


def test_only_runs_that_several_ways_did_stand_side_by_side(changed):
    both = {"hqp": {"a": changed, "b": changed}, "nullspace": {"a": changed}}
    ((caption, svg),) = compared_figures(both)
    assert "'a'" in caption
    assert ">hqp<" in svg
    assert ">nullspace<" in svg
