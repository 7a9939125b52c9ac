"""Damping near singularities: what it asks for, when, and that it disturbs nobody."""

from __future__ import annotations

import numpy as np
import pytest

from sims.constraints.chatter import reversals, travel
from tasks import Damping, FramePose, FramePosition, SingularDamping
from tests.arms import LOWER, UPPER, six_axis, two_link
from tests.tolerances import BY_HAND, ROUND_OFF, SOUND
from wbc import (
    PD,
    Controller,
    Damper,
    HierarchicalQP,
    Hierarchy,
    InputError,
    NullSpace,
    SaturatedPD,
    resolve,
)
from wbc.rows import allocate_rows

RACER = six_axis()
TIP = "torch_tip"
WRIST = np.radians([10.0, 5.0, -110.0, 30.0, 0.0, 0.0])
"""Axes 4 and 6 of the wrist in one line: a rank of five."""
RESOLVERS = {"hqp": HierarchicalQP, "nullspace": NullSpace}
each_resolver = pytest.mark.parametrize("resolver", RESOLVERS)
PERIOD = 1e-3


def rows_of(task, state):
    rows = allocate_rows(len(task.row_names(state.robot)), state.robot.nv)
    task.update(state, rows)
    return rows


def stretched(bend, v=(0.0, 0.0), **options):
    """A planar arm nearly stretched along x, its goal 0.2 m beyond its reach."""
    arm = two_link()
    goal = FramePosition("tip", [UPPER + LOWER + 0.2, 0.0, 0.0], name="goal")
    damping = SingularDamping(goal, **options)
    return goal, damping, arm.state(np.array([-bend / 3, bend]), np.array(v))


def test_away_from_singularities_its_rows_are_zero():
    _, damping, state = stretched(1.5, v=(1.0, -2.0), threshold=0.05)
    rows = rows_of(damping, state)
    assert not rows.A.any()
    assert not rows.upper.any()
    np.testing.assert_array_equal(rows.lower, rows.upper)


def test_at_rest_it_asks_for_rest_whatever_the_error():
    _, damping, state = stretched(0.01)
    rows = rows_of(damping, state)
    assert np.linalg.norm(rows.A) > 0.01
    assert not rows.upper.any()


def test_on_a_level_with_its_task_it_makes_a_damped_inverse_that_ends_at_rest():
    """Against the normal equations, written out."""
    goal, damping, state = stretched(0.05, v=(0.3, -0.7))
    J, b = rows_of(goal, state).A, rows_of(goal, state).upper
    s, Vt = np.linalg.svd(J)[1:]
    s = np.array([s[0], s[1]])
    size, error = np.linalg.norm(J), np.linalg.norm(rows_of(goal, state).error)
    fade = np.maximum(1.0 - (s / (0.1 * size)) ** 2, 0.0)
    square = fade * ((0.01 * size) ** 2 + size * error / 3.0)
    D = Vt.T @ np.diag(square) @ Vt
    kd = 2.0 * np.sqrt(100.0)
    expected = np.linalg.solve(J.T @ J + D, J.T @ b - kd * D @ state.v)
    for make in RESOLVERS.values():
        found = resolve(state, goal + damping, make()).acceleration
        np.testing.assert_allclose(found, expected, rtol=0, atol=BY_HAND)


def test_a_law_that_saturates_bounds_the_error_that_counts():
    goal, damping, state = stretched(0.01)
    plain = np.linalg.norm(rows_of(damping, state).A)
    goal.law = SaturatedPD(100.0, speed=0.1, acceleration=1.0)
    assert np.linalg.norm(rows_of(damping, state).A) < 0.5 * plain


@each_resolver
def test_levels_above_do_not_feel_it(resolver):
    state = RACER.state(WRIST + 0.01, np.linspace(-1.0, 1.0, 6))
    F = state.frame(TIP)
    first = FramePosition(TIP, F.p + 0.1, name="first")
    goal = FramePose(TIP, F.p + 0.3, F.R, name="goal")
    J = rows_of(first, state).A
    got = [
        J @ resolve(state, first >> level, RESOLVERS[resolver]()).acceleration
        for level in (
            Damping(),
            goal + SingularDamping(goal),
            goal + 10.0 * SingularDamping(goal, factor=1.0),
        )
    ]
    scale = 1.0 + np.abs(got[0]).max()
    assert np.abs(got[1] - got[0]).max() / scale < SOUND
    assert np.abs(got[2] - got[0]).max() / scale < SOUND


def excursion(level, resolver):
    """Torques and last distance: out of reach within 0.5 s, 0.5 s there, and back."""
    arm = two_link()
    q, v = np.array([-0.5, 1.0]), np.zeros(2)
    begin = arm.state(q).frame("tip").p
    goal = FramePosition("tip", begin, stiffness=400.0, name="goal")
    controller = Controller(arm, level(goal), RESOLVERS[resolver](), PERIOD)
    torque = []
    for k in range(3000):
        u = np.interp(k * PERIOD, [0.0, 0.5, 1.0, 1.5], [0.0, 1.0, 1.0, 0.0])
        goal.set_target(begin + u * np.array([0.4, 0.0, 0.0]))
        solution = controller(q, v)
        torque.append(solution.torque)
        v = v + PERIOD * solution.acceleration
        q = q + PERIOD * v
        if np.abs(v).max() > 1e3:
            break  # flung away: no limits stand above
    left = np.linalg.norm(arm.state(q).frame("tip").p - begin)
    return np.array(torque), float(left)


@each_resolver
def test_a_goal_beyond_reach_is_calm_with_it_and_wild_without(resolver):
    calm, left = excursion(lambda goal: goal + SingularDamping(goal), resolver)
    wild, _ = excursion(lambda goal: Hierarchy.of(goal), resolver)
    assert left < 1e-3
    assert np.abs(wild).max() > 20.0 * np.abs(calm).max()
    assert max(travel(x / 50.0, 100) for x in calm.T) < 1.0


@each_resolver
def test_a_singular_wrist_is_reported(resolver):
    state = RACER.state(WRIST)
    F = state.frame(TIP)
    s, U = np.linalg.svd(F.J)[1], np.linalg.svd(F.J)[0]
    assert s[-1] < ROUND_OFF
    goal = FramePose(TIP, F.p + 0.2 * U[:3, -1], F.R, name="goal")
    found = resolve(state, goal, RESOLVERS[resolver]())
    assert found.lost == (1,)
    assert np.linalg.norm(found.report("goal").residual) > 1.0
    task = found.explain().task("goal")
    assert not task.met
    assert "lost" in task.reasons
    assert "singular" in task.why
    level = Hierarchy.of(goal).analyse(state).level("goal")
    assert (level.rows, level.rank, level.free) == (6, 5, 1)


def test_chatter_is_travel_and_turning_points_within_a_window():
    t = np.arange(1000) * 1e-3
    slow, fast = np.sin(2 * np.pi * 2.0 * t), 0.1 * np.sin(2 * np.pi * 100.0 * t)
    assert reversals(slow, 0.02, 100) == 1
    assert reversals(fast, 0.02, 100) == 20
    assert reversals(fast, 0.3, 100) == 0
    assert travel(slow, 1000) == pytest.approx(8.0, rel=1e-2)
    assert travel(fast, 100) == pytest.approx(4.0, rel=5e-2)
    assert travel(np.ones(5), 100) == 0.0


@pytest.mark.parametrize("name", ["threshold", "factor", "bend"])
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_a_number_that_is_not_positive_is_refused(name, value):
    goal = FramePosition(TIP, np.zeros(3))
    with pytest.raises(InputError, match=f"{name} must be"):
        SingularDamping(goal, **{name: value})


def test_a_law_without_stiffness_is_refused_at_once_and_at_binding():
    goal = FramePosition(TIP, np.zeros(3))
    damping = SingularDamping(goal)
    goal.law = Damper(3.0)
    with pytest.raises(InputError, match=r"needs a task with a PD .* is Damper"):
        SingularDamping(goal)
    with pytest.raises(InputError, match="needs a task with a PD"):
        Controller(RACER, goal + damping)
    goal.law = PD(100.0)
    Controller(RACER, goal + damping)
