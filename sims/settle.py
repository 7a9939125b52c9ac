"""Where a stack comes to rest: an ideal robot under its own controller, no engine."""

from __future__ import annotations

import numpy as np

from wbc import Controller, Hierarchy, InputError, MotionTask, Robot
from wbc.arrays import Array

__all__ = ["settle"]

PERIOD = 5e-3
EXACT = 1e-8
"""Errors below this count as met [m, rad]."""
EASE = 1.0
"""Time that the lower levels get in any case [s]."""


def settle(
    robot: Robot,
    hierarchy: Hierarchy,
    q: Array,
    *,
    exact: int,
    patience: float = 12.0,
) -> Array:
    """A configuration (n,) that meets the upper levels, and the lower ones nearly.

    Args:
        robot: the robot.
        hierarchy: tasks with constant targets.
        q: (n,) where it starts [rad].
        exact: how many levels, from the top, must be met there.
        patience: simulated time after which it gives up [s].

    Raises:
        InputError: a task of the exact levels cannot be met; the message names it.
    """
    controller = Controller(robot, hierarchy, dt=PERIOD)
    q, v = q.copy(), np.zeros(robot.nv)
    tasks = [t for level in hierarchy.levels[:exact] for t, _ in level.terms]
    needed = [task.name for task in tasks if isinstance(task, MotionTask)]
    errors: dict[str, float] = {}
    for tick in range(round(patience / PERIOD)):
        solution = controller(q, v)
        errors = dict(solution.error_norms())
        if tick * PERIOD >= EASE and max(errors[name] for name in needed) < EXACT:
            return q
        v = v + PERIOD * solution.acceleration
        q = q + PERIOD * v
    missed = max(needed, key=lambda name: errors[name])
    raise InputError(
        f"the robot finds no posture that meets '{missed}': {errors[missed]:.2g} is "
        "left. Is the target within reach?"
    )
