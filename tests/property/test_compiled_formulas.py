"""Compiled parts of tasks against the same formulas, written out in numpy."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tasks import Clearance, Damping, FramePose, Posture
from tests.arms import ROBOTS, TIPS
from tests.catalogue import random_rotation, random_state
from tests.property.formulas import (
    SEEDS,
    both_robots,
    check_differences,
    rows_of,
    same,
)
from wbc import Hierarchy, InputError, SaturatedPD, Task, allocate_rows, resolve
from wbc.compiled import python
from wbc.frames import frame_at
from wbc.stack import Stack


def shortened(x, longest):
    size = np.linalg.norm(x)
    return x if size <= longest else longest / size * x


def saturated(error, rate, kp, speed, largest):
    kd = 2.0 * np.sqrt(kp)
    speed = min(speed, np.sqrt(largest * np.linalg.norm(error)))
    wanted = shortened(-kp / kd * error, speed)
    return shortened(kd * (wanted - rate), largest)


def test_a_saturated_law_shortens_wanted_speed_and_acceleration():
    rng = np.random.default_rng(1)
    for _ in range(200):
        m, kp = int(rng.integers(1, 8)), 10.0 ** rng.uniform(0, 4)
        error, rate = rng.normal(size=(2, m)) * 10.0 ** rng.uniform(-6, 1, (2, 1))
        speed, largest = 10.0 ** rng.uniform(-2, 2, 2)
        found = SaturatedPD(kp, speed, largest).acceleration(error, rate)
        same(found, saturated(error, rate, kp, speed, largest))
    assert_allclose(SaturatedPD(9.0, 1.0, 1.0).acceleration(np.zeros(2), [0, 0]), 0.0)


@both_robots
def test_a_saturated_law_is_compiled_and_the_same_in_a_stack(robot):
    arm, rng = ROBOTS[robot](), np.random.default_rng(2)
    reach = FramePose(TIPS[robot], [0.4, 0.1, 0.5], random_rotation(rng))
    rest = Posture(np.zeros(arm.nv))
    reach.law, rest.law = SaturatedPD(400.0, 0.2, 3.0), SaturatedPD(100.0, 1e3, 1e6)
    stack = Stack(arm, Hierarchy.of(reach >> rest))
    assert all(term.kernel is not None for term in stack.terms)
    for _ in range(SEEDS):
        state = random_state(arm, rng)
        stack.update(state)
        for term, law in zip(stack.terms, (reach.law, rest.law), strict=True):
            rows = allocate_rows(len(term.names), arm.nv)
            term.task.evaluate(state, rows)
            rate = rows.rate + rows.A @ state.v
            kp, _, speed, largest = law.gains
            wish = saturated(rows.error, rate, kp, speed, largest) - rows.drift
            same(term.rows.rate, rate)
            same(term.rows.upper, wish)
            same(term.rows.lower, wish)
    reach.law = SaturatedPD(400.0, 1e6, 1e6)  # a new law reaches the stack
    stack.update(state)
    e, r, d = stack.bands[:3, :6]
    same(stack.bands[4, :6], -400.0 * e - 40.0 * r - d)


@both_robots
def test_a_flat_frame_is_the_frame_that_pinocchio_has(robot):
    arm, rng = ROBOTS[robot](), np.random.default_rng(3)
    for _ in range(SEEDS):
        state = random_state(arm, rng)
        for name in arm.frames:
            flat = python(frame_at)(state.flat(name), arm.nv)
            for found, expected in zip(flat, state.frame(name), strict=True):
                same(found, expected)


def test_a_flat_frame_follows_the_state():
    arm, rng = ROBOTS["seven"](), np.random.default_rng(4)
    state = random_state(arm, rng)
    before = state.flat("tip").copy()
    state.refresh(arm.q_home, np.zeros(arm.nv), 0.0)
    assert np.abs(state.flat("tip") - before).max() > 0.1
    assert_array_equal(state.flat("tip"), arm.state(arm.q_home).flat("tip"))


def clearance(state, first, second, distance, rate):
    """A, drift, rate, error, lower, in the world's axes."""
    A, B = state.frame(first), state.frame(second)
    apart, v = A.p - B.p, A.V[:3] - B.V[:3]
    d = np.linalg.norm(apart)
    n, spare = apart / d, d - distance
    along = n @ v
    drift = n @ (A.drift[:3] - B.drift[:3]) + (v @ v - along**2) / d
    lower = -2.0 * rate * along - rate**2 * spare - drift
    return n @ (A.J[:3] - B.J[:3]), drift, along, min(spare, 0.0), lower


@both_robots
def test_a_clearance_is_the_same_in_any_axes_alone_and_in_a_stack(robot):
    arm, rng = ROBOTS[robot](), np.random.default_rng(5)
    for second in ("universe", "link2", "link3"):
        distance, rate = rng.uniform(0.1, 1.0), rng.uniform(1.0, 30.0)
        task = Clearance(TIPS[robot], second, distance, rate=rate)
        stack = Stack(arm, Hierarchy.of(task >> Damping()))
        assert stack.terms[0].kernel is not None
        with pytest.raises(InputError, match="'distance' of task"):
            task.distance = 1.0
        for _ in range(SEEDS):
            state = random_state(arm, rng)
            stack.update(state)
            expected = clearance(state, TIPS[robot], second, distance, rate)
            for rows in (rows_of(task, state), stack.terms[0].rows):
                found = rows.A[0], rows.drift, rows.rate, rows.error, rows.lower
                for one, other in zip(found, expected, strict=True):
                    same(np.squeeze(one), other)
                assert_array_equal(rows.upper, np.inf)
            check_differences(task, state, [0])


class Compensating(Task):
    """A user's task that asks for gravity torques, as its `update` may."""

    def __init__(self) -> None:
        super().__init__("compensating", "Nm")

    def row_names(self, robot):
        return ("a row",)

    def update(self, state, rows):
        rows.A[0], rows.lower[0] = 0.0, -np.abs(state.gravity()).max()
        rows.upper[0] = np.inf


@both_robots
def test_gravity_that_a_task_asks_for_leaves_other_tasks_their_drift(robot):
    arm, rng = ROBOTS[robot](), np.random.default_rng(6)
    pose = FramePose(TIPS[robot], [0.4, 0.1, 0.5], random_rotation(rng))
    for _ in range(SEEDS):
        state = random_state(arm, rng)
        alone = resolve(state, pose).acceleration
        assert_array_equal(resolve(state, Compensating() >> pose).acceleration, alone)
