"""How singular the goal of a run became, and whether the stack said so."""

from __future__ import annotations

import numpy as np

from sims.constraints.case import Trial
from sims.constraints.surface import TIP
from tasks import FramePose, FramePosition
from wbc import Hierarchy, resolve
from wbc.arrays import Array

__all__ = ["SINGULAR", "goal_of", "reported", "weakness"]

SINGULAR = 0.05
"""Smallest singular value over the norm of J from where a posture is a singular one."""
SAMPLE = 20
"""Ticks between two looks at the singular values."""


def goal_of(trial: Trial) -> FramePose | FramePosition:
    """The task of a trial's stack that is named "goal"."""
    task = next(t for t in trial.stack[0].tasks() if t.name == "goal")
    assert isinstance(task, FramePose | FramePosition)
    return task


def weakness(trial: Trial) -> tuple[Array, Array]:
    """Smallest singular value of the goal, relative to its norm, at some times.

    Returns:
        Indices of the ticks (K,), and the values (K,).
    """
    log, rows = trial.log, len(goal_of(trial).rows)
    ticks = np.arange(0, log.t.size, SAMPLE)
    J = [log.robot.state(log.q[k]).frame(TIP).J[:rows] for k in ticks]
    s = np.linalg.svd(np.array(J), compute_uv=False)
    return ticks, s[:, -1] / np.linalg.norm(s, axis=1)


def reported(trial: Trial) -> bool:
    """Whether the tick nearest to the singularity says what is lost, and to whom.

    The analysis finds a direction less than the goal has rows; the explanation says
    that the goal is not met, how much is missing, and that a singular direction is why.
    """
    log, (hierarchy, script) = trial.log, trial.stack
    ticks, values = weakness(trial)
    k = int(ticks[np.argmin(values)])
    if script is not None:
        script(float(log.t[k]))
    state = log.robot.state(log.q[k], log.v[k], float(log.t[k]))
    goal = Hierarchy.of(goal_of(trial))
    level = goal.analyse(state, metric="joint", tolerance=SINGULAR).level("goal")
    task = resolve(state, hierarchy, trial.resolver).explain().task("goal")
    blamed = any(blocker.task == "singular damping" for blocker in task.blockers)
    return level.rank < level.rows and not task.met and blamed
