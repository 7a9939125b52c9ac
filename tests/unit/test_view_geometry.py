"""What is drawn over a cell: the geometry of tasks, their errors, forces and words."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

import tasks
from robots import racer
from sims import constraints
from sims.view import Connector, Solid, geometry_of
from sims.view.forces import (
    LEAST,
    LONGEST,
    SCALE,
    Contacts,
    felt,
    pulled,
    pushed,
)
from sims.view.marks import MET as GREEN
from sims.view.marks import MET_LENGTH, MISSED, RANGE, TARGET, ball, line, shade
from sims.view.painting import paint
from tests.arms import ROBOTS, six_axis
from tests.catalogue import CATALOGUE, random_state
from wbc import Task, allocate_rows

TIP = "torch_tip"
UP = np.array([0.0, 0.0, 1.0])
WITHOUT = (tasks.Clearance, tasks.Admittance)
"""No error where the distance is kept; an error from where forces let it be."""
KEY_UP, KEY_PAGE_DOWN = 265, 267


@pytest.fixture
def state():
    return random_state(six_axis(), np.random.default_rng(3))


def numbers(mark) -> np.ndarray:
    if isinstance(mark, Connector):
        return np.concatenate([mark.a, mark.b, [mark.radius], mark.colour])
    return np.concatenate([mark.p, mark.size, mark.R.ravel(), mark.colour])


# ------------------------------------------------------------------ geometry of tasks


@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("kind", CATALOGUE, ids=lambda kind: kind.__name__)
def test_every_task_is_drawn_with_an_error_line_as_long_as_its_error(kind, robot):
    rng = np.random.default_rng(8)
    for _ in range(3):
        at = random_state(ROBOTS[robot](), rng)
        task = CATALOGUE[kind].make(at, rng, False).task
        marks = geometry_of(task, at)
        assert all(np.isfinite(numbers(mark)).all() for mark in marks)
        rows = allocate_rows(len(task.row_names(at.robot)), at.robot.nv)
        task.update(at, rows)
        units = np.array(task.row_units(rows.error.size))
        metres = rows.error[units == "m"]
        if issubclass(kind, WITHOUT) or not metres.size:
            continue
        lengths = [mark.length for mark in marks if isinstance(mark, Connector)]
        assert np.isclose(lengths, np.linalg.norm(metres), rtol=0.0, atol=1e-9).any()


def test_tasks_of_joints_have_no_geometry(state):
    for task in (tasks.Posture(), tasks.Damping(), tasks.TorqueLimits()):
        assert geometry_of(task, state) == []


def test_a_task_of_an_unknown_kind_shows_its_frames(state):
    class Own(Task):
        def row_names(self, robot):
            return ()

        def update(self, state, rows):
            """Nothing to write."""

    (mark,) = geometry_of(Own("own", "m", (TIP,)), state)
    np.testing.assert_allclose(mark.p, state.frame(TIP).p)


def test_a_line_is_drawn_where_it_is(state):
    point, direction = np.array([0.5, 0.1, 0.3]), np.array([0.6, 0.0, 0.8])
    task = tasks.PointOnLine(TIP, tasks.Line(point, direction))
    shown, error, tip = geometry_of(task, state)
    for end in (shown.a, shown.b, error.b):
        np.testing.assert_allclose(np.cross(end - point, direction), 0.0, atol=1e-12)
    np.testing.assert_allclose((error.b - error.a) @ direction, 0.0, atol=1e-12)
    np.testing.assert_allclose(tip.p, state.frame(TIP).p)
    assert shown.colour == TARGET


def test_a_plane_is_drawn_under_the_point(state):
    plane = tasks.Plane([0.0, 0.0, 0.4], [0.0, 0.6, 0.8])
    sheet, error, _ = geometry_of(tasks.PointOnPlane(TIP, plane), state)
    p = state.frame(TIP).p
    foot = p - plane.distance(p) * plane.normal
    np.testing.assert_allclose(sheet.p, foot, atol=1e-12)
    np.testing.assert_allclose(sheet.R[:, 2], plane.normal, atol=1e-12)
    np.testing.assert_allclose(sheet.R.T @ sheet.R, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(error.b, foot, atol=1e-12)


def test_a_circle_is_drawn_around_its_centre(state):
    circle = tasks.Circle([0.5, 0.0, 0.4], UP, 0.2)
    *ring, error, _ = geometry_of(tasks.PointOnCircle(TIP, circle), state)
    for side in ring:
        assert np.linalg.norm(side.a - circle.centre) == pytest.approx(0.2)
        assert side.a[2] == pytest.approx(0.4)
    np.testing.assert_allclose(ring[0].a, ring[-1].b, atol=1e-12)
    out = state.frame(TIP).p - circle.centre
    out[2] = 0.0
    nearest = circle.centre + 0.2 * out / np.linalg.norm(out)
    np.testing.assert_allclose(error.b, nearest, atol=1e-12)


def test_a_cylinder_is_drawn_on_its_axis_beside_the_point(state):
    can = tasks.Cylinder([0.5, 0.1, 0.4], UP, 0.15)
    tube, _, _ = geometry_of(tasks.PointOnCylinder(TIP, can), state)
    np.testing.assert_allclose(tube.p, [0.5, 0.1, state.frame(TIP).p[2]], atol=1e-12)
    assert (tube.shape, tube.size[0]) == ("tube", 0.15)


def test_a_sphere_is_drawn_around_a_point(state):
    task = tasks.DistanceToPoint(TIP, [0.5, 0.1, 0.4], 0.15)
    sphere, centre, *_ = geometry_of(task, state)
    np.testing.assert_allclose([sphere.p, centre.p], [[0.5, 0.1, 0.4]] * 2)
    np.testing.assert_allclose(sphere.size, 0.15)


def test_features_on_a_moving_frame_are_drawn_where_it_is():
    belt = tasks.MovingFrame.steady([0.2, 0.0, 0.0], position=[0.4, 0.0, 0.3])
    task = tasks.PointOnPoint(TIP, tasks.Point([0.0, 0.1, 0.0], on=belt))
    q = six_axis().q_home
    for t in (0.0, 1.5):
        goal, *_ = geometry_of(task, six_axis().state(q, t=t))
        np.testing.assert_allclose(goal.p, [0.4 + 0.2 * t, 0.1, 0.3], atol=1e-12)


@pytest.mark.parametrize("sense", ["same", "opposite", "nearest"])
def test_a_direction_is_drawn_with_its_sense(state, sense):
    axis = tasks.Line([0.0, 0.0, 0.0], UP, on=TIP)
    wall = tasks.Line([0.0, 0.0, 0.0], [1.0, 0.0, 0.0])
    marks = geometry_of(tasks.ParallelLines(axis, wall, sense=sense), state)
    wanted, actual = (m.b - m.a for m in marks)
    z = state.frame(TIP).R[:, 2]
    sign = {"same": 1.0, "opposite": -1.0, "nearest": np.sign(z[0])}[sense]
    np.testing.assert_allclose(np.cross(wanted, [1, 0, 0]), 0.0, atol=1e-12)
    assert np.sign(wanted[0]) == sign
    np.testing.assert_allclose(actual / np.linalg.norm(actual), z, atol=1e-12)


def test_a_constraint_carried_by_the_robot_points_at_the_robots_own_feature(state):
    """The first feature stands in the world, as in a grasp at the rim."""
    axis = tasks.Line([0.6, 0.0, 0.3], UP)
    tool = tasks.Line([0.0, 0.0, 0.0], UP, on=TIP)
    marks = geometry_of(tasks.ParallelLines(axis, tool), state)
    middles = [0.5 * (m.a + m.b) for m in marks]
    np.testing.assert_allclose(middles, [state.frame(TIP).p] * 2, atol=1e-12)


def test_travel_shows_the_way_of_a_second(state):
    path = tasks.Line.between([0.4, -0.2, 0.4], [0.4, 0.3, 0.4])
    *way, speed = geometry_of(tasks.TravelSpeed(TIP, path, speed=0.1), state)
    assert [w.length for w in way] == pytest.approx([0.5])
    along = state.frame(TIP).V[1]
    np.testing.assert_allclose(speed.b - speed.a, [0.0, along, 0.0], atol=1e-9)


# ----------------------------------------------------------------- colours and forces


def test_an_error_is_green_when_met_and_red_from_twenty_times_that_on():
    assert shade(0.0, MET_LENGTH)[:3] == shade(MET_LENGTH, MET_LENGTH)[:3]
    np.testing.assert_allclose(shade(MET_LENGTH, MET_LENGTH)[:3], GREEN)
    np.testing.assert_allclose(shade(RANGE * MET_LENGTH, MET_LENGTH)[:3], MISSED)
    np.testing.assert_allclose(shade(1.0, MET_LENGTH)[:3], MISSED)
    reds = [shade(x * MET_LENGTH, MET_LENGTH)[0] for x in (1, 2, 5, 10, 20)]
    assert reds == sorted(reds)
    assert len(set(reds)) == 5


def test_a_force_is_an_arrow_of_its_length_up_to_the_longest():
    p = np.array([0.1, 0.2, 0.3])
    (arrow,) = pushed(p, np.array([0.0, 20.0, 0.0]), TARGET, 0.004)
    np.testing.assert_allclose(p - arrow.a, [0.0, 20.0 * SCALE, 0.0])
    np.testing.assert_allclose(arrow.b, p)
    assert arrow.label == "20 N"
    (longest,) = pulled(p, 1e4 * UP, TARGET, 0.004)
    np.testing.assert_allclose(longest.b - p, LONGEST * UP)
    assert pushed(p, 0.9 * LEAST * UP, TARGET, 0.004) == []
    assert pulled(p, np.full(3, np.nan), TARGET, 0.004) == []


def test_a_task_on_force_shows_it_where_it_presses(state):
    axes = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    p = state.frame(TIP).p
    task = tasks.HybridForceMotion(TIP, p + 0.1, [0.0, 0.0, 20.0], axes=axes)
    goal, error, _, push = geometry_of(task, state)
    np.testing.assert_allclose(push.b - push.a, [20.0 * SCALE, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose([goal.p, error.b], [p + np.array([0.0, 0.1, 0.1])] * 2)


def test_what_a_wrist_feels_is_drawn_at_its_sensor():
    cell = constraints.cell(racer.load("probe"))
    wrench = np.array([0.0, 0.0, -10.0, 1.0, 2.0, 3.0])
    (arrow,) = felt(cell.data, cell.wrists, {"wrist": wrench})
    np.testing.assert_allclose(arrow.a, cell.data.site("wrist_sensor").xpos)
    np.testing.assert_allclose(arrow.b - arrow.a, -10.0 * SCALE * UP, atol=1e-12)
    assert felt(cell.data, cell.wrists, {}) == []


def test_what_lies_on_the_floor_presses_with_its_weight_and_looking_changes_nothing():
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><geom type="plane" size="1 1 1"/><body pos="0.3 0 0.05">'
        '<freejoint/><geom type="box" size="0.1 0.1 0.05" mass="2"/></body>'
        "</worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    contacts = Contacts(model)
    for _ in range(500):
        mujoco.mj_step2(model, data)
        mujoco.mj_step1(model, data)
    before = [getattr(data, n).copy() for n in ("qpos", "qvel", "qacc", "efc_force")]
    (arrow,) = contacts.marks(data)
    after = [getattr(data, n) for n in ("qpos", "qvel", "qacc", "efc_force")]
    for was, now in zip(before, after, strict=True):
        np.testing.assert_array_equal(was, now)
    np.testing.assert_allclose(arrow.b - arrow.a, -2 * 9.81 * SCALE * UP, atol=1e-4)
    np.testing.assert_allclose(arrow.b, [0.3, 0.0, 0.0], atol=2e-3)


def test_nothing_is_drawn_where_nothing_touches():
    model = mujoco.MjModel.from_xml_string("<mujoco><worldbody/></mujoco>")
    assert Contacts(model).marks(mujoco.MjData(model)) == []


# --------------------------------------------------------------------- into the scene


def test_marks_land_in_the_scene_as_they_are_up_to_its_room():
    model = mujoco.MjModel.from_xml_string("<mujoco><worldbody/></mujoco>")
    scene = mujoco.MjvScene(model, maxgeom=4)
    p, colour = np.array([0.1, 0.2, 0.3]), (0.1, 0.2, 0.3, 0.4)
    turned = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    tube = Solid("tube", p, np.array([0.05, 0.2, 0.0]), colour, turned, "a tube")
    marks = [ball(p, colour, 0.02), tube, line(p, p + 0.5 * UP, colour, 0.004)]
    paint(scene, [*marks, *marks])
    assert scene.ngeom == 4
    sphere, cylinder, connector = (scene.geoms[i] for i in range(3))
    np.testing.assert_allclose(sphere.pos, p)
    np.testing.assert_allclose(sphere.size, 0.02)
    np.testing.assert_allclose(sphere.rgba, colour, atol=1e-7)
    np.testing.assert_allclose(cylinder.size, [0.05, 0.05, 0.2])
    np.testing.assert_allclose(cylinder.mat, turned, atol=1e-7)
    assert cylinder.label == "a tube"
    np.testing.assert_allclose(connector.pos, p + 0.25 * UP, atol=1e-6)
    np.testing.assert_allclose(connector.size[[0, 2]], [0.004, 0.25], atol=1e-6)
