"""What a resolver sees of a task: lower <= A x <= upper, with names and units."""

from __future__ import annotations

from typing import Literal, NamedTuple, TypeAlias

import numpy as np

from wbc.arrays import Array
from wbc.errors import InputError, shown

__all__ = ["Rows", "Space", "allocate_rows", "rows_over"]

Space: TypeAlias = Literal["acceleration", "torque"]
"""What the rows bind: joint accelerations vdot, or joint torques tau."""


class Rows(NamedTuple):
    """The rows of one task, written in place every tick.

    Attributes:
        error: (m,) what the task wants at zero, in the task's unit.
        rate: (m,) its rate of change.
        drift: (m,) its second derivative at zero joint acceleration.
        lower: (m,) lower bounds, -inf where there is none.
        upper: (m,) upper bounds; an equality where lower = upper.
        A: (m, n) coefficients of vdot, or of tau where the task's space is "torque".
    """

    error: Array
    rate: Array
    drift: Array
    lower: Array
    upper: Array
    A: Array

    @property
    def J(self) -> Array:
        """Another name of A, for tasks whose rows are a Jacobian."""
        return self.A


def rows_over(A: Array, bands: Array) -> Rows:
    """Rows that lie in larger arrays, as views.

    Args:
        A: (m, n).
        bands: (5, m) error, rate, drift, lower, upper.
    """
    error, rate, drift, lower, upper = bands
    return Rows(error, rate, drift, lower, upper, A)


def allocate_rows(m: int, n: int) -> Rows:
    """M rows of zeros for n joints.

    Raises:
        InputError: m or n is not a whole number of at least 0.
    """
    try:
        return rows_over(np.zeros((m, n)), np.zeros((5, m)))
    except (TypeError, ValueError) as error:
        raise InputError(
            "numbers of rows and joints, m and n, must be whole and at least 0, got "
            f"{shown(m)} and {shown(n)}."
        ) from error
