"""The projection papers' own way with limits: what would be exceeded is locked."""

from __future__ import annotations

from typing import final

import numpy as np

from wbc.arrays import Array, BoolArray, IntArray
from wbc.linalg import recursion
from wbc.resolver import Answer, Resolver, Solver, Status
from wbc.stack import Stack

__all__ = ["PlainLocking"]

BEYOND = 1e-9
"""Relative excess from which a bound counts as exceeded."""


@final
class PlainLocking(Resolver):
    """WBCF, with every bound that it would exceed turned into an equality on top.

    P4 eq. (18) locks joints so: all at once, and none is released again in the tick,
    although locking one may lead another one back. `NullSpace` releases; this is what
    it is compared with.
    """

    name = "locking"

    def start(self, stack: Stack) -> Solver:
        """A solver without memory."""
        return _Locking(stack)


class _Locking(Solver):
    """The recursion, repeated until no bound is exceeded."""

    def __init__(self, stack: Stack) -> None:
        self._stack = stack

    def solve(self) -> Answer:
        """Resolve the present rows."""
        stack = self._stack
        free = stack.lower != stack.upper
        side = np.zeros(stack.lower.size, dtype=int)
        for _ in range(side.size + 1):
            y, ranks = recursion(list(self._blocks(side, free)), stack.robot.nv)
            value = stack.Ay @ y
            slack = BEYOND * (np.linalg.norm(stack.Ay, axis=1) + np.abs(value))
            above, below = value > stack.upper + slack, value < stack.lower - slack
            new = free & (side == 0) & (above | below)
            if not new.any():
                break
            side[new] = np.where(above[new], 1, -1)
        done = np.array([sum(pair) for pair in zip(*[iter(ranks)] * 2, strict=True)])
        return Answer(stack.acceleration(y), done, Status.SOLVED)

    def _blocks(self, side: IntArray, free: BoolArray) -> list[tuple[Array, Array]]:
        """Locked bounds, then equalities, of every level."""
        stack = self._stack
        bound = np.where(side > 0, stack.upper, stack.lower)
        blocks = []
        for where in stack.levels:
            A, b = stack.Ay[where], bound[where]
            locked = free[where] & (side[where] != 0)
            blocks += [(A[rows], b[rows]) for rows in (locked, ~free[where])]
        return blocks
