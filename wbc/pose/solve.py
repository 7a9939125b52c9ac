"""The nearest configuration that satisfies a set of constraints."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike

from wbc.arrays import Array, frozen, number, per_row, positive
from wbc.checks import expect, flag, whole
from wbc.errors import InputError
from wbc.hierarchy import Hierarchy, Level
from wbc.pose.descent import Descent
from wbc.pose.goal import Goal
from wbc.pose.result import PoseResult
from wbc.robot import Robot
from wbc.task import Task

__all__ = ["solve_pose"]

UNBOUNDED = np.pi
"""How far from the start a joint without limits is searched [rad or m]."""
AT_LIMIT = 1e-9


def solve_pose(
    robot: Robot,
    goal: Task | Level | Hierarchy,
    start: ArrayLike | None = None,
    *,
    t: float = 0.0,
    margin: float = 0.0,
    weights: ArrayLike = 1.0,
    tolerance: float = 1e-6,
    attempts: int = 16,
    quick: bool = False,
    seed: int = 0,
) -> PoseResult:
    """The configuration nearest to a start posture where all tasks hold.

    P4 solves the constraints of a task "to obtain the target pose closest to the
    previous waypoint". Only the positions of the tasks count; limits, and tasks of
    velocity alone, may stand among them and are left out: the joint limits always
    hold. Levels are strict: a level is pursued only where those above it hold. Give
    what must hold and no more: the posture to stay near is the start, not a task.

    From the start the levels are brought to hold one after the other, then the
    configuration slides along where they hold until none nearby is nearer to the
    start. Seeded random starts do the same; the nearest pose of all is the answer.

    Args:
        robot: whose configuration is sought.
        goal: tasks, a level, or a hierarchy.
        start: (n,) posture to stay near; the robot's home by default.
        t: time [s] at which moving targets are taken.
        margin: distance to keep from the position limits [rad or m].
        weights: what each joint's displacement is multiplied by, one number or (n,).
        tolerance: largest error of a task that holds [m, rad].
        attempts: how many starts to try.
        quick: stop at the first pose: about `attempts` times faster, but the way from
            the start may lead into a branch that is not the nearest.
        seed: of the random starts.

    Returns:
        the pose, or the closest miss; `ok` says which.

    Raises:
        InputError: no task has a position, or an unusable argument.
        UnknownName: a frame or joint that the robot does not have.
        SolverError: a task wrote a row that is not finite.

    Example:
        `print(solve_pose(arm, PointOnPoint("tip", [2.0, 0.0, 1.0])))` says

            no pose found from 16 starts; the closest misses
              tip on point (level 1) by 1.15 m
    """
    expect(Robot, robot=robot)
    expect(Task | Level | Hierarchy, goal=goal)
    flag(quick=quick)
    scale, t = _scale(weights, robot.nv), number(t, "t")
    margin = positive(margin, "margin", zero=True)
    low, high = scale * (robot.q_min + margin), scale * (robot.q_max - margin)
    if (low >= high).any():
        raise InputError(f"margin {margin} leaves no range of a joint.")
    wish = scale * frozen(
        robot.q_home if start is None else start, (robot.nv,), "start"
    )
    positive(tolerance, "tolerance")
    attempts, seed = whole(attempts, "attempts", 1), whole(seed, "seed")
    found = Goal(robot, Hierarchy.of(goal), t, scale)
    descent = Descent(found, low, high)
    best: tuple[float, ...] = (np.inf,)
    u, tried = np.clip(wish, low, high), 0
    for first in _starts(wish, low, high, attempts, seed):
        tried += 1
        trial, rank = _descend(descent, found, first, wish, tolerance)
        if rank < best:
            best, u = rank, trial
        if best[0] == 0 and quick:
            break
    tasks = found.misses(u, tolerance)
    q = u / scale
    return PoseResult(
        ok=all(task.met for task in tasks),
        q=np.clip(q, robot.q_min + margin, robot.q_max - margin),
        distance=float(np.linalg.norm(u - wish)),
        tasks=tasks,
        at_limit=tuple(_at_limit(robot, u, low, high)),
        attempts=tried,
        evaluations=found.evaluations,
    )


def _descend(
    descent: Descent, goal: Goal, u: Array, wish: Array, tolerance: float
) -> tuple[Array, tuple[float, ...]]:
    """Where a start leads, and how good that is: levels missed, then by how much."""
    for k in range(goal.count):
        u = descent.approach(u, k)
        error = goal.miss(u, k)
        if error > tolerance:
            return u, (goal.count - k, error)
    u = descent.slide(u, wish)
    return u, (0, float(np.linalg.norm(u - wish)))


def _starts(
    wish: Array, low: Array, high: Array, attempts: int, seed: int
) -> Iterator[Array]:
    """The start itself, then ever further from it, every second one anywhere."""
    yield np.clip(wish, low, high)
    rng = np.random.default_rng(seed)
    bottom = np.where(np.isfinite(low), low, wish - UNBOUNDED)
    top = np.where(np.isfinite(high), high, wish + UNBOUNDED)
    for i in range(1, attempts):
        anywhere = rng.uniform(bottom, top)
        share = 1.0 if i % 2 == 0 else i / attempts
        yield np.clip(wish + share * (anywhere - wish), low, high)


def _scale(weights: ArrayLike, n: int) -> Array:
    scale = per_row(weights, "weights")
    if scale.shape not in ((), (n,)) or (scale <= 0).any():
        raise InputError(f"weights must be greater than 0, one number or ({n},).")
    return np.broadcast_to(scale, (n,)).copy()


def _at_limit(robot: Robot, u: Array, low: Array, high: Array) -> Iterator[str]:
    for joint, x, bottom, top in zip(robot.joint_names, u, low, high, strict=True):
        if x <= bottom + AT_LIMIT:
            yield f"{joint} at its lower limit"
        elif x >= top - AT_LIMIT:
            yield f"{joint} at its upper limit"
