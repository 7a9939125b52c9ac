"""The pulling arm's force over time: a ramp up, a constant, a ramp down."""

from __future__ import annotations

from typing import final

import numpy as np

from sims.cutting.timelaw import Quintic
from tasks import Impedance

__all__ = ["Pull"]


@final
class Pull:
    """Sets the desired force h_d of P0 eq. (20) along +y, robot on meat.

    The opening needs no command of its own: as links are cut, less holds the muscle
    back, and the same force opens the valley further (P0 section III-C).

    Args:
        task: the impedance of the pulling arm.
        force: [N].
        rise: duration of the ramp up [s].
    """

    def __init__(self, task: Impedance, force: float, rise: float = 0.8) -> None:
        self._task, self._force = task, force
        self._ramp = Quintic(force, rise)
        self._released: tuple[float, float, float] | None = None
        self.due = 0.0

    @property
    def steady(self) -> bool:
        """Whether the whole force is wanted."""
        return self.due == self._force

    def tick(self, t: float) -> None:
        """Set the force of time t [s]."""
        if self._released is None:
            due = self._ramp.at(t).value
        else:
            since, start, fall = self._released
            due = start - Quintic(start, fall).at(t - since).value
        if due != self.due:
            self.due = float(due)
            self._task.set_force(np.array([0.0, self.due, 0.0]))

    def release(self, t: float, fall: float) -> None:
        """Let go from time t [s] on, within `fall` seconds."""
        if self._released is None:
            self._released = (t, self.due, fall)
