"""Sound, optimal, within limits, at what effort: indicators of one resolved instant."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import final

import numpy as np

from sims.compare.problems import Problem
from wbc import HierarchicalQP, Resolver, SolverError, resolve
from wbc.arrays import Array
from wbc.certificate import slack_of
from wbc.qp import DEFAULT_BACKEND
from wbc.resolver import Answer, Status
from wbc.stack import Stack

__all__ = ["Indicators", "effort", "measure", "reference"]

PUSH = 10.0
"""By how much targets are changed to see who notices [rad/s^2 or the row's unit]."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Indicators:
    """Of one problem under one resolver; NaN where there was no answer.

    Attributes:
        leak: largest change of what a level gets, when one below it wants something
            else; relative to what it gets and what was changed.
        gap: largest distance of a level's slack from its lexicographic optimum,
            relative to what it asks for.
        violation: largest excess over a bound of the top level, relative to its size.
        gauss: (tau - h)^T M^-1 (tau - h), the effort that WBCF makes least.
        acceleration: |vdot|, which TSID makes least [rad/s^2].
        torque: |tau| [Nm].
        seconds: of the solver alone.
        failed: no answer, or one that was given up before the end.
    """

    leak: float
    gap: float
    violation: float
    gauss: float
    acceleration: float
    torque: float
    seconds: float
    failed: bool


NAN = float("nan")
FAILED = Indicators(NAN, NAN, NAN, NAN, NAN, NAN, NAN, failed=True)


def reference(problem: Problem) -> tuple[Array, float]:
    """The lexicographic optimum vdot (n,), and the residual of its proof.

    By a cascade of another solver than the one that `HierarchicalQP()` is.
    """
    independent = HierarchicalQP(DEFAULT_BACKEND)
    solution = resolve(problem.state, problem.hierarchy(), independent)
    return solution.acceleration, solution.certificate().worst


def measure(
    problem: Problem, resolver: Resolver, best: Array, rng: np.random.Generator
) -> Indicators:
    """All indicators; `best` (n,) is the optimum."""
    stack = _stack(problem)
    try:
        began = time.perf_counter()
        answer = resolver.start(stack).solve()
        seconds = time.perf_counter() - began
        vdot = answer.vdot
        leak = _leak(problem, resolver, vdot, rng)
    except (SolverError, np.linalg.LinAlgError):
        return FAILED
    gauss, acceleration, torque = effort(problem, vdot)
    return Indicators(
        leak=leak,
        gap=_gap(problem, vdot, best),
        violation=_violation(problem, vdot),
        gauss=float(gauss),
        acceleration=float(acceleration),
        torque=float(torque),
        seconds=seconds,
        failed=answer.status is not Status.SOLVED,
    )


def effort(problem: Problem, vdot: Array) -> Array:
    """(tau - h)^T M^-1 (tau - h), |vdot| and |tau|, (3,)."""
    M, h = problem.state.M, problem.state.h
    tau = M @ vdot + h
    return np.array([vdot @ M @ vdot, np.linalg.norm(vdot), np.linalg.norm(tau)])


def _stack(problem: Problem) -> Stack:
    stack = Stack(problem.state.robot, problem.hierarchy())
    stack.update(problem.state)
    return stack


def _answer(problem: Problem, resolver: Resolver) -> Answer:
    return resolver.start(_stack(problem)).solve()


def _leak(
    problem: Problem, resolver: Resolver, vdot: Array, rng: np.random.Generator
) -> float:
    """Who notices that a lower level wants something else: equalities above it."""
    worst = 0.0
    for k in range(1, len(problem.levels)):
        A, lower, upper = problem.levels[k]
        if not (lower == upper).any():
            continue
        other = _answer(problem.perturbed(k, rng, PUSH), resolver).vdot
        for A, lower, upper in problem.levels[:k]:
            J = A[lower == upper]
            moved = np.linalg.norm(J @ (other - vdot))
            size = PUSH + np.linalg.norm(J @ vdot)
            worst = max(worst, float(moved / size))
    return worst


def _gap(problem: Problem, vdot: Array, best: Array) -> float:
    worst = 0.0
    for A, lower, upper in problem.levels:
        got, least = (slack_of(A, x, lower, upper) for x in (vdot, best))
        asked = slack_of(A, np.zeros(vdot.size), lower, upper)
        distance = np.linalg.norm(got - least) / (1.0 + np.linalg.norm(asked))
        worst = max(worst, float(distance))
    return worst


def _violation(problem: Problem, vdot: Array) -> float:
    """Of the levels above the first equality."""
    worst = 0.0
    for A, lower, upper in problem.levels:
        if (lower == upper).any():
            break
        excess = np.abs(slack_of(A, vdot, lower, upper))
        size = 1.0 + np.abs(A @ vdot)
        worst = max(worst, float((excess / size).max(initial=0.0)))
    return worst
