"""Features, what carries them, and what a constraint on them says."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import tasks
from tasks.geometry import Constraint
from tests.arms import HOME, TIPS, seven_axis, two_arms
from tests.catalogue import CARRIERS, CATALOGUE, MIDDLE, random_state
from tests.differences import (
    T0,
    check_drift,
    check_jacobian_of_rate,
    check_rate,
)
from tests.tolerances import ROUND_OFF
from wbc import Hierarchy, InputError, Level, Rows, State, UnknownName, allocate_rows
from wbc.stack import Stack

X, Y, Z = np.eye(3)
TIP = "tip"
CONSTRAINTS = [kind for kind in CATALOGUE if issubclass(kind, Constraint)]
each_constraint = pytest.mark.parametrize(
    "kind", CONSTRAINTS, ids=lambda kind: kind.__name__
)
each_carrier = pytest.mark.parametrize("on", CARRIERS)


def rows_of(task: Constraint, state: State) -> Rows:
    rows = allocate_rows(len(task.rows), state.robot.nv)
    task.update(state, rows)
    return rows


def home(v: np.ndarray | None = None, t: float = 0.0) -> State:
    return seven_axis().state(HOME, v, t)


# --------------------------------------------------- every constraint on every carrier


@each_constraint
@each_carrier
def test_rate_drift_and_jacobian_hold_whatever_carries_the_other_feature(kind, on):
    rng = np.random.default_rng(7)
    for _ in range(2):
        state = random_state(seven_axis(), rng, T0)
        near = CATALOGUE[kind].kind == "near zero"
        check_drift(CATALOGUE[kind].make(state, rng, False, on), state)
        check_jacobian_of_rate(CATALOGUE[kind].make(state, rng, False, on), state)
        check_rate(CATALOGUE[kind].make(state, rng, near, on), state)


@each_constraint
@each_carrier
def test_a_stack_writes_what_the_task_writes_alone(kind, on):
    rng = np.random.default_rng(3)
    robot = seven_axis()
    for _ in range(3):
        state = random_state(robot, rng, T0)
        subject = CATALOGUE[kind].make(state, rng, False, on)
        stack = Stack(robot, Hierarchy(subject.task))
        subject.move(0.013)
        state.refresh(state.q, state.v, T0 + 0.013)
        stack.update(state)
        alone = rows_of(subject.task, state)
        assert_allclose(stack.raw, alone.A, rtol=0.0, atol=1e-10)
        for i, name in enumerate(("error", "rate", "drift", "lower", "upper")):
            wanted = getattr(alone, name)
            assert_allclose(stack.bands[i], wanted, rtol=1e-9, atol=1e-9)


@each_constraint
def test_rows_units_and_rank_are_what_the_class_says(kind):
    rng = np.random.default_rng(5)
    state = random_state(seven_axis(), rng)
    task = CATALOGUE[kind].make(state, rng, False, "world").task
    rows = rows_of(task, state)
    assert task.row_names(state.robot) == task.rows
    assert task.units == task.row_units(len(task.rows))
    assert len(task.units) == len(task.rows)
    assert set(task.units) <= {"m", "rad"}
    assert np.linalg.matrix_rank(rows.A) == task.rank


def test_what_another_arm_carries_enters_the_jacobian_as_a_difference():
    robot, rng = two_arms(), np.random.default_rng(11)
    state = random_state(robot, rng)
    task = tasks.PointOnPoint("left_tip", tasks.Point(on="right_tip"))
    L, R = state.frame("left_tip"), state.frame("right_tip")
    r = L.p - R.p
    across = np.array([np.cross(w, r) for w in R.J[3:].T]).T
    wanted = R.R.T @ (L.J[:3] - R.J[:3] - across)
    rows = rows_of(task, state)
    assert_allclose(rows.A, wanted, atol=ROUND_OFF)
    assert np.abs(rows.A[:, 7:]).max() > 0.1
    assert_allclose(rows.error, R.R.T @ r, atol=ROUND_OFF)


@each_constraint
def test_two_arms_of_one_model_hold_a_constraint_between_them(kind, monkeypatch):
    """Finite differences, with one feature on each arm."""
    monkeypatch.setitem(TIPS, "two arms", "left_tip")
    monkeypatch.setitem(MIDDLE, "two arms", "right_tip")
    rng = np.random.default_rng(13)
    state = random_state(two_arms(), rng, T0)
    subject = CATALOGUE[kind].make(state, rng, False, "robot")
    check_drift(subject, state)
    check_jacobian_of_rate(subject, state)


# ------------------------------------------------------------------- what errors mean


def test_a_point_off_a_circle_is_told_its_height_and_its_distance():
    p = home().frame(TIP).p
    circle = tasks.Circle(p + 0.3 * X - 0.05 * Z, 2.0 * Z, 0.2)
    error = rows_of(tasks.PointOnCircle(TIP, circle), home()).error
    assert_allclose(error, [0.05, 0.1], atol=ROUND_OFF)


def test_distances_are_measured_to_what_they_say():
    p = home().frame(TIP).p
    line, plane = tasks.Line(p + 0.3 * X + 9.0 * Z, Z), tasks.Plane(p - 0.1 * Z, Z)
    for task, wanted in (
        (tasks.DistanceToPoint(TIP, p + 0.3 * X + 0.4 * Y, 0.2), 0.3),
        (tasks.DistanceToLine(TIP, line, 0.2), 0.1),
        (tasks.DistanceToPlane(TIP, plane, -0.2), 0.3),
        (tasks.PointOnCylinder(TIP, tasks.Cylinder(p + 0.5 * X, Z, 0.1)), 0.4),
    ):
        assert_allclose(rows_of(task, home()).error, [wanted], atol=ROUND_OFF)


@pytest.mark.parametrize("angle", [1e-9, 1e-4, 0.5, np.pi / 2, 3.0, np.pi - 1e-9])
def test_angles_are_exact_from_end_to_end(angle):
    R = home().frame(TIP).R
    tool = tasks.Line(np.zeros(3), Z, on=TIP)
    turned = R @ (np.cos(angle) * Z + np.sin(angle) * X)
    task = tasks.AngleBetweenLines(tool, tasks.Line(X, turned), 1.0)
    assert_allclose(rows_of(task, home()).error, [angle - 1.0], atol=1e-12)


@pytest.mark.parametrize("direction", [Z, -Z])
@pytest.mark.parametrize("sense", ["same", "opposite", "nearest"])
def test_rows_of_parallel_and_angle_are_finite_where_lines_lie_along_each_other(
    direction, sense
):
    state = home(np.linspace(-1.0, 1.0, 7))
    tool = tasks.Line(np.zeros(3), Z, on=TIP)
    other = tasks.Line(X, state.frame(TIP).R @ direction)
    along = rows_of(tasks.ParallelLines(tool, other, sense=sense), state)
    same = (sense == "nearest") or (sense == "same") == (direction[2] > 0)
    assert np.linalg.norm(along.error) == pytest.approx(0.0 if same else np.pi)
    for task in (
        tasks.AngleBetweenLines(tool, other, 1.0),
        tasks.PerpendicularLines(tool, other),
    ):
        rows = rows_of(task, state)
        assert all(np.isfinite(array).all() for array in rows)
        assert np.linalg.norm(rows.A) > 0.1


def test_on_an_axis_a_distance_pushes_in_some_direction_and_stays_finite():
    state = home(np.linspace(-1.0, 1.0, 7))
    p = state.frame(TIP).p
    for task in (
        tasks.PointOnCircle(TIP, tasks.Circle(p, Z, 0.1)),
        tasks.DistanceToPoint(TIP, p, 0.1),
        tasks.DistanceToLine(TIP, tasks.Line(p, Z), 0.1),
    ):
        rows = rows_of(task, state)
        assert all(np.isfinite(array).all() for array in rows)
        assert np.linalg.norm(rows.A[-1]) > 0.1


def test_a_conveyor_goes_on_and_a_turntable_turns():
    frame = tasks.MovingFrame.steady([0.1, 0, 0], acceleration=[0, 0.2, 0], start=1.0)
    p = home().frame(TIP).p
    task = tasks.PointOnPoint(TIP, tasks.Point(p, on=frame))
    assert_allclose(rows_of(task, home(t=1.0)).error, 0.0, atol=ROUND_OFF)
    error = rows_of(task, home(t=3.0)).error
    assert_allclose(error, [-0.2, -0.4, 0.0], atol=ROUND_OFF)
    table = tasks.MovingFrame.steady(spin=[0, 0, np.pi / 2])
    task = tasks.PointOnPoint(TIP, tasks.Point(p, on=table))
    turned = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]]) @ p
    error = turned - p
    found = rows_of(task, home(t=1.0)).error
    assert np.linalg.norm(found) == pytest.approx(np.linalg.norm(error))


@pytest.mark.parametrize("away", [0.0, 1e-12, 1e-8, 1e-5, 1e-3])
def test_passing_an_axis_asks_for_no_more_than_a_share_of_the_radius_does(away):
    """v^2 / length would be 1e12 m/s^2 at the worst of these."""
    state = home(np.linspace(-1.0, 1.0, 7))
    F = state.frame(TIP)
    speed = float(np.linalg.norm(F.V[:3]))
    for task in (
        tasks.PointOnCircle(TIP, tasks.Circle(F.p + away * X, Z, 0.1)),
        tasks.DistanceToPoint(TIP, F.p + away * X, 0.1),
        tasks.DistanceToLine(TIP, tasks.Line(F.p + away * X, Z), 0.1),
    ):
        drift = rows_of(task, state).drift[-1]
        assert abs(drift) < np.linalg.norm(F.drift[:3]) + speed**2 / (0.01 * 0.1)
    n = F.R @ (np.cos(away) * Z + np.sin(away) * X)
    tool = tasks.Line(np.zeros(3), Z, on=TIP)
    drift = rows_of(tasks.PerpendicularLines(tool, tasks.Line(X, n)), state).drift
    spin = float(np.linalg.norm(F.V[3:]))
    assert abs(drift[0]) < np.linalg.norm(F.drift[3:]) + spin**2 / 0.01


# ------------------------------------------------------------------------- the rim


def test_a_rim_grasp_holds_with_seven_rows_where_the_gripper_stands_on_the_rim():
    state = home()
    F = state.frame(TIP)
    top, up = F.p - 0.03 * F.R[:, 1], -F.R[:, 2]
    level = tasks.rim_grasp(TIP, tasks.Cylinder(top, up, 0.03))
    assert isinstance(level, Level)
    rows = [rows_of(task, state) for task, _ in level.terms]
    assert_allclose(np.concatenate([row.error for row in rows]), 0.0, atol=1e-12)
    A = np.vstack([row.A for row in rows])
    assert A.shape == (7, 7)
    assert np.linalg.matrix_rank(A, tol=1e-9) == 5
    assert sum(task.rank for task, _ in level.terms) == 7


def test_a_rim_grasp_may_be_deeper_and_at_a_radius_of_its_own():
    state = home()
    F = state.frame(TIP)
    up = -F.R[:, 2]
    top = F.p - 0.05 * F.R[:, 1] + 0.02 * up
    level = tasks.rim_grasp(TIP, tasks.Cylinder(top, up, 0.03), radius=0.05, depth=0.02)
    for task, _ in level.terms:
        assert_allclose(rows_of(task, state).error, 0.0, atol=1e-12)


def test_a_gripper_with_skew_axes_is_refused():
    with pytest.raises(InputError, match=r"approach and closing .* right angle"):
        tasks.rim_grasp(TIP, tasks.Cylinder(X, Z, 0.1), approach=Z, closing=Z + X)


# ------------------------------------------------------------------------- bad input


@pytest.mark.parametrize(
    ("make", "offender"),
    [
        (lambda: tasks.Plane(X, 0 * X), "plane's normal has zero length"),
        (lambda: tasks.Line(X, 0 * X), "line's direction has zero length"),
        (lambda: tasks.Circle(X, 0 * X, 1.0), "circle's normal has zero length"),
        (lambda: tasks.Circle(X, Z, -1.0), "circle's radius must be .* got -1"),
        (lambda: tasks.Circle(X, Z, 0.0), "circle's radius must be .* got 0"),
        (lambda: tasks.Circle(np.nan * X, Z, 1.0), "circle's centre must be finite"),
        (lambda: tasks.Cylinder(X, 0 * X, 1.0), "cylinder's direction has zero"),
        (lambda: tasks.Cylinder(X, Z, np.nan), "cylinder's radius must be"),
        (lambda: tasks.Cylinder(np.nan * X, Z, 1.0), "cylinder's top must be finite"),
        (lambda: tasks.Point([np.inf, 0, 0]), "point's position must be finite"),
        (lambda: tasks.Point([1.0, 2.0]), "point's position has shape"),
        (lambda: tasks.Point(X, on=3), "a point is carried by a frame .* not by 3"),
        (lambda: tasks.DistanceToPoint(TIP, X, -0.1), "distance of 'tip distance to"),
        (lambda: tasks.DistanceToPoint(TIP, X, 0.0), "distance of 'tip distance to"),
        (
            lambda: tasks.DistanceToLine(TIP, tasks.Line(X, Z), np.nan),
            "distance of 'tip distance to line'",
        ),
        (
            lambda: tasks.DistanceToPlane(TIP, tasks.Plane(X, Z), np.inf),
            "distance of 'tip distance to plane' must be finite",
        ),
        (
            lambda: tasks.AngleBetweenLines(
                tasks.Line(X, Z, on=TIP), tasks.Line(X, Z), np.pi
            ),
            "angle of 'tip angle' must lie between 0 and pi.*ParallelLines",
        ),
        (lambda: tasks.MovingFrame(tasks.FrameMotion(twist=[1.0])), "twist of"),
        (
            lambda: tasks.MovingFrame.steady(orientation=2.0 * np.eye(3)),
            "orientation of 'conveyor' is not a rotation",
        ),
        (
            lambda: tasks.PointOnCurve(TIP, tasks.Line(X, Z, on="link3")),
            "'tip on curve' follows a path in the world, but 'link3' carries",
        ),
    ],
)
def test_a_degenerate_feature_is_refused_by_its_name(make, offender):
    with pytest.raises(InputError, match=offender):
        make()


def test_a_feature_of_another_kind_is_refused_by_what_is_needed():
    line, plane = tasks.Line(X, Z), tasks.Plane(X, Z)
    for make, kind in (
        (lambda: tasks.PointOnLine(TIP, plane), "a Line, not Plane"),
        (lambda: tasks.PointOnPlane(TIP, line), "a Plane, not Line"),
        (lambda: tasks.PointOnCircle(TIP, plane), "a Circle, not Plane"),
        (lambda: tasks.PointOnCylinder(TIP, line), "a Cylinder, not Line"),
        (lambda: tasks.DistanceToLine(TIP, [1, 0, 0], 0.1), "a Line, not list"),
        (lambda: tasks.LineInPlane(plane, plane), "a Line, not Plane"),
        (lambda: tasks.ParallelLines(line, TIP), "a Line, not str"),
        (lambda: tasks.PlaneOnPlane(plane, line), "a Plane, not Line"),
        (lambda: tasks.rim_grasp(TIP, line), "a Cylinder, not Line"),
    ):
        with pytest.raises(InputError, match=kind):
            make()
    with pytest.raises(InputError, match="point of 'tip on point' is not an array"):
        tasks.PointOnPoint(TIP, plane)


def test_a_cylinder_has_an_axis_and_a_rim_and_a_circle_a_plane():
    cylinder = tasks.Cylinder(X, 2.0 * Z, 0.1, on=TIP)
    assert_allclose(cylinder.axis.direction, Z)
    assert cylinder.rim.radius == 0.1
    circle = cylinder.rim
    assert_allclose(circle.plane.normal, Z)
    assert_allclose(circle.axis.point, X)
    assert {cylinder.axis.on, circle.on, circle.plane.on, circle.axis.on} == {TIP}


def test_a_relation_that_no_joint_can_change_is_refused():
    with pytest.raises(InputError, match="no joint moves any"):
        tasks.PointOnPoint(tasks.Point(X), Y)
    moving = tasks.MovingFrame()
    with pytest.raises(InputError, match="no joint moves any"):
        tasks.PointOnPoint(tasks.Point(on=moving), tasks.Point())
    with pytest.raises(InputError, match="same frame 'tip'"):
        tasks.PointOnPoint(TIP, tasks.Point(X, on=TIP))


def test_an_unknown_sense_is_refused_with_those_that_exist():
    tool = tasks.Line(X, Z, on=TIP)
    with pytest.raises(UnknownName, match=r"unknown sense 'up'.*same, opposite"):
        tasks.ParallelLines(tool, tasks.Line(X, Z), sense="up")


def test_a_carrier_that_the_robot_does_not_have_is_refused_at_binding():
    task = tasks.PointOnPoint(TIP, tasks.Point(X, on="linq3"))
    with pytest.raises(UnknownName, match=r"unknown frame 'linq3'.*'link3'"):
        Stack(seven_axis(), Hierarchy(task))


def test_a_frame_that_follows_a_function_cannot_be_set_and_others_keep_their_pose():
    led = tasks.MovingFrame(lambda t: tasks.FrameMotion([t, 0.0, 0.0]))
    with pytest.raises(InputError, match="function of time"):
        led.set(X)
    free = tasks.MovingFrame()
    with pytest.raises(InputError, match="position of 'moving frame'"):
        free.set([np.nan, 0, 0])
    assert_allclose(free.block[:3], 0.0)
