"""Features that move, followed in closed loop; and what stands below them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import tasks
from tasks.geometry import Constraint
from tests.arms import HOME, seven_axis, two_arms
from tests.catalogue import CATALOGUE, random_state
from tests.tolerances import SOUND
from wbc import (
    HierarchicalQP,
    Hierarchy,
    NullSpace,
    Robot,
    State,
    Task,
    allocate_rows,
    resolve,
)

Z = np.eye(3)[2]
DT = 2e-3
FOLLOWED = 1e-5
"""[m], [rad]: what a step of 2 ms at constant acceleration leaves."""
BEHIND = 1e-3
"""What a target that hides its motion costs at the least [m]."""

CONSTRAINTS = [kind for kind in CATALOGUE if issubclass(kind, Constraint)]
both_resolvers = pytest.mark.parametrize(
    "resolver", [HierarchicalQP(), NullSpace()], ids=lambda resolver: resolver.name
)


def error_of(task: Task, state: State) -> float:
    rows = allocate_rows(len(task.row_names(state.robot)), state.robot.nv)
    task.update(state, rows)
    return float(np.abs(rows.error).max())


def largest_error(
    robot: Robot,
    hierarchy: Hierarchy,
    q: np.ndarray,
    v: np.ndarray,
    move: Callable[[float], None] = lambda t: None,
    resolver=None,
) -> tuple[float, np.ndarray]:
    """Of the first task, over half a second of ideal torque control; the last q."""
    first, worst = next(hierarchy.tasks()), 0.0
    for i in range(250):
        move(i * DT)
        state = robot.state(q, v, i * DT)
        worst = max(worst, error_of(first, state))
        a = resolve(state, hierarchy, resolver or HierarchicalQP()).acceleration
        q = q + DT * v + 0.5 * DT * DT * a
        v = v + DT * a
    return worst, q


def start_on(task: Task, robot: Robot, q: np.ndarray) -> np.ndarray:
    """Joint velocity with which the task's error starts without a rate."""
    rows = allocate_rows(len(task.row_names(robot)), robot.nv)
    task.update(robot.state(q), rows)
    return -np.linalg.pinv(rows.A) @ rows.rate


@both_resolvers
def test_a_conveyor_that_speeds_up_is_followed(resolver):
    robot = seven_axis()
    p = robot.state(HOME).frame("tip").p
    belt = tasks.MovingFrame.steady([0.0, 0.2, 0.0], acceleration=[0.1, 0.4, 0.0])
    task = tasks.PointOnPoint("tip", tasks.Point(p, on=belt))
    stack = task >> tasks.Posture(HOME)
    v = start_on(task, robot, HOME)
    assert largest_error(robot, stack, HOME, v, resolver=resolver)[0] < FOLLOWED


def test_a_tracked_work_piece_is_followed_and_one_that_hides_its_motion_is_not():
    robot = seven_axis()
    p = robot.state(HOME).frame("tip").p
    spin = np.array([0.0, 0.0, 0.8])

    def motion(t: float) -> tasks.FrameMotion:
        c, s = np.cos(0.8 * t), np.sin(0.8 * t)
        R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        return tasks.FrameMotion((0, 0, 0), R, (0, 0, 0, *spin))

    piece = tasks.MovingFrame(motion(0.0), name="work-piece")
    task = tasks.PointOnCircle(
        "tip", tasks.Circle(p + 0.1 * Z, [0.0, 1.0, 0.0], 0.1, on=piece)
    )
    stack = task >> tasks.Posture(HOME)
    v = start_on(task, robot, HOME)

    def tracked(t: float) -> None:
        now = motion(t)
        piece.set(now.position, now.orientation, now.twist)

    def hidden(t: float) -> None:
        piece.set(motion(t).position, motion(t).orientation)

    assert largest_error(robot, stack, HOME, v, tracked)[0] < FOLLOWED
    assert largest_error(robot, stack, HOME, v, hidden)[0] > BEHIND


@both_resolvers
def test_one_arm_holds_a_line_that_the_other_one_carries_away(resolver):
    robot, q = two_arms(), np.concatenate([HOME, HOME])
    state = robot.state(q)
    left, right = state.frame("left_tip"), state.frame("right_tip")
    line = tasks.Line(
        right.R.T @ (left.p - right.p), right.R.T @ left.R[:, 2], on="right_tip"
    )
    tool = tasks.Line(np.zeros(3), Z, on="left_tip")
    task = tasks.LineOnLine(tool, line)
    carried = [f"right_a{j}" for j in range(1, 8)]
    away = tasks.Posture(HOME - 0.05, joints=carried, name="carry")
    stack = task >> away >> tasks.Damping()
    assert error_of(task, state) < 1e-12
    worst, last = largest_error(robot, stack, q, np.zeros(14), resolver=resolver)
    assert worst < FOLLOWED
    assert np.linalg.norm(robot.state(last).frame("right_tip").p - right.p) > 0.02


@both_resolvers
@pytest.mark.parametrize("kind", CONSTRAINTS, ids=lambda kind: kind.__name__)
def test_no_task_below_disturbs_a_constraint(kind, resolver):
    rng = np.random.default_rng(29)
    for _ in range(3):
        state = random_state(seven_axis(), rng, 0.4)
        above = CATALOGUE[kind].make(state, rng, False).task
        rows = allocate_rows(len(above.row_names(state.robot)), 7)
        above.update(state, rows)
        postures = [tasks.Posture(rng.uniform(-2.0, 2.0, 7)) for _ in range(2)]
        stacks = [Hierarchy(above), *(above >> posture for posture in postures)]
        a = np.array([resolve(state, s, resolver).acceleration for s in stacks])
        size = 1.0 + np.abs(rows.A) @ np.abs(a).max(axis=0)
        for other in a[1:]:
            assert (np.abs(rows.A @ (other - a[0])) <= SOUND * size).all()
