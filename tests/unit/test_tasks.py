"""Single tasks: their targets, their corners, and what they refuse."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import tasks
from tests.arms import seven_axis, six_axis
from tests.catalogue import CATALOGUE, MOTION, random_state
from tests.tolerances import CURVE, ROUND_OFF
from wbc import (
    PD,
    Controller,
    InputError,
    MotionTask,
    Rows,
    UnknownName,
    allocate_rows,
    resolve,
)
from wbc.rows import Space

ARM = seven_axis()
TIP = "tip"
HOME = ARM.q_home
X, Y, Z = np.eye(3)


def rows_of(task, state) -> Rows:
    rows = allocate_rows(len(task.row_names(state.robot)), state.robot.nv)
    task.check(state.robot)
    task.update(state, rows)
    return rows


def state(q=HOME, v=None, t: float = 0.0):
    return ARM.state(q, v, t)


# --------------------------------------------------------------- what holds for all


@pytest.mark.parametrize("kind", CATALOGUE, ids=lambda kind: kind.__name__)
def test_every_task_has_a_name_a_unit_and_a_name_for_every_row(kind):
    rng = np.random.default_rng(0)
    at = random_state(ARM, rng)
    task = CATALOGUE[kind].make(at, rng, False).task
    names = task.row_names(ARM)
    assert task.name
    assert task.unit
    assert task.space in Space.__args__
    assert len(set(names)) == len(names) > 0
    assert task.name in repr(task)
    assert kind.__name__ in repr(task)


@pytest.mark.parametrize("kind", MOTION, ids=lambda kind: kind.__name__)
def test_a_stiffness_for_each_row_must_fit_the_rows(kind):
    rng = np.random.default_rng(0)
    task = CATALOGUE[kind].make(random_state(ARM, rng), rng, False).task
    assert isinstance(task, MotionTask)
    m = len(task.row_names(ARM))
    task.law = PD(1.0, np.ones(m + 1))
    with pytest.raises(InputError, match=f"has {m} rows and {m + 1} values of damping"):
        task.check(ARM)


FRAMED = {
    "FramePosition": lambda f, **k: tasks.FramePosition(f, X, **k),
    "FrameOrientation": lambda f, **k: tasks.FrameOrientation(f, np.eye(3), **k),
    "FramePose": lambda f, **k: tasks.FramePose(f, X, np.eye(3), **k),
    "PointOnPoint": lambda f, **k: tasks.PointOnPoint(f, X, **k),
    "PointOnLine": lambda f, **k: tasks.PointOnLine(f, tasks.Line(X, Y), **k),
    "PointOnPlane": lambda f, **k: tasks.PointOnPlane(f, tasks.Plane(X, Y), **k),
    "PointOnCurve": lambda f, **k: tasks.PointOnCurve(f, tasks.Line(X, Y), **k),
    "AxisAlignment": lambda f, **k: tasks.AxisAlignment(f, X, **k),
    "AxisAlongPath": lambda f, **k: tasks.AxisAlongPath(f, tasks.Line(X, Y), **k),
}
framed = pytest.mark.parametrize("make", FRAMED.values(), ids=FRAMED)


@framed
def test_an_unknown_frame_is_refused_at_binding_with_those_that_exist(make):
    with pytest.raises(UnknownName, match=r"unknown frame 'tipp'.*'tip'.*link7"):
        Controller(ARM, make("tipp"))


@framed
@pytest.mark.parametrize("gain", ["stiffness", "damping"])
@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf])
def test_a_gain_that_is_negative_or_not_finite_is_refused(make, gain, value):
    with pytest.raises(InputError, match=f"{gain} must be finite and at least 0"):
        make(TIP, **{gain: value})


@framed
def test_damping_is_critical_by_default(make):
    law = make(TIP, stiffness=49.0).law
    assert law.damping == 14.0


@framed
def test_a_name_of_its_own_may_be_given(make):
    assert make(TIP, name="mine").name == "mine"


@pytest.mark.parametrize("gain", ["stiffness", "damping"])
@pytest.mark.parametrize("value", ["stiff", [[1.0, 2.0]], None])
def test_a_gain_that_is_no_row_of_numbers_is_refused(gain, value):
    if gain == "damping" and value is None:
        assert tasks.Posture(damping=None).law.damping == 10.0  # critical
        return
    with pytest.raises(InputError, match=gain):
        tasks.Posture(**{gain: value})


# ------------------------------------------------------------------------- targets

R90 = np.array(pin.exp3(0.5 * np.pi * Z))
MOVABLE = {
    "position": (tasks.FramePosition(TIP, X), (Y,)),
    "orientation": (tasks.FrameOrientation(TIP, np.eye(3)), (R90,)),
    "pose": (tasks.FramePose(TIP, X, np.eye(3)), (Y, R90)),
    "axis": (tasks.AxisAlignment(TIP, X), (Y,)),
    "posture": (tasks.Posture(HOME), (HOME + 0.1,)),
}
movable = pytest.mark.parametrize("case", MOVABLE)


@movable
def test_the_target_is_a_copy(case):
    task, target = MOVABLE[case]
    arrays = [np.array(value) for value in target]
    task.set_target(*arrays)
    before = rows_of(task, state()).error.copy()
    for array in arrays:
        array[:] = array[::-1] + 1.0
    assert_array_equal(rows_of(task, state()).error, before)


@movable
@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_bad_target_is_refused_and_leaves_the_old_one(case, bad):
    task, target = MOVABLE[case]
    task.set_target(*target)
    before = rows_of(task, state()).upper.copy()
    for i, value in enumerate(target):
        broken = [np.array(v) for v in target]
        broken[i] = np.full(value.shape, bad)
        with pytest.raises(InputError, match=f"'{task.name}'"):
            task.set_target(*broken)
    assert_array_equal(rows_of(task, state()).upper, before)


@movable
def test_a_target_of_the_wrong_shape_is_refused_and_leaves_the_old_one(case):
    task, target = MOVABLE[case]
    task.set_target(*target)
    before = rows_of(task, state()).upper.copy()
    with pytest.raises(InputError, match=f"'{task.name}' has shape"):
        task.set_target(*(np.zeros(5) for _ in target))
    assert_array_equal(rows_of(task, state()).upper, before)


@pytest.mark.parametrize("case", ["position", "orientation", "pose", "axis"])
@pytest.mark.parametrize("which", [0, 1])
def test_a_bad_target_motion_is_refused_and_leaves_the_old_target(case, which):
    task, target = MOVABLE[case]
    task.set_target(*target)
    before = rows_of(task, state()).upper.copy()
    size = 6 if case == "pose" else 3
    motion = [np.ones(size), np.ones(size)]
    motion[which] = np.full(size, np.nan)
    with pytest.raises(InputError, match=r"target (velocity|acceleration|twist)"):
        task.set_target(*target, *motion)
    assert_array_equal(rows_of(task, state()).upper, before)


@pytest.mark.parametrize(
    "R", [2.0 * np.eye(3), np.diag([1.0, 1.0, -1.0]), np.ones((3, 3)), np.zeros((3, 3))]
)
def test_a_target_that_is_no_rotation_is_refused(R):
    with pytest.raises(InputError, match="is not a rotation matrix"):
        tasks.FrameOrientation(TIP, R)
    with pytest.raises(InputError, match="is not a rotation matrix"):
        tasks.FramePose(TIP, X, R)


def test_a_reflection_is_called_one():
    with pytest.raises(InputError, match="a reflection: its determinant is -1"):
        tasks.FrameOrientation(TIP, np.eye(3)).set_target(np.diag([1.0, 1.0, -1.0]))


@pytest.mark.parametrize("odd", [1j * np.ones(3), np.zeros(3, "datetime64[s]")])
def test_a_target_that_numpy_would_bend_into_numbers_is_refused(odd):
    task = tasks.FramePosition(TIP, X)
    with pytest.raises(InputError, match=r"target of .* is not an array"):
        task.set_target(odd)
    with pytest.raises(InputError, match="stiffness"):
        tasks.FramePosition(TIP, X, stiffness=odd)
    with pytest.raises(InputError, match="must be a number"):
        tasks.JointLimits(margin=odd[0])


def test_a_still_target_is_what_a_new_one_is():
    task = tasks.FramePosition(TIP, X)
    task.set_target(X, Y, Z)
    task.set_target(X)
    assert_array_equal(rows_of(task, state()).rate, np.zeros(3))


def test_a_moving_target_is_fed_forward():
    task = tasks.FramePosition(TIP, state().frame(TIP).p, stiffness=0.0)
    task.set_target(state().frame(TIP).p, np.zeros(3), [0.1, 0.2, 0.3])
    solution = resolve(state(), task >> tasks.Posture())
    assert_allclose(state().frame(TIP).J[:3] @ solution.acceleration, [0.1, 0.2, 0.3])


# -------------------------------------------------------------------------- posture


def test_the_posture_is_home_by_default():
    assert_array_equal(rows_of(tasks.Posture(), state()).error, np.zeros(7))


def test_a_posture_may_name_its_joints():
    task = tasks.Posture([0.5, -0.5], joints=["a4", "a2"])
    rows = rows_of(task, state())
    assert task.row_names(ARM) == ("a4", "a2")
    assert_allclose(rows.error, HOME[[3, 1]] - [0.5, -0.5])
    assert_array_equal(np.argmax(rows.J, axis=1), [3, 1])


def test_a_posture_of_the_wrong_size_is_refused_at_binding():
    with pytest.raises(InputError, match="has 6 values, but robot 'seven' needs 7"):
        Controller(ARM, tasks.Posture(np.zeros(6)))


def test_a_posture_for_some_joints_of_the_wrong_size_is_refused_at_binding():
    with pytest.raises(InputError, match="has 3 values, but robot 'seven' needs 2"):
        Controller(ARM, tasks.Posture(np.zeros(3), joints=["a1", "a2"]))


@pytest.mark.parametrize("target", [np.nan, [[0.0] * 7], [np.nan] * 7])
def test_a_posture_that_is_no_vector_of_numbers_is_refused(target):
    with pytest.raises(InputError, match="target of 'posture'"):
        tasks.Posture(target)


@pytest.mark.parametrize("kind", [tasks.Posture, tasks.Damping])
def test_an_unknown_joint_is_refused_at_binding_with_those_that_exist(kind):
    with pytest.raises(UnknownName, match=r"unknown joint 'a9'.*a1, a2"):
        Controller(ARM, kind(joints=["a9"]))


def test_damping_takes_the_speed_away_at_its_rate():
    v = np.arange(7.0)
    solution = resolve(state(v=v), tasks.Damping(3.0))
    assert_allclose(solution.acceleration, -3.0 * v, atol=1e-12)


@pytest.mark.parametrize("rate", [-1.0, np.nan, np.inf])
def test_a_damping_that_is_negative_or_not_finite_is_refused(rate):
    with pytest.raises(InputError, match="damping must be finite and at least 0"):
        tasks.Damping(rate)


# ----------------------------------------------------------------- axes and rotations


def axis_error(direction, axis=Z) -> np.ndarray:
    return rows_of(tasks.AxisAlignment(TIP, direction, axis=axis), state()).error


def axis_now(axis=Z) -> np.ndarray:
    return state().frame(TIP).R @ axis


def test_an_aligned_axis_has_no_error():
    assert_allclose(axis_error(axis_now()), [0.0, 0.0], atol=1e-12)


@pytest.mark.parametrize("angle", [1e-9, 1e-3, 0.5, 2.0, 3.0, np.pi - 1e-6])
def test_the_axis_error_is_the_angle(angle):
    R = state().frame(TIP).R
    direction = R @ np.array(pin.exp3(angle * X)) @ Z
    assert_allclose(np.linalg.norm(axis_error(direction)), angle, rtol=1e-9, atol=1e-12)


def test_an_opposite_axis_is_half_a_turn_away():
    error = axis_error(-axis_now())
    assert np.linalg.norm(error) == pytest.approx(np.pi)


@pytest.mark.parametrize("tilt", [0.0, 1e-15, 1e-9])
def test_an_opposite_axis_is_turned_over(tilt):
    a = axis_now()
    direction = -a + tilt * state().frame(TIP).R @ X
    task = tasks.AxisAlignment(TIP, direction, stiffness=400.0)
    control = Controller(ARM, task >> tasks.Damping(), dt=2e-3)
    q, v = HOME.copy(), np.zeros(7)
    for _ in range(500):
        v = v + 2e-3 * control(q, v).acceleration
        q = q + 2e-3 * v
    assert_allclose(ARM.state(q).frame(TIP).R @ Z, -a, atol=1e-3)


@pytest.mark.parametrize("spin", [0.3, 1.0, 2.5])
def test_turning_about_the_axis_changes_no_error(spin):
    # the tip's z axis is that of the last joint
    direction = np.array([0.3, 0.5, 0.8])
    task = tasks.AxisAlignment(TIP, direction)
    turned = HOME.copy()
    turned[6] += spin
    one, two = rows_of(task, state()), rows_of(task, state(turned))
    assert np.linalg.norm(one.error) == pytest.approx(np.linalg.norm(two.error))
    assert_allclose(one.J[:, 6], 0.0, atol=1e-12)


def test_the_axis_need_not_be_of_unit_length():
    assert_allclose(axis_error(5.0 * X, 3.0 * Y), axis_error(X, Y), atol=ROUND_OFF)


@pytest.mark.parametrize("bad", [np.zeros(3), [np.nan, 0, 0], [1.0, 0.0]])
def test_a_direction_that_is_none_is_refused(bad):
    with pytest.raises(InputError, match="direction of 'tip axis'"):
        tasks.AxisAlignment(TIP, bad)
    with pytest.raises(InputError, match="axis of 'tip axis'"):
        tasks.AxisAlignment(TIP, X, axis=bad)


def test_the_orientation_error_is_the_rotation_from_target_to_frame():
    R = state().frame(TIP).R
    w = np.array([0.3, -0.4, 0.5])
    task = tasks.FrameOrientation(TIP, np.array(pin.exp3(w)).T @ R)
    assert_allclose(rows_of(task, state()).error, w, atol=1e-12)


def test_the_orientation_error_of_half_a_turn_is_half_a_turn():
    R = state().frame(TIP).R
    task = tasks.FrameOrientation(TIP, np.diag([1.0, -1.0, -1.0]) @ R)
    assert_allclose(np.abs(rows_of(task, state()).error), [np.pi, 0, 0], atol=1e-6)


def test_angles_along_a_path_that_are_not_finite_are_refused():
    line = tasks.Line(X, Y)
    for angles in ({"work": np.nan}, {"travel": np.inf}):
        with pytest.raises(InputError, match="angle of 'tip along path'"):
            tasks.AxisAlongPath(TIP, line, **angles)


# ------------------------------------------------------------------- lines and planes


def test_the_error_on_a_line_is_the_distance_from_it():
    p = state().frame(TIP).p
    line = tasks.Line(p + 0.03 * X + 0.04 * Y, Z)
    error = rows_of(tasks.PointOnLine(TIP, line), state()).error
    assert np.linalg.norm(error) == pytest.approx(0.05)


def test_the_error_on_a_plane_is_the_signed_distance():
    p = state().frame(TIP).p
    plane = tasks.Plane(p - 0.02 * Z, 3.0 * Z)
    error = rows_of(tasks.PointOnPlane(TIP, plane), state()).error
    assert error[0] == pytest.approx(0.02)


def test_a_point_beside_a_line_is_drawn_to_it_and_a_point_off_a_plane_as_well():
    p = state().frame(TIP).p
    on_line = tasks.PointOnLine(TIP, tasks.Line(p + 0.1 * X, Z))
    on_plane = tasks.PointOnPlane(TIP, tasks.Plane(p + 0.1 * Z, Z))
    a = resolve(state(), on_line + on_plane >> tasks.Posture()).acceleration
    assert_allclose(state().frame(TIP).J[:3] @ a, [10.0, 0.0, 10.0], atol=1e-9)


@pytest.mark.parametrize("kind", [tasks.Line, tasks.Plane])
@pytest.mark.parametrize("bad", [np.zeros(3), [np.nan, 0, 0], [np.inf, 0, 0], [1.0]])
def test_a_line_or_plane_without_direction_is_refused(kind, bad):
    with pytest.raises(InputError, match=r"(direction|normal)"):
        kind(X, bad)


@pytest.mark.parametrize("kind", [tasks.Line, tasks.Plane])
def test_a_line_or_plane_without_a_finite_point_is_refused(kind):
    with pytest.raises(InputError, match="point must be finite"):
        kind([np.nan, 0, 0], X)


@pytest.mark.parametrize("length", [0.0, -1.0, np.nan])
def test_a_line_of_no_length_is_refused(length):
    with pytest.raises(InputError, match="length must be finite and greater than 0"):
        tasks.Line(X, Y, length)


def test_a_segment_between_coinciding_points_is_refused():
    with pytest.raises(InputError, match="zero length"):
        tasks.Line.between(X, X)


def test_a_segment_knows_its_length_and_its_ends():
    line = tasks.Line.between(X, X + 0.5 * Y)
    assert line.length == pytest.approx(0.5)
    assert_allclose(line.at(line.length).c[0], X + 0.5 * Y)
    assert line.locate(X + 0.2 * Y + 3.0 * Z) == pytest.approx(0.2)


def test_the_point_of_a_task_that_is_not_finite_is_refused():
    with pytest.raises(InputError, match="point of 'tip on point' must be finite"):
        tasks.PointOnPoint(TIP, [np.nan, 0, 0])


# --------------------------------------------------------------------- travel speed


def travel(**options) -> tasks.TravelSpeed:
    """Along x through the tip, which stands at s = 0.2 of 1 m."""
    line = tasks.Line(state().frame(TIP).p - 0.2 * X, X, 1.0)
    return tasks.TravelSpeed(TIP, line, **({"speed": 0.1, "ramp": 0.5} | options))


def wanted(t: float, **options) -> float:
    """The reference speed at time t, for a robot at rest."""
    return -float(rows_of(travel(**options), state(t=t)).error[0])


def test_the_speed_rises_from_rest():
    assert wanted(-1.0) == 0.0
    assert wanted(0.0) == 0.0
    assert wanted(0.25) == pytest.approx(0.05)
    assert wanted(0.5) == pytest.approx(0.1)
    assert wanted(9.0) == pytest.approx(0.1)


def test_the_speed_rises_from_its_start_on():
    assert wanted(3.0, start=3.0) == 0.0
    assert wanted(3.25, start=3.0) == pytest.approx(0.05)


def test_the_speed_never_falls_while_it_rises():
    speeds = [wanted(t) for t in np.linspace(0.0, 0.5, 21)]
    assert (np.diff(speeds) > 0).all()


def test_the_rise_is_smooth_at_both_ends():
    h = 1e-4
    for t in (0.0, 0.5):
        assert abs(wanted(t + h) - wanted(t - h)) / (2 * h) < 1e-5


def test_the_speed_falls_towards_the_end_and_vanishes_there():
    assert wanted(9.0, end=0.2 + 0.05) == pytest.approx(0.1)
    assert 0.0 < wanted(9.0, end=0.2 + 0.01) < 0.1
    assert wanted(9.0, end=0.2) == pytest.approx(0.0, abs=1e-12)


def test_beyond_its_end_it_creeps_back():
    assert -0.1 <= wanted(9.0, end=0.15) < 0.0


def test_it_travels_to_its_end_and_stops_there():
    speed = travel(end=0.25)
    on_line = tasks.PointOnLine(TIP, speed.path, stiffness=400.0)
    control = Controller(ARM, on_line >> speed >> tasks.Damping(), dt=2e-3)
    q, v, fastest, furthest = HOME.copy(), np.zeros(7), 0.0, 0.0
    for k in range(1500):
        v = v + 2e-3 * control(q, v, k * 2e-3).acceleration
        q = q + 2e-3 * v
        F = ARM.state(q, v).frame(TIP)
        fastest = max(fastest, F.V[0])
        furthest = max(furthest, speed.path.locate(F.p))
    assert furthest <= 0.25 + 1e-4
    assert speed.path.locate(F.p) == pytest.approx(0.25, abs=1e-3)
    assert abs(F.V[0]) < 1e-3
    assert fastest <= 0.1 + 1e-3


def test_an_endless_line_has_no_end_stop():
    task = tasks.TravelSpeed(TIP, tasks.Line(X, Y), speed=0.1)
    assert -rows_of(task, state(t=9.0)).error[0] == pytest.approx(0.1)


@pytest.mark.parametrize("option", ["speed", "ramp", "gain", "end"])
@pytest.mark.parametrize("value", [0.0, -0.1, np.nan, np.inf])
def test_numbers_of_the_travel_that_are_not_positive_are_refused(option, value):
    with pytest.raises(InputError, match=f"{option} must be finite and greater than 0"):
        travel(**{option: value})


@pytest.mark.parametrize("value", [np.nan, np.inf, "now"])
def test_a_start_that_is_not_finite_is_refused(value):
    with pytest.raises(InputError, match="start"):
        travel(start=value)


def test_an_end_beyond_the_path_is_refused():
    with pytest.raises(
        InputError, match=r"should stop at 1\.5 m, but its path ends at 1"
    ):
        travel(end=1.5)


# --------------------------------------------------------------------------- curves

TURN = np.linspace(0.0, 1.5 * np.pi, 60)


def circle(radius: float = 0.3, **options) -> tasks.Curve:
    points = [radius * np.cos(TURN), radius * np.sin(TURN), 0.0 * TURN]
    return tasks.Curve(np.stack(points, axis=1), **options)


def helix(radius: float = 0.2, pitch: float = 0.1) -> tasks.Curve:
    """Pitch per radian."""
    points = [radius * np.cos(TURN), radius * np.sin(TURN), pitch * TURN]
    return tasks.Curve(np.stack(points, axis=1))


def along(curve: tasks.Curve, count: int = 37) -> np.ndarray:
    return np.linspace(0.0, curve.length, count)


def test_the_length_of_a_circle_is_radius_times_angle():
    assert circle().length == pytest.approx(0.3 * TURN[-1], rel=CURVE)


def test_the_length_of_a_helix_is_its_closed_form():
    expected = np.hypot(0.2, 0.1) * TURN[-1]
    assert helix().length == pytest.approx(expected, rel=CURVE)


def test_a_curve_is_parametrised_by_arc_length():
    for curve in (circle(), helix()):
        speed = [np.linalg.norm(curve.at(s).c[1]) for s in along(curve)]
        assert_allclose(speed, 1.0, rtol=1e-6)


def test_positions_on_a_circle_are_where_arc_length_puts_them():
    curve = circle()
    for s in along(curve):
        expected = 0.3 * np.array([np.cos(s / 0.3), np.sin(s / 0.3), 0.0])
        assert_allclose(curve.at(s).c[0], expected, atol=1e-7)


def test_the_bend_of_a_circle_is_one_over_its_radius():
    curve = circle()
    for s in along(curve)[2:-2]:
        assert np.linalg.norm(curve.at(s).c[2]) == pytest.approx(1 / 0.3, rel=1e-4)


def test_the_frame_of_a_curve_is_right_handed_and_orthonormal():
    for curve in (circle(), helix(), circle(normals=Z)):
        for s in along(curve):
            point = curve.at(s)
            triad = np.stack([point.c[1], point.n1[0], point.n2[0]])
            assert_allclose(triad @ triad.T, np.eye(3), atol=1e-6)
            assert np.linalg.det(triad) > 0


def test_normals_follow_those_that_are_given():
    curve = circle(normals=Z)
    for s in along(curve):
        assert_allclose(curve.at(s).n1[0], Z, atol=1e-7)


def test_normals_of_a_plane_curve_do_not_turn_about_it():
    curve = circle()
    out_of_plane = [abs(curve.at(s).n1[0] @ Z) for s in along(curve)]
    assert_allclose(out_of_plane, out_of_plane[0], atol=1e-6)


def test_normals_are_smooth_along_the_curve():
    for curve in (helix(), circle(normals=Z)):
        s = np.linspace(0.0, curve.length, 1000)
        n1 = np.array([curve.at(x).n1[0] for x in s])
        steps = np.linalg.norm(np.diff(n1, axis=0), axis=1)
        assert steps.max() < 20.0 * curve.length / 1000


@pytest.mark.parametrize("column", ["c", "n1", "n2"])
def test_the_derivatives_along_a_curve_are_those_of_differences(column):
    h = 1e-5
    curve = helix()
    for s in along(curve)[1:-1]:
        up, down, here = (getattr(curve.at(x), column) for x in (s + h, s - h, s))
        slope = (up[:3] - down[:3]) / (2 * h)
        size = 1.0 + np.abs(here).max(axis=1)[1:, None]
        assert_allclose(slope / size, here[1:] / size, atol=2e-4)


def test_the_nearest_point_of_a_circle_is_on_the_ray_from_its_centre():
    curve = circle()
    for angle in np.linspace(0.2, 4.4, 23):
        ray = np.array([np.cos(angle), np.sin(angle), 0.0])
        for radius in (0.25, 0.3, 0.4):
            s = curve.locate(radius * ray + 0.05 * Z)
            assert s == pytest.approx(0.3 * angle, abs=1e-6)


def test_beyond_its_ends_a_curve_goes_on_straight():
    curve = circle()
    point = curve.at(curve.length + 0.1)
    end = curve.at(curve.length)
    assert_allclose(point.c[0], end.c[0] + 0.1 * end.c[1], atol=ROUND_OFF)
    assert_allclose(point.c[2:], 0.0)
    assert curve.locate(point.c[0]) == pytest.approx(curve.length + 0.1, abs=1e-9)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (np.zeros((3, 3)), "at least 6 points"),
        (np.zeros((9, 2)), "at least 6 points"),
        (np.zeros(9), "at least 6 points"),
        (np.full((9, 3), np.nan), "points must be finite"),
        (np.zeros((9, 3)), "neighbouring points of a curve must not coincide"),
    ],
)
def test_points_that_make_no_curve_are_refused(points, message):
    with pytest.raises(InputError, match=message):
        tasks.Curve(points)


def test_normals_along_the_curve_are_refused():
    straight = np.linspace(0, 1, 9)[:, None] * X
    with pytest.raises(InputError, match="points along it somewhere"):
        tasks.Curve(straight, normals=X)


@pytest.mark.parametrize("normals", [np.ones((5, 3)), np.full(3, np.nan), [1.0, 2.0]])
def test_normals_of_the_wrong_shape_or_not_finite_are_refused(normals):
    with pytest.raises(InputError, match="the curve's normals"):
        circle(normals=normals)


# --------------------------------------------------------------------------- limits


def test_torque_limits_are_the_robots():
    rows = rows_of(tasks.TorqueLimits(), state())
    assert_array_equal(rows.upper, ARM.tau_max)
    assert_array_equal(rows.lower, -ARM.tau_max)
    assert_array_equal(rows.A, np.eye(7))


def test_joint_bounds_at_rest_in_the_middle_are_the_acceleration_limits():
    rows = rows_of(tasks.JointLimits(), state(np.zeros(7)))
    assert_array_equal(rows.upper, ARM.a_max)
    assert_array_equal(rows.lower, -ARM.a_max)


@pytest.mark.parametrize("integrator", ["semi-implicit", "exact"])
def test_joint_bounds_never_cross(integrator):
    rng = np.random.default_rng(0)
    task = tasks.JointLimits(integrator=integrator)
    arm = six_axis()
    for _ in range(300):
        q = rng.uniform(arm.q_min - 0.2, arm.q_max + 0.2)
        v = rng.uniform(-1.3, 1.3, arm.nv) * arm.v_max
        rows = rows_of(task, arm.state(q, v))
        assert (rows.lower <= rows.upper).all()
        assert (np.abs([rows.lower, rows.upper]) <= arm.a_max * (1 + 1e-12)).all()
