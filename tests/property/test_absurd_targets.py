"""Whatever a stack asks for: joint speed and torque stay in their limits, and it ends.

Random stacks of poses, points, planes, axes and postures, with targets kilometres away,
behind the robot or inside it, moving at absurd speeds; one second of closed loop each.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from tasks import (
    AxisAlignment,
    Damping,
    FrameOrientation,
    FramePose,
    FramePosition,
    JointLimits,
    Plane,
    PointOnPlane,
    PointOnPoint,
    Posture,
    SingularDamping,
    TorqueLimits,
)
from tests.arms import ROBOTS, TIPS
from tests.catalogue import random_rotation
from tests.tolerances import JOINT, TORQUE
from wbc import (
    Controller,
    HierarchicalQP,
    Hierarchy,
    Level,
    NullSpace,
    Robot,
    SaturatedPD,
    Task,
)

Rng = np.random.Generator
DT = 2e-3
SECOND = round(1.0 / DT)
RESOLVERS = {"hqp": HierarchicalQP, "nullspace": NullSpace}
STACKS = 3
FAR = (0.0, 3.0, 1e3, 1e6)
"""How far targets are [m]."""
FAST = (0.0, 30.0, 1e4)
"""How fast they move [m/s], and accelerate [m/s^2]."""


def _position(robot: Robot, rng: Rng) -> Task:
    task = FramePosition(TIPS[robot.name], np.zeros(3), stiffness=_gain(rng))
    far, fast = rng.choice(FAR), rng.choice(FAST)
    task.set_target(*(k * rng.normal(size=3) for k in (far, fast, fast)))
    return task


def _pose(robot: Robot, rng: Rng) -> Task:
    p, R = rng.choice(FAR) * rng.normal(size=3), random_rotation(rng)
    task = FramePose(TIPS[robot.name], p, R, stiffness=_gain(rng))
    if rng.random() < 0.5:
        task.law = SaturatedPD(_gain(rng), speed=1e3, acceleration=1e5)
    return task


def _damped(robot: Robot, rng: Rng) -> Level:
    far = rng.choice(FAR) * rng.normal(size=3)
    task = PointOnPoint(TIPS[robot.name], far, stiffness=_gain(rng))
    return task + SingularDamping(task)


def _orientation(robot: Robot, rng: Rng) -> Task:
    task = FrameOrientation(TIPS[robot.name], np.eye(3), stiffness=_gain(rng))
    spin, jerk = (rng.choice(FAST) * rng.normal(size=3) for _ in range(2))
    task.set_target(random_rotation(rng), spin, jerk)
    return task


def _plane(robot: Robot, rng: Rng) -> Task:
    plane = Plane(rng.choice(FAR) * rng.normal(size=3), rng.normal(size=3))
    return PointOnPlane(TIPS[robot.name], plane, stiffness=_gain(rng))


def _axis(robot: Robot, rng: Rng) -> Task:
    return AxisAlignment(TIPS[robot.name], rng.normal(size=3), stiffness=_gain(rng))


def _posture(robot: Robot, rng: Rng) -> Task:
    return Posture(1e3 * rng.normal(size=robot.nv), stiffness=_gain(rng))


MAKERS: tuple[Callable[[Robot, Rng], Task | Level], ...] = (
    _position,
    _pose,
    _damped,
    _orientation,
    _plane,
    _axis,
    _posture,
)


def _gain(rng: Rng) -> float:
    return float(10.0 ** rng.uniform(1.0, 5.0))


def absurd(robot: Robot, rng: Rng) -> Hierarchy:
    """Limits, then one to four levels of absurd wishes; sometimes damping below."""
    stack = TorqueLimits() >> JointLimits()
    for k in rng.choice(len(MAKERS), int(rng.integers(1, 5)), replace=False):
        stack = stack >> MAKERS[k](robot, rng)
    return stack >> Damping() if rng.random() < 0.5 else stack


@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("resolver", RESOLVERS)
@pytest.mark.parametrize("seed", range(STACKS))
def test_no_stack_drives_a_joint_beyond_its_speed_or_torque(robot, resolver, seed):
    arm, rng = ROBOTS[robot](), np.random.default_rng([seed, 77])
    controller = Controller(arm, absurd(arm, rng), RESOLVERS[resolver](), DT)
    q, v = np.clip(arm.q_home, arm.q_min + 0.02, arm.q_max - 0.02), np.zeros(arm.nv)
    fast = loaded = outside = 0.0
    for k in range(SECOND):
        solution = controller(q, v, k * DT)
        assert solution.ok, solution.message
        loaded = max(loaded, float(np.abs(solution.torque / arm.tau_max).max()))
        v = v + DT * solution.acceleration
        q = q + DT * v
        fast = max(fast, float(np.abs(v / arm.v_max).max()))
        outside = max(outside, float(np.maximum(q - arm.q_max, arm.q_min - q).max()))
    assert loaded <= 1.0 + TORQUE
    assert fast <= 1.0 + JOINT
    assert outside <= JOINT
    assert controller.failures == 0
