"""Every task of the catalogue against finite differences, on two robots."""

from __future__ import annotations

import inspect
import zlib

import numpy as np
import pytest

import tasks
from tests.arms import ROBOTS
from tests.catalogue import CATALOGUE, MOTION, Subject, random_state
from tests.differences import (
    T0,
    check_drift,
    check_energy,
    check_error_is_rate,
    check_jacobian_of_error,
    check_jacobian_of_rate,
    check_rate,
)
from wbc import Damper, MotionTask, Rows, State, Task, allocate_rows

SEEDS = 4
EXACT = [task for task, entry in MOTION.items() if entry.kind == "exact"]
ROTATIONS = [task for task, entry in MOTION.items() if entry.kind == "near zero"]
VELOCITIES = [task for task, entry in MOTION.items() if entry.kind == "velocity"]


def subjects(kind: type[Task], robot: str, aligned: bool = False):
    """The task in seeded states of the robot."""
    rng = np.random.default_rng(zlib.crc32(f"{kind.__name__} {robot}".encode()))
    for _ in range(SEEDS):
        state = random_state(ROBOTS[robot](), rng, T0)
        yield CATALOGUE[kind].make(state, rng, aligned), state


def each(kinds: list[type[Task]]):
    return pytest.mark.parametrize(
        "kind", [pytest.param(kind, id=kind.__name__) for kind in kinds]
    )


both_robots = pytest.mark.parametrize("robot", ROBOTS)


def test_every_task_that_is_exported_is_in_the_catalogue():
    exported = {
        item
        for name in tasks.__all__
        if inspect.isclass(item := getattr(tasks, name))
        and issubclass(item, Task)
        and not inspect.isabstract(item)
    }
    assert exported == set(CATALOGUE)


def test_every_task_in_the_catalogue_is_made_as_what_it_says():
    state = random_state(ROBOTS["seven"](), np.random.default_rng(0), T0)
    for kind, entry in CATALOGUE.items():
        task = entry.make(state, np.random.default_rng(0), False).task
        assert type(task) is kind
        assert isinstance(task, MotionTask) == (kind in MOTION)


@both_robots
@each(EXACT)
def test_the_rate_is_the_derivative_of_the_error(kind, robot):
    for subject, state in subjects(kind, robot):
        check_rate(subject, state)


@both_robots
@each(ROTATIONS)
def test_the_rate_is_the_derivative_of_a_vanishing_rotation_error(kind, robot):
    for subject, state in subjects(kind, robot, aligned=True):
        check_rate(subject, state)


@both_robots
@each(EXACT + ROTATIONS)
def test_the_rate_tells_how_the_size_of_any_error_changes(kind, robot):
    for subject, state in subjects(kind, robot):
        check_energy(subject, state)


@both_robots
@each(list(MOTION))
def test_the_drift_is_the_derivative_of_the_rate_at_constant_velocity(kind, robot):
    for subject, state in subjects(kind, robot):
        check_drift(subject, state)


@both_robots
@each(list(MOTION))
def test_the_jacobian_is_the_slope_of_the_rate_over_the_velocity(kind, robot):
    for subject, state in subjects(kind, robot):
        check_jacobian_of_rate(subject, state)


@both_robots
@each(EXACT)
def test_the_jacobian_is_the_slope_of_the_error_over_the_position(kind, robot):
    for subject, state in subjects(kind, robot):
        check_jacobian_of_error(subject, state)


@both_robots
@each(ROTATIONS)
def test_the_jacobian_is_the_slope_of_a_vanishing_rotation_error(kind, robot):
    for subject, state in subjects(kind, robot, aligned=True):
        check_jacobian_of_error(subject, state)


@both_robots
@each(VELOCITIES)
def test_the_error_of_a_velocity_task_is_its_rate(kind, robot):
    for subject, state in subjects(kind, robot):
        check_error_is_rate(subject, state)


@both_robots
@each(list(MOTION))
def test_a_task_asks_for_what_its_law_wants_less_the_drift(kind, robot):
    for subject, state in subjects(kind, robot):
        task = subject.task
        assert isinstance(task, MotionTask)
        subject.move(0.0)
        rows = allocate_rows(len(task.row_names(state.robot)), state.robot.nv)
        task.update(state, rows)
        wanted = task.law.acceleration(rows.error, rows.rate) - rows.drift
        np.testing.assert_array_equal(rows.lower, wanted)
        np.testing.assert_array_equal(rows.upper, wanted)


@both_robots
@each(list(CATALOGUE))
def test_a_second_update_at_the_same_state_writes_the_same_rows(kind, robot):
    for subject, state in subjects(kind, robot):
        m, n = len(subject.task.row_names(state.robot)), state.robot.nv
        once, twice = allocate_rows(m, n), allocate_rows(m, n)
        subject.task.update(state, once)
        for _ in range(2):
            subject.task.update(state, twice)
        for name in ("A", "lower", "upper", "error", "rate", "drift"):
            np.testing.assert_array_equal(getattr(twice, name), getattr(once, name))


class Wrong(MotionTask):
    """Another task with one of its claims bent by a thousandth."""

    def __init__(self, task: MotionTask, what: str) -> None:
        super().__init__("wrong", task.unit, task.rows, Damper(1.0), task.frames)
        self.inner, self.what = task, what

    def evaluate(self, state: State, out: Rows) -> None:
        self.inner.evaluate(state, out)
        claim = getattr(out, self.what)
        claim += 1e-3 * (1.0 + np.abs(claim))


@pytest.mark.parametrize(
    ("what", "check"),
    [
        ("J", check_jacobian_of_rate),
        ("J", check_jacobian_of_error),
        ("J", check_rate),
        ("rate", check_rate),
        ("rate", check_energy),
        ("drift", check_drift),
    ],
)
@each([tasks.FramePosition, tasks.PointOnCurve])
def test_a_wrong_claim_is_caught(kind, what, check):
    for subject, state in subjects(kind, "seven"):
        task = subject.task
        assert isinstance(task, MotionTask)
        bent = Subject(Wrong(task, what), subject.move)
        if check is check_jacobian_of_rate:
            # a constant factor on J bends the rate along with it
            bent = Subject(_Mismatched(task), subject.move)
        with pytest.raises(AssertionError):
            check(bent, state)


class _Mismatched(MotionTask):
    """A task whose rate is right while its Jacobian is not."""

    def __init__(self, task: MotionTask) -> None:
        super().__init__("wrong", task.unit, task.rows, Damper(1.0), task.frames)
        self.inner = task

    def evaluate(self, state: State, out: Rows) -> None:
        self.inner.evaluate(state, out)
        out.rate[:] -= 1e-3 * state.v.sum()
