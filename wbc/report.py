"""How tasks fared in a tick, from the rows of a stack and the accelerations alone."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from wbc.arrays import Array
from wbc.bounds import at_bounds
from wbc.certificate import AT_BOUND, slack_of
from wbc.stack import Stack
from wbc.term import Term

__all__ = ["TaskReport", "active_rows", "shortfalls", "task_report"]


@final
@dataclass(frozen=True, slots=True, eq=False)
class TaskReport:
    """How one task fared in a tick.

    Attributes:
        name: of the task.
        level: from 1 at the top.
        unit: of its error.
        error: (m,) in that unit, NaN for inequality tasks.
        residual: (m,) what of the wanted acceleration (or torque) was not delivered,
            in the task's own, unweighted rows.
        active: names of its rows that sit at a bound or beyond it.
    """

    name: str
    level: int
    unit: str
    error: Array
    residual: Array
    active: tuple[str, ...]


def task_report(stack: Stack, term: Term, vdot: Array) -> TaskReport:
    """Of one task, at accelerations vdot (n,)."""
    where = term.where
    A, lower, upper = stack.A[where], stack.lower[where], stack.upper[where]
    slack = slack_of(A, vdot, lower, upper)
    at = np.empty(lower.size, dtype=np.bool_)
    at_bounds(A, vdot, lower, upper, at)
    return TaskReport(
        name=term.task.name,
        level=term.level + 1,
        unit=term.task.unit,
        error=np.where(lower < upper, np.nan, term.rows.error),
        residual=slack / term.weight,
        active=tuple(n for n, a in zip(term.names, at, strict=True) if a),
    )


def active_rows(stack: Stack, vdot: Array) -> list[str]:
    """What `Solution.active_rows` tells."""
    at = np.empty(stack.lower.size, dtype=np.bool_)
    if not at_bounds(stack.A, vdot, stack.lower, stack.upper, at):
        return []
    return [
        f"level {term.level + 1}: {term.task.name}: {name}"
        for term in stack.terms
        for name, active in zip(term.names, at[term.where], strict=True)
        if active
    ]


def shortfalls(stack: Stack, vdot: Array) -> list[tuple[int, str, float]]:
    """What `Solution.shortfalls` tells."""
    value = stack.A @ vdot
    wanted = np.clip(value, stack.lower, stack.upper)
    missing = wanted - value
    length = np.sqrt(np.einsum("mn,mn->m", stack.A, stack.A))
    near = AT_BOUND * (length * (1.0 + math.sqrt(vdot @ vdot)) + np.abs(value))
    missing[np.abs(missing) <= near] = 0.0
    wanted[(stack.lower < stack.upper) & (missing == 0.0)] = 0.0
    found = []
    for term in stack.terms:
        lack, wish = missing[term.where], wanted[term.where]
        share = _share(math.sqrt(lack @ lack), math.sqrt(wish @ wish))
        found.append((term.level + 1, term.task.name, share))
    return found


def _share(part: float, whole: float) -> float:
    """Part / whole, 1 where the part is as large or larger."""
    return 0.0 if part == 0.0 else 1.0 if part >= whole else part / whole
