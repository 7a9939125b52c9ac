"""Force tasks against closed forms: rigid surfaces, masses on springs, rotations."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tasks import (
    Admittance,
    Damping,
    ForceLaw,
    FramePose,
    FramePosition,
    HybridForceMotion,
    Impedance,
    Posture,
    TorqueLimits,
)
from tests.arms import seven_axis
from tests.catalogue import random_rotation
from tests.tolerances import SAME, SOUND
from wbc import (
    Controller,
    HierarchicalQP,
    MotionTask,
    NullSpace,
    Robot,
    State,
    allocate_rows,
)
from wbc.stack import Stack

ARM = seven_axis()
TIP, SENSOR = "tip", "link7"
LAWS = {
    "hqp": HierarchicalQP,
    "wbcf": NullSpace,
    "tsid": lambda: NullSpace("tsid"),
    "uf": lambda: NullSpace("uf"),
}
SETTLED = 1e-6  # [N, m]
every_law = pytest.mark.parametrize("resolver", LAWS.values(), ids=LAWS)
FEED_FORWARD = ForceLaw(0.0, 0.0)


def at_sensor(robot: Robot, q, force) -> np.ndarray:
    """What a sensor at another place reads of a force at the tip."""
    state = robot.state(q)
    arm = state.frame(TIP).p - state.frame(SENSOR).p
    return np.r_[force, np.cross(arm, force)]


def pressing(rng, axes, law=FEED_FORWARD, **options) -> HybridForceMotion:
    """A task that presses along the third axis, near the home posture."""
    p = ARM.state(ARM.q_home).frame(TIP).p + rng.uniform(-0.01, 0.01, 3)
    force = [1.0, 2.0, 20.0]  # of the motion rows there is no notice
    return HybridForceMotion(
        TIP, p, force, axes=axes, law=law, sensor_frame=SENSOR, **options
    )


def touching(task: HybridForceMotion, state: State) -> None:
    """Let the task feel contact, as a stack does once a tick."""
    task.update(state, allocate_rows(task.size, ARM.nv))
    task.advance(state, np.zeros(ARM.nv))
    assert task.touching


def sliding_state(rng, n, measured: float) -> State:
    """Near home, with a velocity along the surface of normal n, and a force on it."""
    q = ARM.q_home + rng.uniform(-0.2, 0.2, ARM.nv)
    J = n @ ARM.state(q).frame(TIP).J[:3]
    v = rng.uniform(-0.3, 0.3, ARM.nv)
    v -= J * (J @ v) / (J @ J)
    return ARM.state(q, v, wrenches={"wrist": at_sensor(ARM, q, measured * n)})


def solve(state: State, hierarchy, resolver) -> tuple[np.ndarray, Stack]:
    """Torques, and the rows that they came from."""
    stack = Stack(ARM, hierarchy)
    stack.update(state)
    return stack.torque(resolver.start(stack).solve().vdot), stack


def rigid(state: State, n, torque) -> tuple[float, np.ndarray]:
    """Force of the robot on a rigid surface of normal n, and joint accelerations."""
    F = state.frame(TIP)
    J, drift = n @ F.J[:3], n @ F.drift[:3]
    free = np.linalg.solve(state.M, torque - state.h)
    column = np.linalg.solve(state.M, J)
    force = (J @ free + drift) / (J @ column)
    return float(force), free - column * force


@every_law
def test_a_rigid_surface_feels_the_law_whatever_was_measured_and_ranks_below(resolver):
    rng = np.random.default_rng(1)
    for kp in (0.0, 0.4):
        for measured in (4.0, 20.0, 33.0):
            axes = random_rotation(rng)
            n = axes[:, 2]
            task = pressing(rng, axes, ForceLaw(kp, 0.0))
            state = sliding_state(rng, n, measured)
            task.set_target(state.frame(TIP).p + rng.uniform(-0.01, 0.01, 3))
            touching(task, state)
            limits = TorqueLimits()
            below = Posture(state.q + rng.uniform(-0.2, 0.2, ARM.nv), stiffness=20.0)
            torque, _ = solve(state, limits >> task >> below, resolver())
            force, vdot = rigid(state, n, torque)
            assert_allclose(force, 20.0 + kp * (20.0 - measured), rtol=SAME)
            if measured == 20.0:  # then motion is what the law wants, in contact too
                F, R = state.frame(TIP), axes[:, :2]
                rows = allocate_rows(3, ARM.nv)
                task.update(state, rows)
                reached = R.T @ (F.J[:3] @ vdot + F.drift[:3])
                assert_allclose(reached, (rows.lower + rows.drift)[:2], atol=SAME)


@every_law
def test_before_contact_nothing_leaks_into_the_directions_of_motion(resolver):
    rng = np.random.default_rng(2)
    axes = random_rotation(rng)
    task, state = pressing(rng, axes), sliding_state(rng, axes[:, 2], 0.0)
    rows = allocate_rows(3, ARM.nv)
    task.update(state, rows)
    torque, _ = solve(state, task >> Damping(), resolver())
    vdot = np.linalg.solve(state.M, torque - state.h)
    assert_allclose(rows.A @ vdot, rows.lower, atol=SAME)


@every_law
def test_a_rigid_joint_feels_forces_and_moments_of_a_six_row_task(resolver):
    """Pressing flat: one force and two moments at once, the other rows move."""
    rng = np.random.default_rng(12)
    R, wanted = random_rotation(rng), np.array([0.0, 0.0, 20.0, 0.5, -0.3, 0.0])
    pressed = [2, 3, 4]
    q = ARM.q_home + rng.uniform(-0.2, 0.2, ARM.nv)
    F = ARM.state(q).frame(TIP)
    task = HybridForceMotion(
        TIP,
        F.p,
        wanted,
        (0, 0, 1, 1, 1, 0),
        orientation=F.R,
        axes=R,
        law=FEED_FORWARD,
        sensor_frame=TIP,
    )
    measured = np.kron(np.eye(2), R) @ np.array([0.0, 0.0, 7.0, -0.2, 0.4, 0.0])
    state = ARM.state(q, wrenches={"wrist": measured})
    touching(task, state)
    below = Posture(q + rng.uniform(-0.2, 0.2, ARM.nv), stiffness=20.0)
    torque, _ = solve(state, task >> below, resolver())
    J = (np.kron(np.eye(2), R.T) @ F.J)[pressed]
    column = np.linalg.solve(state.M, J.T)
    free = np.linalg.solve(state.M, torque - state.h)
    assert_allclose(np.linalg.solve(J @ column, J @ free), wanted[pressed], atol=SAME)


def feel(task, gain: float, ticks: int) -> float:
    """Force on a rigid surface, felt a tick late, if the plant delivers a share."""
    rng = np.random.default_rng(3)
    axes = task.axes
    n, force = axes[:, 2], 5.0
    stack = Stack(ARM, task >> Damping())
    solver = HierarchicalQP().start(stack)
    q = ARM.q_home + rng.uniform(-0.1, 0.1, ARM.nv)
    for _ in range(ticks):
        state = ARM.state(q, wrenches={"wrist": at_sensor(ARM, q, force * n)})
        stack.update(state)
        force = gain * rigid(state, n, stack.torque(solver.solve().vdot))[0]
    return force


def test_p_and_i_settle_in_rigid_contact_with_a_sensor_that_is_late():
    rng = np.random.default_rng(4)
    axes = random_rotation(rng)
    exact = feel(pressing(rng, axes, ForceLaw(0.5, 0.0)), 1.0, 60)
    assert_allclose(exact, 20.0, atol=SETTLED)
    short = feel(pressing(rng, axes, ForceLaw(0.5, 0.0)), 0.8, 60)
    assert_allclose(short, 0.8 * 30.0 / 1.4, atol=SETTLED)  # f = g (Fd + kp (Fd - f))
    learnt = feel(pressing(rng, axes, ForceLaw(0.5, 40.0)), 0.8, 1500)
    assert_allclose(learnt, 20.0, atol=SETTLED)


def test_selection_is_a_rotated_projector():
    rng = np.random.default_rng(6)
    R = random_rotation(rng)
    task = HybridForceMotion(TIP, np.zeros(3), np.zeros(3), (0, 0, 1), axes=R)
    z = R[:, 2]
    assert_allclose(task.Omega_f, np.outer(z, z), atol=SAME)
    assert_allclose(task.Omega_f @ task.Omega_f, task.Omega_f, atol=SAME)
    assert_allclose(task.Omega_m @ task.Omega_f, np.zeros((3, 3)), atol=SAME)
    six = HybridForceMotion(
        TIP,
        np.zeros(3),
        np.zeros(6),
        (0, 0, 1, 1, 1, 0),
        orientation=np.eye(3),
        axes=R,
    )
    linear, angular = six.Omega_f[:3, :3], six.Omega_f[3:, 3:]
    assert_allclose(linear, np.outer(z, z), atol=SAME)
    assert_allclose(angular, np.eye(3) - np.outer(z, z), atol=SAME)
    assert_allclose(six.Omega_m + six.Omega_f, np.eye(6), atol=SAME)


@every_law
def test_turning_the_axes_about_the_force_changes_nothing(resolver):
    rng = np.random.default_rng(7)
    R = random_rotation(rng)
    state, found = sliding_state(rng, R[:, 2], 12.0), []
    target = state.frame(TIP).p + 0.01
    for angle in (0.0, 1.1):
        c, s = np.cos(angle), np.sin(angle)
        about = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        task = HybridForceMotion(
            TIP, target, [0.0, 0.0, 20.0], axes=R @ about, sensor_frame=SENSOR
        )
        touching(task, state)
        found.append(solve(state, task >> Damping(), resolver())[0])
    assert_allclose(found[0], found[1], rtol=SAME, atol=SAME)


def rows_of(task, state):
    rows = allocate_rows(len(task.row_names(ARM)), ARM.nv)
    task.update(state, rows)
    return rows


@pytest.mark.parametrize("size", [3, 6])
def test_without_force_rows_it_is_a_pose_task_in_other_axes(size):
    rng = np.random.default_rng(8)
    R, R_d, p = random_rotation(rng), random_rotation(rng), rng.uniform(0.2, 0.5, 3)
    pose: MotionTask = FramePosition(TIP, p, stiffness=400.0)
    if size == 6:
        pose = FramePose(TIP, p, R_d, stiffness=400.0)
    task = HybridForceMotion(
        TIP, p, np.zeros(size), [0] * size, orientation=R_d, axes=R, stiffness=400.0
    )
    state = ARM.state(ARM.q_home, rng.uniform(-1, 1, ARM.nv))
    one, other = rows_of(task, state), rows_of(pose, state)
    turn = np.kron(np.eye(size // 3), R)
    for name in ("A", "lower", "upper", "error", "rate", "drift"):
        turned = turn @ getattr(one, name)
        assert_allclose(turned, getattr(other, name), atol=1e-9, err_msg=name)


@every_law
@pytest.mark.parametrize("kind", ["hybrid", "impedance", "admittance"])
def test_lower_tasks_do_not_disturb_force_tasks_nor_those_above(resolver, kind):
    rng = np.random.default_rng(9)
    axes = random_rotation(rng)
    state = sliding_state(rng, axes[:, 2], 15.0)
    p = state.frame(TIP).p
    task = {
        "hybrid": lambda: pressing(rng, axes),
        "impedance": lambda: Impedance(TIP, p, sensor_frame=SENSOR),
        "admittance": lambda: Admittance(TIP, p, sensor_frame=SENSOR),
    }[kind]()
    top = Posture([0.3], joints=[ARM.joint_names[0]], name="top")
    below = Posture(ARM.q_home, stiffness=10.0)
    stack = Stack(ARM, top >> task >> below)
    stack.update(state)
    above = slice(0, stack.levels[-1].start)
    first = (stack.A @ resolver().start(stack).solve().vdot)[above]
    change = rng.uniform(-50.0, 50.0, ARM.nv)
    stack.lower[stack.levels[-1]] += change
    stack.upper[stack.levels[-1]] += change
    second = (stack.A @ resolver().start(stack).solve().vdot)[above]
    assert_allclose(second, first, atol=SOUND * (1.0 + np.abs(first).max()))


@every_law
def test_an_impedance_is_a_mass_on_a_spring_that_feels_the_measured_force(resolver):
    rng = np.random.default_rng(10)
    for _ in range(3):
        R, h, h_d = random_rotation(rng), rng.normal(size=3), rng.normal(size=3)
        q = ARM.q_home + rng.uniform(-0.2, 0.2, ARM.nv)
        v = rng.uniform(-0.5, 0.5, ARM.nv)
        state = ARM.state(q, v, wrenches={"wrist": at_sensor(ARM, q, 10 * h)})
        F = state.frame(TIP)
        x_d, v_d, a_d = F.p + 0.03 * rng.normal(size=3), *rng.normal(size=(2, 3))
        M, K, D = (rng.uniform(low, 2 * low, 3) for low in (4.0, 300.0, 80.0))
        gains = {"mass": M, "stiffness": K, "damping": D}
        task = Impedance(TIP, x_d, force=10 * h_d, axes=R, sensor_frame=SENSOR, **gains)
        task.set_target(x_d, v_d, a_d)
        torque, _ = solve(state, task >> Damping(), resolver())
        pushed = torque - state.h - F.J[:3].T @ (10 * h)
        a = F.J[:3] @ np.linalg.solve(state.M, pushed) + F.drift[:3]
        e, ed, edd = (R.T @ x for x in (F.p - x_d, F.V[:3] - v_d, a - a_d))
        assert_allclose(M * edd + D * ed + K * e, 10 * (h_d - R.T @ h), atol=1e-7)


@pytest.mark.parametrize("kind", [Impedance, Admittance])
def test_a_compliant_point_gives_way_by_the_force_over_the_stiffness(kind):
    """The surroundings push by -h; an ideal robot ends where the spring balances."""
    h = np.array([6.0, -3.0, 2.0])
    p = ARM.state(ARM.q_home).frame(TIP).p
    task = kind(TIP, p, mass=2.0, stiffness=400.0, sensor_frame=TIP)
    controller = Controller(ARM, task >> Damping(), dt=2e-3)
    q, v = ARM.q_home.copy(), np.zeros(ARM.nv)
    for _ in range(1000):
        solution = controller(q, v, wrenches={"wrist": np.r_[h, 0, 0, 0]})
        v = v + controller.dt * solution.acceleration
        q = q + controller.dt * v
    assert_allclose(ARM.state(q).frame(TIP).p - p, -h / 400.0, atol=SETTLED)
