"""Whether a lower task disturbs a higher one, measured on the stacks that were run."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from sims.constraints.case import Trial
from sims.log import Log
from wbc import Hierarchy, Robot
from wbc.arrays import Array
from wbc.resolver import Resolver
from wbc.stack import Stack

__all__ = ["soundness", "soundness_along"]

SAMPLES = 5
SHAKE = 0.2
"""Joint velocities are perturbed by so much [rad/s], so that nothing is at rest."""
PERTURBATION = 10.0
"""Of what the last level asks for [rad/s^2]."""


def soundness(trial: Trial, seed: int = 0) -> float:
    """Largest relative change of what higher levels get, when the last one changes.

    At states along the run, what the lowest level asks for is perturbed. Equalities are
    compared: a bound that does not bind may be used differently.
    """
    robot = trial.case.robot or trial.log.robot
    return soundness_along(trial.log, robot, trial.stack[0], trial.resolver, seed=seed)


def soundness_along(
    log: Log,
    robot: Robot,
    hierarchy: Hierarchy,
    resolver: Resolver,
    *,
    script: Callable[[float], None] | None = None,
    shake: float = SHAKE,
    seed: int = 0,
) -> float:
    """The same of a stack at states along a log; a script moves targets to a time.

    A stiff stack needs less shaking, or the limits leave it no freedom to disturb.
    """
    rng = np.random.default_rng(seed)
    stack, worst = Stack(robot, hierarchy), 0.0
    last = stack.levels[-1]
    equal = np.arange(stack.lower.size) < last.start
    for i in np.linspace(0, log.t.size - 1, SAMPLES).astype(int):
        if script is not None:
            script(float(log.t[i]))
        v = log.v[i] + rng.uniform(-shake, shake, robot.nv)
        wrenches = {name: values[i] for name, values in log.wrenches.items()}
        stack.update(robot.state(log.q[i], v, log.t[i], wrenches=wrenches))
        rows = equal & (stack.lower == stack.upper)
        first = _delivered(stack, resolver)[rows]
        change = rng.uniform(-PERTURBATION, PERTURBATION, last.stop - last.start)
        stack.lower[last] += change
        stack.upper[last] += change
        second = _delivered(stack, resolver)[rows]
        worst = max(
            worst, float(np.abs(second - first).max() / (1 + np.abs(first).max()))
        )
    return worst


def _delivered(stack: Stack, resolver: Resolver) -> Array:
    """What each row (m,) gets: A vdot."""
    delivered: Array = stack.A @ resolver.start(stack).solve().vdot
    return delivered
