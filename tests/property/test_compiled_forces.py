"""Compiled tasks on forces against the same formulas, written out in numpy."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tasks import Admittance, ForceLaw, HybridForceMotion, Impedance, KnifePose
from tests.arms import ROBOTS, TIPS
from tests.catalogue import random_rotation, random_state
from tests.property.formulas import (
    SEEDS,
    both_robots,
    check_differences,
    rows_of,
    same,
)

SENSOR = "link4"
LINEAR_THEN_ANGULAR = [(1, 1, 1, 1, 1, 1), (0, 0, 0, 0, 0, 0), (0, 1, 0, 1, 0, 1)]
SELECTIONS = [(0, 0, 1), (1, 1, 0), (1, 1, 1), *LINEAR_THEN_ANGULAR, (1, 1, 1, 0, 0, 0)]


def felt(state, frame):
    """The wrench about the frame's origin."""
    measured = state.wrenches["wrist"]
    arm = state.frame(SENSOR).p - state.frame(frame).p
    return measured + np.r_[np.zeros(3), np.cross(arm, measured[:3])]


def turned(R, x):
    """A twist or wrench (6,) in the axes R."""
    return np.r_[R.T @ x[:3], R.T @ x[3:]]


def goal(rng):
    return rng.normal(size=(3, 3))


def compliant(kind, robot, rng, **options):
    """A task, its target, and its mass, damping, stiffness and force."""
    M, K, D = rng.uniform(1, 20, 3), rng.uniform(0, 500, 3), rng.uniform(0, 90, 3)
    R, force, x_d = random_rotation(rng), rng.normal(size=3), goal(rng)
    task = kind(
        TIPS[robot], x_d[0], mass=M, stiffness=K, damping=D, sensor_frame=SENSOR,
        axes=R, force=force, **options,
    )  # fmt: skip
    task.set_target(*x_d)
    return task, R, x_d, lambda e, r, h: R.T @ x_d[2] + (force - h - D * r - K * e) / M


@both_robots
def test_an_impedance_is_a_mass_on_a_spring_and_a_damper(robot):
    arm, rng = ROBOTS[robot](), np.random.default_rng(1)
    for _ in range(SEEDS):
        state = random_state(arm, rng)
        task, R, x_d, respond = compliant(Impedance, robot, rng)
        F, rows, torque = (
            state.frame(TIPS[robot]),
            rows_of(task, state),
            np.ones(arm.nv),
        )
        h = felt(state, TIPS[robot])
        error, rate = R.T @ (F.p - x_d[0]), R.T @ (F.V[:3] - x_d[1])
        same(rows.A, R.T @ F.J[:3])
        same(rows.error, error)
        same(rows.rate, rate)
        same(rows.drift, R.T @ F.drift[:3])
        same(rows.lower, respond(error, rate, R.T @ h[:3]) - rows.drift)
        assert_array_equal(rows.lower, rows.upper)
        task.advance(state, torque)
        same(torque, 1.0 + F.J.T @ h)
        check_differences(task, state, range(3))


@both_robots
def test_an_admittance_follows_a_reference_that_gives_way(robot):
    arm, rng = ROBOTS[robot](), np.random.default_rng(2)
    for _ in range(3):
        task, R, x_d, respond = compliant(Admittance, robot, rng, following=900.0)
        start = random_state(arm, rng)
        task.advance(start, np.zeros(arm.nv))  # without a reference nothing moves
        F = start.frame(TIPS[robot])
        x, v = F.p, F.V[:3]
        for state in [start, *(random_state(arm, rng) for _ in range(SEEDS))]:
            F, rows = state.frame(TIPS[robot]), rows_of(task, state)
            h = R.T @ state.wrenches["wrist"][:3]
            a = respond(R.T @ (x - x_d[0]), R.T @ (v - x_d[1]), h)
            error, rate = R.T @ (F.p - x), R.T @ (F.V[:3] - v)
            same(rows.error, error)
            same(rows.rate, rate)
            wish = a - 900.0 * error - 60.0 * rate
            same(rows.lower, wish - R.T @ F.drift[:3])
            assert_array_equal(rows.lower, rows.upper)
            check_differences(task, state, range(3))
            task.update(state, rows)
            task.advance(state, np.zeros(arm.nv))
            v = v + state.dt * (R @ a)
            x = x + state.dt * v


@pytest.mark.parametrize("kind", [Impedance, Admittance])
def test_axes_and_targets_that_change_are_those_of_the_next_tick(kind):
    arm, rng = ROBOTS["seven"](), np.random.default_rng(3)
    state = random_state(arm, rng)
    other, R, x_d, _ = compliant(kind, "seven", rng)
    task = kind(
        other.frame, np.zeros(3), mass=other.mass, stiffness=other.stiffness,
        damping=other.damping, sensor_frame=SENSOR,
    )  # fmt: skip
    rows_of(task, state)
    task.reset()
    task.set_axes(R)
    task.set_target(*x_d)
    task.set_force(other.force)
    assert_array_equal(rows_of(task, state).lower, rows_of(other, state).lower)
    assert_array_equal(task.axes, R)
    assert_array_equal(task.target, x_d[0])


@both_robots
def test_a_knife_counts_on_what_it_feels(robot):
    arm, rng = ROBOTS[robot](), np.random.default_rng(4)
    task = KnifePose(
        TIPS[robot], np.ones(3), np.eye(3), sensor="wrist", sensor_frame=SENSOR
    )
    for _ in range(SEEDS):
        state, torque = random_state(arm, rng), np.ones(arm.nv)
        task.advance(state, torque)
        same(torque, 1.0 + state.jacobian(SENSOR).T @ state.wrenches["wrist"])


def gains(values):
    """One a row, or a number that no row asks for."""
    return values if values.size else 1.0


class Plain:
    """The hybrid task's arithmetic of one tick."""

    def __init__(self, robot, S, rng) -> None:
        m = len(S)
        self.f, self.m = np.flatnonzero(S), np.flatnonzero(np.equal(S, 0))
        self.R, self.R_d, self.x_d = (
            random_rotation(rng),
            random_rotation(rng),
            goal(rng),
        )
        self.force, self.fd = rng.normal(size=m), rng.uniform(1, 80, self.f.size)
        self.kp, self.kd = rng.uniform(0, 400, (2, self.m.size))
        self.law, self.approach = ForceLaw(0.4, 7.0, 0.05), 0.02
        self.held, self.frame = np.zeros(self.f.size), TIPS[robot]
        self.task = HybridForceMotion(
            self.frame, self.x_d[0], self.force, S, orientation=self.R_d, axes=self.R,
            law=self.law, stiffness=gains(self.kp), damping=gains(self.kd),
            force_damping=gains(self.fd),
            approach=self.approach, sensor_frame=SENSOR,
        )  # fmt: skip
        self.task.set_target(self.x_d[0], self.R_d, self.x_d[1], self.x_d[2])

    def bounds(self, state):
        """Error, lower bounds less drift, and torques; moves the integral on."""
        F, f, m, R = state.frame(self.frame), self.f, self.m, self.R
        size = f.size + m.size
        error = turned(R, np.r_[F.p - self.x_d[0], pin.log3(F.R @ self.R_d.T)])[:size]
        rate = turned(R, F.V - np.r_[self.x_d[1], np.zeros(3)])[:size]
        wish = turned(R, np.r_[self.x_d[2], np.zeros(3)])[:size]
        wish[m] -= self.kp * error[m] + self.kd * rate[m]
        J = np.vstack([R.T @ F.J[:3], R.T @ F.J[3:]])[f]
        mobility = J @ np.linalg.solve(state.M, J.T)
        speed, h = turned(R, F.V)[f], turned(R, felt(state, self.frame))[f]
        F_d, torque = self.force[f], np.zeros(state.q.size)
        if self.task.touching:
            push = F_d + self.law.proportional * (F_d - h) + self.held - h
            wish[f] = mobility @ push - self.fd * speed
            change, torque = self.law.integral * (F_d - h), J.T @ h
        else:
            linear = np.where(f < 3, F_d, 0.0)
            long = float(np.linalg.norm(linear)) or 1.0
            late = self.approach / long * linear - speed
            wish[f] = self.fd * late + mobility @ self.held
            pull = self.fd**2 / 4.0 * late
            change = np.linalg.lstsq(mobility, pull, rcond=1e-9)[0] if f.size else 0.0
        error[f] = h - F_d
        moved = self.held + state.dt * change
        self.held = np.clip(moved, -self.law.limit, self.law.limit)
        return error, wish, torque


@both_robots
@pytest.mark.parametrize("S", SELECTIONS, ids=str)
def test_a_hybrid_task_moves_and_presses(robot, S):
    arm, rng = ROBOTS[robot](), np.random.default_rng(5)
    silent = {"wrist": np.zeros(6)}
    plain = Plain(robot, S, rng)
    task, seen = plain.task, set()
    for i in range(60):
        state = random_state(arm, rng)
        if i < SEEDS:
            state = arm.state(state.q, 0.1 * state.v, wrenches=silent)
        seen.add(task.touching)
        error, wish, torque = plain.bounds(state)
        rows, found = rows_of(task, state), np.ones(arm.nv)
        same(rows.error, error)
        same(rows.lower + rows.drift, wish)
        assert_array_equal(rows.lower, rows.upper)
        assert not rows.rate[plain.f].any()
        if plain.f.size:
            same(task.felt, felt(state, plain.frame))
        same(task.position, state.frame(plain.frame).p)
        check_differences(task, state, plain.m)
        task.update(state, rows)
        task.advance(state, found)
        same(found, 1.0 + torque)
        same(task._held, plain.held)
    assert seen == ({False, True} if plain.f.size else {False})


def test_a_search_learns_nothing_where_the_arm_cannot_move():
    """A stretched arm: two of three directions, so least squares of least norm."""
    arm, rng = ROBOTS["seven"](), np.random.default_rng(6)
    q = np.array([0.3, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0])
    plain = Plain("seven", (1, 1, 1), rng)
    state = arm.state(q, wrenches={"wrist": np.zeros(6)})
    J = plain.R.T @ state.frame("tip").J[:3]
    sigma = np.linalg.svd(J @ np.linalg.solve(state.M, J.T), compute_uv=False)
    assert sigma[2] < 1e-12 * sigma[0]
    plain.bounds(state)
    rows_of(plain.task, state)
    plain.task.advance(state, np.zeros(arm.nv))
    assert 0.0 < np.abs(plain.held).max() < plain.law.limit
    assert_allclose(plain.task._held, plain.held, rtol=1e-9)
