"""Compiled parts of tasks against the same formulas, written out in numpy."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tasks import FramePose, Posture
from tests.arms import ROBOTS, TIPS
from tests.catalogue import random_rotation, random_state
from wbc import Hierarchy, SaturatedPD, allocate_rows
from wbc.stack import Stack

SEEDS = 20
CLOSE = 1e-10
"""Relative to the size of what is compared."""

both_robots = pytest.mark.parametrize("robot", ROBOTS)


def same(found, expected) -> None:
    expected = np.asarray(expected)
    size = max(1.0, float(np.abs(expected).max()))
    assert_allclose(found, expected, rtol=0, atol=CLOSE * size)


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
