"""How well every level of a hierarchy was met in the course of a run."""

from __future__ import annotations

from typing import Final, final

import numpy as np

from wbc import Solution
from wbc.arrays import Array

__all__ = ["EVERY", "LevelLog"]

EVERY: Final = 10
"""Ticks between two samples: a tenth of the cost, and finer than any figure shows."""


@final
class LevelLog:
    """Samples of what tasks went without; sample j belongs to time t[j].

    It takes 8 bytes a task and sample, however the hierarchy changes.

    Args:
        ticks: of the run, at most.

    Attributes:
        t: (S,) time [s].
        shortfall: (level from 1, task) -> (S,) share of what it wanted that it did not
            get (`Solution.shortfalls`); NaN where the level had no such task, or the
            tick fell back.
    """

    def __init__(self, ticks: int) -> None:
        self._size, self._count = -(-ticks // EVERY), 0
        self.t: Array = np.full(self._size, np.nan)
        self.shortfall: dict[tuple[int, str], Array] = {}

    def record(self, tick: int, t: float, solution: Solution) -> None:
        """Keep a tick that is due, before the controller's next one."""
        if tick % EVERY:
            return
        sample = tick // EVERY
        self._count, self.t[sample] = sample + 1, t
        if not solution.ok:
            return
        for level, task, share in solution.shortfalls():
            lane = (level, task)
            if lane not in self.shortfall:
                self.shortfall[lane] = np.full(self._size, np.nan)
            self.shortfall[lane][sample] = share

    def trim(self) -> None:
        """Drop the samples that did not happen."""
        self.t = self.t[: self._count]
        for lane, shares in self.shortfall.items():
            self.shortfall[lane] = shares[: self._count]

    def arrays(self) -> dict[str, Array]:
        """Everything by name, for a file."""
        named: dict[str, Array] = {"shortfall_t": self.t}
        for (level, task), shares in self.shortfall.items():
            named[f"shortfall/level {level}: {task}"] = shares
        return named
