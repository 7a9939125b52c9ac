"""Compiled damping of lost directions against a singular value decomposition."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from tasks import AxisAlignment, FramePose, FramePosition, SingularDamping
from tests.arms import ROBOTS, TIPS, two_link
from tests.catalogue import random_rotation, random_state
from tests.property.formulas import SEEDS, both_robots, rows_of, same
from wbc import PD, SaturatedPD


def goals(frame, rng):
    """Tasks of fewer rows than joints, and of about as many."""
    p, R = rng.normal(size=3), random_rotation(rng)
    pose = FramePose(frame, p, R)
    pose.law = PD(rng.uniform(1.0, 9.0, 6), rng.uniform(1.0, 9.0, 6))
    near = FramePosition(frame, p)
    near.law = SaturatedPD(100.0, 0.1, 2.0)
    return [pose, near, AxisAlignment(frame, R[0])]


def lost(task, state, threshold, factor, bend):
    """Damping matrix A^T A, gains of the rows, and kd."""
    seen, law = rows_of(task, state), task.law
    _, s, Vt = np.linalg.svd(seen.A)
    size = np.linalg.norm(s)
    n = state.q.size
    s = np.append(s, np.full(max(n - s.size, 0), s[-1]))[:n]
    wish = law.acceleration(seen.error, np.zeros(seen.error.size))
    error = np.linalg.norm(wish) / law.stiffness.max()
    fade = np.maximum(1.0 - (s / (threshold * size)) ** 2, 0.0)
    square = fade * ((factor * size) ** 2 + bend * size * error)
    return Vt.T @ np.diag(square) @ Vt, np.sqrt(square), law.damping.max()


def check(task, state, threshold):
    factor, bend = 0.02, 0.4
    damping = SingularDamping(task, threshold=threshold, factor=factor, bend=bend)
    D, gains, kd = lost(task, state, threshold, factor, bend)
    rows = rows_of(damping, state)
    same(rows.A.T @ rows.A, D)
    same(np.linalg.norm(rows.A, axis=1), gains)
    same(rows.rate, rows.A @ state.v)
    same(rows.lower, -kd * rows.rate)
    assert_array_equal(rows.lower, rows.upper)
    assert_array_equal(rows.error, rows.rate)
    assert not rows.drift.any()


@both_robots
@pytest.mark.parametrize("threshold", [0.1, 0.6, 2.0])
def test_lost_directions_are_those_of_the_decomposition(robot, threshold):
    arm, rng = ROBOTS[robot](), np.random.default_rng(1)
    for _ in range(SEEDS):
        for task in goals(TIPS[robot], rng):
            check(task, random_state(arm, rng), threshold)


@pytest.mark.parametrize("bend", [0.0, 1e-9, 1e-3, 0.1])
def test_so_they_are_at_a_singularity(bend):
    """A planar arm, stretched or nearly so: six rows of rank two or less."""
    arm = two_link()
    state = arm.state(np.array([0.3, bend]), np.array([0.5, -0.2]))
    goal = FramePose("tip", [0.9, 0.1, 0.0], np.eye(3))
    for task in (goal, FramePosition("tip", [0.9, 0.1, 0.0])):
        check(task, state, 0.5)
