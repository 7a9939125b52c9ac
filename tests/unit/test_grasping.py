"""The grasping cell: sizes that are refused, plans, references, the gripper."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from numpy.testing import assert_allclose

from robots import racer
from sims import grasping
from sims.cell import ArmCell
from sims.grasping.cases import seeded_cases
from sims.grasping.gripper import Grip, Gripper
from sims.grasping.job import Job
from sims.grasping.motion import Straight, Timeline, Transfer
from sims.grasping.plan import HOVER, TCP, make_plan, shifted
from sims.grasping.rim import CLOSING
from sims.run import run
from sims.scene import add_room
from tasks import Cylinder, rim_grasp
from wbc import Controller, InputError, PoseResult, solve_pose
from wbc.rows import allocate_rows

STEP = 1e-5
SPEED = 1e-6  # of a reference against differences [m/s, rad/s]
ACCELERATION = 1e-4  # likewise [m/s^2, rad/s^2]
NEAR = 1e-3  # relative, of the ways to the nearest place on the rim
POSE = 1e-6  # [m, rad]


@pytest.fixture(scope="module")
def arm():
    return racer.load("gripper")


@pytest.fixture(scope="module")
def cases(arm):
    return seeded_cases(arm, seed=0, count=6)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"radius": 0.0}, "radius of"),
        ({"height": -0.1}, "height of"),
        ({"mass": np.nan}, "mass of"),
        ({"wall": 0.02}, "opens for 16 mm"),
        ({"radius": 0.02}, "inner finger needs 24 mm"),
        ({"height": 0.02}, "fingers reach 18 mm below the rim"),
        ({"R": np.diag([1.0, 1.0, -1.0])}, "not a rotation"),
    ],
)
def test_a_cylinder_that_cannot_be_grasped_is_refused_with_the_reason(
    cases, change, word
):
    with pytest.raises(InputError, match=word):
        replace(cases[0].cylinder, **change)


def test_cases_are_solid_and_hollow_upright_and_tilted_and_all_different():
    arm = racer.load("gripper")
    cylinders = [case.cylinder for case in seeded_cases(arm, seed=0)]
    assert len(cylinders) >= 12
    assert {(c.solid, c.tilt > 0.1) for c in cylinders} == {
        (solid, leans) for solid in (False, True) for leans in (False, True)
    }
    assert len({c.radius for c in cylinders}) == len(cylinders)


def test_the_grasp_meets_the_papers_four_constraints(arm, cases):
    for case in cases:
        cylinder = case.cylinder
        plan = make_plan(arm, cylinder, grasping.GOAL, case.start)
        top = Cylinder(cylinder.top, cylinder.axis, cylinder.rim)
        state = arm.state(plan.grasp.q)
        for task, _ in rim_grasp(TCP, top, closing=CLOSING).terms:
            assert _error(task, state) < POSE


def _error(task, state):
    rows = allocate_rows(len(task.row_names(state.robot)), state.robot.nv)
    task.update(state, rows)
    return float(np.abs(rows.error).max())


@pytest.mark.parametrize("index", [0, 2, 4])
def test_the_place_on_the_rim_is_the_one_that_the_pose_solver_finds_nearest(
    arm, cases, index
):
    case = cases[index]
    plan = make_plan(arm, case.cylinder, grasping.GOAL, case.start)
    top = Cylinder(case.cylinder.top, case.cylinder.axis, case.cylinder.rim)
    goal = rim_grasp(TCP, top, closing=CLOSING, depth=-HOVER)
    found: PoseResult = solve_pose(arm, goal, case.start, margin=0.05, attempts=8)
    assert found.ok
    distance = np.linalg.norm(plan.above.q - case.start)
    assert_allclose(distance, found.distance, rtol=NEAR)


def test_a_plan_keeps_away_from_the_joint_limits(arm, cases):
    for case in cases:
        plan = make_plan(arm, case.cylinder, grasping.GOAL, case.start)
        for place in (plan.above, plan.grasp, plan.lifted, plan.over, plan.placed):
            assert place.met
            assert (place.q > arm.q_min).all()
            assert (place.q < arm.q_max).all()


@pytest.mark.parametrize("where", ["cylinder", "goal"])
def test_out_of_reach_is_said_before_the_arm_moves(arm, cases, where):
    case, far = cases[0], np.array([1.9, 0.3, 0.4])
    cylinder, goal = case.cylinder, grasping.GOAL
    if where == "cylinder":
        cylinder = replace(cylinder, p=far)
    else:
        goal = far
    cell = grasping.cell(arm, cylinder)
    cell.reset(case.start)
    with pytest.raises(InputError, match=r"out of reach.*the arm has not moved"):
        Job(arm, cell, cylinder, goal, case.start)


def test_a_gripper_that_closes_on_nothing_says_so_and_withdraws_calmly(arm, cases):
    case = cases[0]
    cell = grasping.cell(arm, None)
    cell.reset(case.start)
    job = Job(arm, cell, case.cylinder, grasping.GOAL, case.start)
    controller = Controller(arm, job.rim.hierarchy)
    log = run(cell, controller, 20.0, script=job.script, sites=(TCP,), watch=job.watch)
    assert job.grip is Grip.EMPTY
    assert "closed on nothing" in job.report
    assert np.abs(log.v / arm.v_max).max() < 0.5
    assert_allclose(log.p[TCP][-1], job.plan.above.X.translation, atol=1e-4)
    assert job.gripper.gap > 0.027


def test_references_move_as_their_velocities_and_accelerations_say(arm, cases):
    plan = make_plan(arm, cases[2].cylinder, grasping.GOAL, cases[2].start)
    line = Straight(
        plan.grasp.X, plan.lifted.X, np.array([plan.grasp.q, plan.lifted.q]), 1.0
    )
    transfer = Transfer(arm, TCP, plan.lifted.q, plan.over.q)
    for motion in (line, transfer):
        for share in (0.2, 0.5, 0.9):
            t = share * motion.duration
            a, b, c = (motion.at(t + shift * STEP) for shift in (-1, 0, 1))
            assert_allclose((c.p - a.p) / (2 * STEP), b.V[:3], atol=SPEED)
            spin = (c.R - a.R) / (2 * STEP) @ b.R.T
            omega = [spin[2, 1], spin[0, 2], spin[1, 0]]
            assert_allclose(omega, b.V[3:], atol=SPEED)
            assert_allclose((c.V - a.V) / (2 * STEP), b.A, atol=ACCELERATION)


def test_a_timeline_goes_on_without_jumps(arm, cases):
    case = cases[1]
    cell = grasping.cell(arm, case.cylinder)
    timeline = Job(arm, cell, case.cylinder, grasping.GOAL, case.start).timeline
    assert isinstance(timeline, Timeline)
    for phase in timeline.phases[:-1]:
        end = timeline.ends(phase.name)
        before, after = timeline.at(end - 1e-9), timeline.at(end)
        assert_allclose(before.p, after.p, atol=POSE)
        assert_allclose(before.R, after.R, atol=POSE)
        assert_allclose(after.V, 0.0, atol=POSE)


def test_fingers_close_with_the_force_that_was_asked_for(arm, cases):
    case = cases[0]
    cell = grasping.cell(arm, case.cylinder)
    plan = make_plan(arm, case.cylinder, grasping.GOAL, case.start)
    cell.reset(plan.grasp.q)
    gripper = Gripper(cell, force=30.0)
    for _ in range(50):
        gripper.update()
        cell.apply(arm.state(cell.truth[0]).gravity())
        cell.step()
    assert gripper.grip is Grip.OPEN
    gripper.close()
    for _ in range(600):
        gripper.update()
        cell.apply(_hold(arm, cell, plan.grasp.q))
        cell.step()
    assert gripper.grip is Grip.HOLDING
    pads = [cell.model.geom(name).id for name in ("pad_left", "pad_right")]
    for pad in pads:
        assert_allclose(_normal_force(cell, pad), 30.0, rtol=0.05)


def _hold(arm, cell, q):
    here, v = cell.truth
    state = arm.state(here)
    return state.gravity() + state.M @ (2500.0 * (q - here) - 100.0 * v)


def _normal_force(cell, geom):
    total, force = 0.0, np.zeros(6)
    for i in range(cell.data.ncon):
        if geom in cell.data.contact[i].geom:
            mujoco.mj_contactForce(cell.model, cell.data, i, force)
            total += force[0]
    return total


def test_a_pose_further_along_its_own_axis_is_that_far_away(arm, cases):
    X = make_plan(arm, cases[0].cylinder, grasping.GOAL, cases[0].start).grasp.X
    assert_allclose(np.linalg.norm(shifted(X, 0.06).translation - X.translation), 0.06)


def test_a_gripper_opens_to_a_width_and_refuses_one_that_it_has_not(arm):
    cell = grasping.cell(arm, None)
    gripper = Gripper(cell)
    gripper.open(0.015)
    for _ in range(600):
        gripper.update()
        cell.apply(arm.state(cell.truth[0]).gravity())
        cell.step()
    assert gripper.grip is Grip.OPEN
    assert_allclose(gripper.gap, 0.015, atol=1e-4)
    for width in (0.03, 0.0, np.nan):
        with pytest.raises(InputError, match="width"):
            gripper.open(width)


def test_a_gripper_needs_fingers_and_no_more_force_than_they_have(arm, cases):
    cell = grasping.cell(arm, cases[0].cylinder)
    with pytest.raises(InputError, match=r"80\.0 N at most"):
        Gripper(cell, force=100.0)
    with pytest.raises(InputError, match="force"):
        Gripper(cell, force=-1.0)
    spec = mujoco.MjSpec.from_string(arm.mjcf)
    add_room(spec)
    with pytest.raises(InputError, match="no gripper"):
        Gripper(ArmCell("bare", arm, spec))
