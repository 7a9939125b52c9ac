"""What a resolver sees of a task: lower <= A x <= upper, with names and units."""

from __future__ import annotations

from typing import Literal, TypeAlias, final

import numpy as np

from wbc.arrays import Array

__all__ = ["Rows", "Space"]

Space: TypeAlias = Literal["acceleration", "torque"]
"""What the rows bind: joint accelerations vdot, or joint torques tau."""


@final
class Rows:
    """The rows of one task, written in place every tick.

    Attributes:
        A: (m, n) coefficients of vdot, or of tau where `space` is "torque".
        lower: (m,) lower bounds, -inf where there is none.
        upper: (m,) upper bounds; an equality where lower = upper.
        error: (m,) what the task wants at zero, in the task's unit.
        rate: (m,) its rate of change.
        drift: (m,) its second derivative at zero joint acceleration.
    """

    __slots__ = ("A", "drift", "error", "lower", "rate", "upper")

    def __init__(self, m: int, n: int) -> None:
        self.A = np.zeros((m, n))
        self.lower = np.zeros(m)
        self.upper = np.zeros(m)
        self.error = np.zeros(m)
        self.rate = np.zeros(m)
        self.drift = np.zeros(m)

    @property
    def J(self) -> Array:
        """Another name of A, for tasks whose rows are a Jacobian."""
        return self.A
