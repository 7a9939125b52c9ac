"""What a motion task claims, against finite differences; wrong claims raise."""

from __future__ import annotations

import numpy as np
from numpy.testing import assert_allclose

from tests.catalogue import Subject
from tests.tolerances import AFFINE, DIFFERENCE, STEP
from wbc import MotionTask, Robot, Rows, State, allocate_rows

T0 = 0.4


def rows_at(subject: Subject, robot: Robot, q, v, t: float = 0.0) -> Rows:
    """The rows of a subject, its target moved to time t after T0."""
    task = subject.task
    assert isinstance(task, MotionTask)
    subject.move(t)
    rows = allocate_rows(len(task.row_names(robot)), robot.nv)
    task.update(robot.state(q, v, T0 + t), rows)
    return rows


def _close(actual, desired, what: str) -> None:
    size = 1.0 + float(np.abs(np.asarray(desired)).max(initial=0.0))
    assert_allclose(actual, desired, rtol=0.0, atol=DIFFERENCE * size, err_msg=what)


def _moved(subject: Subject, state: State, h: float) -> Rows:
    """The rows after h seconds at constant velocity."""
    return rows_at(subject, state.robot, state.q + h * state.v, state.v, h)


def check_rate(subject: Subject, state: State) -> None:
    """d(error)/dt = rate."""
    ahead, behind = _moved(subject, state, STEP), _moved(subject, state, -STEP)
    now = _moved(subject, state, 0.0)
    slope = (ahead.error - behind.error) / (2 * STEP)
    _close(slope, now.rate, "rate")


def check_energy(subject: Subject, state: State) -> None:
    """d(|error|^2 / 2)/dt = error . rate, which rotations keep at any size."""
    ahead, behind = _moved(subject, state, STEP), _moved(subject, state, -STEP)
    now = _moved(subject, state, 0.0)
    slope = (ahead.error @ ahead.error - behind.error @ behind.error) / (4 * STEP)
    _close(slope, now.error @ now.rate, "d(|error|^2 / 2)/dt")


def check_drift(subject: Subject, state: State) -> None:
    """d(rate)/dt at constant joint velocity = drift."""
    ahead, behind = _moved(subject, state, STEP), _moved(subject, state, -STEP)
    now = _moved(subject, state, 0.0)
    _close((ahead.rate - behind.rate) / (2 * STEP), now.drift, "drift")


def check_jacobian_of_rate(subject: Subject, state: State) -> None:
    """d(rate)/dv = J; the rate is affine in v, so the step may be large."""
    robot = state.robot
    now = _moved(subject, state, 0.0)
    for i, e in enumerate(np.eye(robot.nv)):
        up = rows_at(subject, robot, state.q, state.v + e).rate
        down = rows_at(subject, robot, state.q, state.v - e).rate
        size = 1.0 + np.abs(np.concatenate([up, down])).max()
        assert_allclose(
            (up - down) / 2,
            now.J[:, i],
            rtol=0,
            atol=AFFINE * size,
            err_msg="J of rate",
        )


def check_jacobian_of_error(subject: Subject, state: State) -> None:
    """d(error)/dq = J."""
    robot = state.robot
    now = _moved(subject, state, 0.0)
    for i, e in enumerate(np.eye(robot.nv)):
        up = rows_at(subject, robot, state.q + STEP * e, state.v).error
        down = rows_at(subject, robot, state.q - STEP * e, state.v).error
        _close((up - down) / (2 * STEP), now.J[:, i], "J of error")


def check_error_is_rate(subject: Subject, state: State) -> None:
    """The error of a velocity task is its rate."""
    now = _moved(subject, state, 0.0)
    _close(now.error, now.rate, "error")
