"""Poses from constraints: closed forms, a general minimiser, and what cannot be met."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import minimize

import tasks
from tests.arms import HOME, LOWER, UPPER, seven_axis, six_axis, two_arms, two_link
from tests.catalogue import random_rotation
from tests.tolerances import BRUTE_FORCE, POSE
from wbc import (
    PD,
    HierarchicalQP,
    Hierarchy,
    InputError,
    MotionTask,
    NullSpace,
    Robot,
    SolverError,
    State,
    UnknownName,
    allocate_rows,
    resolve,
)
from wbc import solve_pose as solve

X, Y, Z = np.eye(3)
START = np.array([0.3, 0.5])


def elbows(p: np.ndarray) -> list[np.ndarray]:
    """Both postures of the planar arm with its tip at p."""
    c = (p[0] ** 2 + p[1] ** 2 - UPPER**2 - LOWER**2) / (2.0 * UPPER * LOWER)
    found = []
    for elbow in (np.arccos(c), -np.arccos(c)):
        across = np.arctan2(LOWER * np.sin(elbow), UPPER + LOWER * np.cos(elbow))
        found.append(np.array([np.arctan2(p[1], p[0]) - across, elbow]))
    return found


def turned(tip: str, robot: Robot, q: np.ndarray) -> np.ndarray:
    return robot.state(q).frame(tip).p


# --------------------------------------------------------------------- closed forms


@pytest.mark.parametrize("seed", range(6))
def test_a_planar_arm_takes_the_nearer_of_its_two_elbows(seed):
    rng = np.random.default_rng(seed)
    angle, reach = rng.uniform(-2.0, 2.0), rng.uniform(0.25, 0.75)
    p = reach * np.array([np.cos(angle), np.sin(angle), 0.0])
    start = rng.uniform(-1.5, 1.5, 2)
    both = [q for q in elbows(p) if (np.abs(q) <= 3.1).all()]
    wanted = min(both, key=lambda q: float(np.linalg.norm(q - start)))
    result = solve(two_link(), tasks.PointOnPoint("tip", p), start)
    assert result.ok
    assert_allclose(result.q, wanted, atol=POSE)
    assert result.distance == pytest.approx(np.linalg.norm(wanted - start))


def test_a_pose_that_holds_already_is_the_answer():
    p = turned("tip", seven_axis(), HOME)
    result = solve(seven_axis(), tasks.PointOnPoint("tip", p), HOME, quick=True)
    assert result.ok
    assert_allclose(result.q, HOME, atol=POSE)
    assert result.attempts == 1


@pytest.mark.parametrize("reach", [1.2, 0.9, 0.80001, 0.05])
def test_a_point_out_of_reach_is_missed_by_what_the_links_say(reach):
    p = reach * np.array([np.cos(0.4), np.sin(0.4), 0.0])
    result = solve(two_link(-3.2, 3.2), tasks.PointOnPoint("tip", p), START)
    gap = max(reach - UPPER - LOWER, UPPER - LOWER - reach)
    assert not result.ok
    assert [miss.task for miss in result.misses] == ["tip on point"]
    assert result.misses[0].errors["m"] == pytest.approx(gap, abs=BRUTE_FORCE)
    tip = turned("tip", two_link(), result.q)
    assert_allclose(tip, p + gap * (-1 if reach > 0.5 else 1) * p / reach, atol=1e-3)


def test_a_point_at_the_very_border_of_the_workspace_is_reached():
    p = (UPPER + LOWER) * np.array([np.cos(0.4), np.sin(0.4), 0.0])
    result = solve(two_link(), tasks.PointOnPoint("tip", p), START)
    assert result.ok
    assert_allclose(result.q, [0.4, 0.0], atol=2e-3)  # sin of 1e-3 is a micrometre


def test_joint_limits_hold_and_say_so():
    robot = two_link(0.2, 1.0)
    p = elbowed = turned("tip", two_link(), np.array([0.3, 1.8]))
    result = solve(robot, tasks.PointOnPoint("tip", p), START)
    assert not result.ok
    assert result.at_limit == ("elbow at its upper limit",)
    assert result.q[1] == 1.0
    reach = np.linalg.norm(turned("tip", robot, result.q))
    gap = abs(reach - np.linalg.norm(elbowed))
    assert result.misses[0].size == pytest.approx(gap, abs=BRUTE_FORCE)


def test_a_margin_keeps_away_from_the_limits():
    p = turned("tip", two_link(), np.array([0.3, 0.95]))
    robot, goal = two_link(0.2, 1.0), tasks.PointOnPoint("tip", p)
    assert solve(robot, goal, START).ok
    result = solve(robot, goal, START, margin=0.1)
    assert not result.ok
    assert result.q[1] == pytest.approx(0.9)


def test_a_lower_level_yields_where_it_must_and_says_so():
    p = np.array([0.4, 0.4, 0.0])
    line = tasks.PointOnLine("tip", tasks.Line(0.4 * X, Y))
    result = solve(two_link(), line >> tasks.PointOnPoint("tip", p + 0.1 * X), START)
    assert not result.ok
    (miss,) = result.misses
    assert (miss.task, miss.level) == ("tip on point", 2)
    assert miss.errors["m"] == pytest.approx(0.1, abs=BRUTE_FORCE)
    assert_allclose(turned("tip", two_link(), result.q), p, atol=1e-4)
    assert result.tasks[0].met


def test_constraints_that_cannot_hold_together_share_the_miss():
    p = np.array([0.5, 0.2, 0.0])
    both = tasks.PointOnPoint("tip", p) + tasks.FramePosition("tip", p + 0.1 * Y)
    result = solve(two_link(), both, START)
    assert {miss.task for miss in result.misses} == {"tip position", "tip on point"}
    for miss in result.misses:
        assert miss.errors["m"] == pytest.approx(0.05, abs=BRUTE_FORCE)
    text = str(result)
    assert "no pose found from 16 starts" in text
    assert "tip on point (level 1) by 0.05 m" in text


# --------------------------------------------------------------- nearest, by scipy


def slsqp(robot: Robot, goal, start: np.ndarray, first: np.ndarray, low, high):
    """The nearest pose by a general minimiser, from the rows' errors alone."""
    levels = Hierarchy.of(goal).levels
    terms = [task for level in levels for task, _ in level.terms]

    def error(q: np.ndarray) -> np.ndarray:
        state = robot.state(q)
        found = []
        for task in terms:
            rows = allocate_rows(len(task.row_names(robot)), robot.nv)
            task.update(state, rows)
            found.append(rows.error.copy())
        return np.concatenate(found)

    # At the optimum itself its line search may find no way down and call that failure.
    beside = first + 0.01 * np.random.default_rng(0).normal(size=first.size)
    return minimize(
        lambda q: 0.5 * float((q - start) @ (q - start)),
        np.clip(beside, low, high),
        jac=lambda q: q - start,
        constraints=[{"type": "eq", "fun": error}],
        bounds=list(zip(low, high, strict=True)),
        method="SLSQP",
        options={"ftol": 1e-15, "maxiter": 300},
    )


def goals(robot: Robot, tip: str, seed: int) -> tuple:
    """A point, a line, a plane with an axis: reachable, and with freedom left."""
    rng = np.random.default_rng(seed)
    low, high = np.maximum(robot.q_min, -2.0), np.minimum(robot.q_max, 2.0)
    F = robot.state(rng.uniform(0.7 * low, 0.7 * high)).frame(tip)
    n = random_rotation(rng) @ Z
    tool = tasks.Line(np.zeros(3), Z, on=tip)
    return (
        tasks.PointOnPoint(tip, F.p),
        tasks.PointOnLine(tip, tasks.Line(F.p, n)),
        tasks.PointOnPlane(tip, tasks.Plane(F.p, n))
        + tasks.ParallelLines(tool, tasks.Line(F.p, F.R @ Z)),
        tasks.PointOnCircle(tip, tasks.Circle(F.p + 0.1 * F.R[:, 0], F.R[:, 2], 0.1)),
    )


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("which", range(4))
def test_no_pose_that_scipy_finds_is_nearer(which, seed):
    robot = seven_axis()
    goal = goals(robot, "tip", seed)[which]
    result = solve(robot, goal, HOME)
    assert result.ok
    low, high = robot.q_min, robot.q_max
    assert (low <= result.q).all()
    assert (result.q <= high).all()
    for first in (HOME, result.q + 0.02):
        other = slsqp(robot, goal, HOME, first, low, high)
        if other.success:
            distance = float(np.linalg.norm(other.x - HOME))
            assert result.distance <= distance + BRUTE_FORCE
    assert distance == pytest.approx(result.distance, abs=BRUTE_FORCE)
    assert_allclose(other.x, result.q, atol=1e-4)


def test_the_nearest_pose_with_a_limit_in_the_way():
    free = solve(seven_axis(), goals(seven_axis(), "tip", 1)[0], HOME)
    moved = int(np.argmax(np.abs(free.q - HOME)))
    half = abs(HOME[moved] + 0.6 * (free.q[moved] - HOME[moved]))
    robot = Robot.from_mjcf(
        seven_axis().mjcf or "", position_limit={f"a{moved + 1}": float(half)}
    )
    goal = goals(seven_axis(), "tip", 1)[0]
    result = solve(robot, goal, HOME)
    assert result.ok
    assert result.at_limit
    assert abs(result.q[moved]) == pytest.approx(half)
    assert result.distance > free.distance
    other = slsqp(robot, goal, HOME, result.q, robot.q_min, robot.q_max)
    assert other.success
    assert result.distance == pytest.approx(
        np.linalg.norm(other.x - HOME), abs=BRUTE_FORCE
    )


def test_a_heavy_joint_moves_less():
    goal = goals(seven_axis(), "tip", 2)[1]
    plain = solve(seven_axis(), goal, HOME)
    weights = np.ones(7)
    joint = int(np.argmax(np.abs(plain.q - HOME)))
    weights[joint] = 10.0
    heavy = solve(seven_axis(), goal, HOME, weights=weights)
    assert heavy.ok
    assert abs(heavy.q - HOME)[joint] < 0.5 * abs(plain.q - HOME)[joint]
    moved = float(np.linalg.norm(weights * (plain.q - HOME)))
    assert heavy.distance < moved


# ---------------------------------------------------------------- the rim and others


@pytest.mark.parametrize("seed", range(4))
def test_the_rim_grasp_has_seven_rows_rank_five_and_one_degree_left(seed):
    """The paper's four constraints on a six-axis arm; facts of P4, section IV-A."""
    rng, robot = np.random.default_rng(seed), six_axis()
    top = [rng.uniform(0.7, 0.9), rng.uniform(-0.2, 0.2), rng.uniform(0.2, 0.5)]
    up = Z + rng.uniform(-0.2, 0.2, 3)
    rim = tasks.rim_grasp("torch_tip", tasks.Cylinder(top, up, 0.04))
    result = solve(robot, rim)
    assert result.ok
    assert max(task.size for task in result.tasks) < POSE
    analysis = Hierarchy(rim).analyse(robot.state(result.q))
    (level,) = analysis.levels
    assert (level.rows, level.rank, analysis.free) == (7, 5, 1)
    assert len(level.redundant) == 2
    assert level.conflicts == ()


@pytest.mark.parametrize(
    "resolver", [HierarchicalQP(), NullSpace()], ids=lambda r: r.name
)
def test_the_rim_is_approached_without_chatter_and_leaves_the_posture_its_freedom(
    resolver,
):
    """Redundant rows that were so only at the grasp asked for 200 rad/s^2 near it."""
    robot, dt = six_axis(), 2e-3
    rim = tasks.rim_grasp("torch_tip", tasks.Cylinder([0.8, 0.1, 0.4], Z, 0.04))
    grasp = solve(robot, rim, quick=True).q
    q = grasp + 1e-4 * np.random.default_rng(1).normal(size=6)
    v, largest = np.zeros(6), 0.0
    turned = tasks.Posture(grasp + 0.3 * np.eye(6)[0])
    for _ in range(500):
        a = resolve(robot.state(q, v), rim >> turned, resolver).acceleration
        largest = max(largest, float(np.abs(a).max()))
        v = v + dt * a
        q = q + dt * v
    state = robot.state(q)
    assert largest < 3.0
    assert np.linalg.norm(v) < 0.01
    assert np.linalg.norm(q - grasp) > 0.02  # along the rim, towards the posture
    for task, _ in rim.terms:
        rows = allocate_rows(len(task.row_names(robot)), 6)
        task.update(state, rows)
        assert np.abs(rows.error).max() < 1e-6


def test_two_arms_meet():
    robot = two_arms()
    start = np.concatenate([HOME, HOME])
    meet = tasks.PointOnPoint("left_tip", tasks.Point(on="right_tip"))
    face = tasks.ParallelLines(
        tasks.Line(np.zeros(3), Z, on="left_tip"),
        tasks.Line(np.zeros(3), Z, on="right_tip"),
        sense="opposite",
    )
    result = solve(robot, meet + face, start, attempts=2)
    assert result.ok
    state = robot.state(result.q)
    left, right = state.frame("left_tip"), state.frame("right_tip")
    assert_allclose(left.p, right.p, atol=POSE)
    assert_allclose(left.R[:, 2], -right.R[:, 2], atol=POSE)
    assert np.abs(result.q - start)[:7].max() > 0.01
    assert np.abs(result.q - start)[7:].max() > 0.01


def test_a_moving_target_is_met_where_it_is_at_the_time_asked_for():
    belt = tasks.MovingFrame.steady([0.0, 0.1, 0.0], position=[0.5, 0.0, 0.5])
    goal = tasks.PointOnPoint("tip", tasks.Point(on=belt))
    result = solve(seven_axis(), goal, t=2.0, quick=True)
    assert_allclose(turned("tip", seven_axis(), result.q), [0.5, 0.2, 0.5], atol=POSE)


def test_limits_and_velocities_may_stand_among_the_tasks():
    goal = tasks.PointOnPoint("tip", [0.5, 0.1, 0.4])
    alone = solve(seven_axis(), goal, quick=True)
    stack = tasks.JointLimits() >> goal >> tasks.Damping()
    assert_allclose(solve(seven_axis(), stack, quick=True).q, alone.q, atol=POSE)


def test_the_same_seed_gives_the_same_pose():
    goal = goals(seven_axis(), "tip", 0)[2]
    once, twice = (solve(seven_axis(), goal, HOME, seed=3) for _ in range(2))
    np.testing.assert_array_equal(once.q, twice.q)


def test_a_search_without_an_answer_ends():
    far = tasks.FramePose("tip", [3.0, 0.0, 0.0], np.eye(3))
    result = solve(seven_axis(), far, HOME)
    assert not result.ok
    assert result.attempts == 16
    assert result.evaluations < 16 * 300
    assert set(result.misses[0].errors) == {"m", "rad"}


# -------------------------------------------------------------------------- bad input


def test_a_start_outside_the_limits_leads_inside():
    robot = two_link(0.2, 1.0)
    result = solve(robot, tasks.PointOnLine("tip", tasks.Line(0.6 * X, Y)), [0.0, 2.0])
    assert result.ok
    assert 0.2 <= result.q[1] <= 1.0


class Broken(MotionTask):
    def __init__(self, error: float) -> None:
        super().__init__("broken", "m", ("x",), PD(1.0))
        self.error = error

    def evaluate(self, state: State, out) -> None:
        out.error[:] = self.error


def test_bad_input_is_refused_by_name():
    arm, goal = seven_axis(), tasks.PointOnPoint("tip", X)
    with pytest.raises(InputError, match="at least one task with a position"):
        solve(arm, tasks.Damping())
    with pytest.raises(InputError, match="start must be finite"):
        solve(arm, goal, np.full(7, np.nan))
    with pytest.raises(InputError, match=r"margin 9\.0 leaves no range"):
        solve(arm, goal, margin=9.0)
    with pytest.raises(InputError, match="weights must be greater than 0"):
        solve(arm, goal, weights=np.zeros(7))
    with pytest.raises(InputError, match="attempts must be at least 1"):
        solve(arm, goal, attempts=0)
    with pytest.raises(UnknownName, match="unknown frame 'tipp'"):
        solve(arm, tasks.PointOnPoint("tipp", X))
    for error in (np.nan, np.inf):
        with pytest.raises(SolverError, match="'broken' wrote a row 'x' that is not"):
            solve(arm, goal >> Broken(error))
