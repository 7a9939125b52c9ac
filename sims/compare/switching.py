"""Smoothness: what the torque does while limits and tasks switch on and off."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from sims.compare.problems import FixedRows, Problem
from wbc import Resolver
from wbc.arrays import Array
from wbc.stack import Stack

__all__ = ["limit_jump", "task_jump"]

STEPS = 40
"""Along the way from targets of zero to the whole ones."""
HALVINGS = 30
"""Of the largest step: what is left of it is a jump."""


def limit_jump(problem: Problem, resolver: Resolver) -> float:
    """Largest jump of the torque while growing targets drive it into its limits.

    The largest step of a sweep is halved until only a discontinuity can be left of it;
    relative to the largest |tau - h| on the way.
    """
    torque = _along(problem, resolver)
    shares = np.linspace(0.0, 1.0, STEPS + 1)
    way = np.array([torque(share) for share in shares])
    steps = np.linalg.norm(np.diff(way, axis=0), axis=1)
    i = int(np.argmax(steps))
    (low, high), (first, last) = shares[i : i + 2], way[i : i + 2]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        there = torque(middle)
        if np.linalg.norm(there - first) > np.linalg.norm(last - there):
            high, last = middle, there
        else:
            low, first = middle, there
    effort = np.linalg.norm(way - problem.state.h, axis=1).max()
    return float(np.linalg.norm(last - first) / effort)


def task_jump(problem: Problem, resolver: Resolver) -> float:
    """Jump of the torque where the last level goes, relative to |tau - h|."""
    whole = _along(problem, resolver)(1.0)
    without = _along(replace(problem, levels=problem.levels[:-1]), resolver)(1.0)
    effort = np.linalg.norm(whole - problem.state.h)
    return float(np.linalg.norm(whole - without) / effort)


def _along(problem: Problem, resolver: Resolver) -> Callable[[float], Array]:
    """Torques (n,) by the share of the targets; one solver, as in control."""
    stack = Stack(problem.state.robot, problem.hierarchy())
    solver = resolver.start(stack)

    def torque(share: float) -> Array:
        rows = problem.scaled(share).levels
        for term, (_, lower, upper) in zip(stack.terms, rows, strict=True):
            assert isinstance(term.task, FixedRows)
            term.task.lower, term.task.upper = lower, upper
        stack.update(problem.state)
        return stack.torque(solver.solve().vdot)

    return torque
