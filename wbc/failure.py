"""What to say where a tick came to no good end."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

import numpy as np

from wbc import slots
from wbc.errors import ModelError, SolverError

if TYPE_CHECKING:
    from wbc.stack import Stack

__all__ = ["complain"]


def complain(stack: Stack, outcome: int) -> NoReturn:
    """Raise what a stack's compiled tick has run into, as `wbc.slots` lists it.

    Raises:
        ModelError: the inertia matrix is not positive definite.
        SolverError: anything else.
    """
    if outcome == slots.NOT_POSITIVE:
        raise ModelError("the inertia matrix is not positive definite.")
    if outcome == slots.BAD_ROW:
        raise _bad_row(stack)
    if outcome == slots.BEYOND:
        raise SolverError(
            f"'{stack.terms[0].task.name}' on top cannot be broken, and was: a "
            "velocity, target or gain is too large to calculate with."
        )
    if outcome == slots.UNMEASURED:
        raise SolverError("a position, a velocity or the time is not finite.")
    raise SolverError("a torque is not finite.")


def _bad_row(stack: Stack) -> SolverError:
    """Of the first row that is not finite."""
    numbers = np.isfinite(stack.Ay).all(axis=1)
    sound = numbers & ~np.isnan(stack.lower) & ~np.isnan(stack.upper)
    row = int(np.argmin(sound))
    term = next(t for t in stack.terms if row < t.where.stop)
    name = term.names[row - term.where.start]
    return SolverError(
        f"task '{term.task.name}' wrote a row '{name}' that is not finite.", term.level
    )
