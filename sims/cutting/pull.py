"""The pulling arm's force over time: a ramp up, a constant, a ramp down."""

from __future__ import annotations

from typing import Final, final

import numpy as np

from sims.cutting.timelaw import Quintic
from tasks import Impedance
from wbc.arrays import Array

__all__ = ["Pull"]

REFRESH: Final = 4e-3
"""Between two settings of the desired velocity, which changes slowly [s]."""
BRAKING: Final = 200.0
"""What stops the arm once it has let go [N s/m]."""


@final
class Pull:
    """Sets the desired force h_d of P0 eq. (20) along +y, robot on meat.

    The desired velocity follows the measured one slowly: the damper calms what is
    fast, and costs no force where the valley opens steadily. The opening needs no
    command of its own: as links are cut, less holds the muscle back, and the same
    force opens the valley further (P0 section III-C).

    Args:
        task: the impedance of the pulling arm.
        place: (3,) of the grip at the start [m].
        force: [N].
        rise: duration of the ramp up [s].
        memory: time constant of the desired velocity [s].
    """

    def __init__(
        self,
        task: Impedance,
        place: Array,
        force: float,
        rise: float = 0.8,
        memory: float = 0.05,
    ) -> None:
        self._task, self._force = task, force
        self._ramp = Quintic(force, rise)
        self._released: tuple[float, float, float] | None = None
        self.due, self._memory = 0.0, memory
        self._place = np.array(place)
        self._before: tuple[float, float] | None = None
        self._speed = self._measured = 0.0
        self._set = -np.inf

    @property
    def steady(self) -> bool:
        """Whether the whole force is wanted."""
        return self.due == self._force

    def tick(self, t: float, y: float) -> None:
        """Set force and velocity of time t [s], with the grip at y [m]."""
        self._follow(t, y)
        if self._released is None:
            due = self._ramp.at(t).value
        else:
            since, start, fall = self._released
            due = start - Quintic(start, fall).at(t - since).value
        braking = 0.0 if self._released is None else BRAKING * self._measured
        if due != self.due or braking:
            self.due = float(due)
            self._task.set_force(np.array([0.0, self.due - braking, 0.0]))

    def _follow(self, t: float, y: float) -> None:
        if self._before is not None and t > self._before[0]:
            dt = t - self._before[0]
            self._measured = (y - self._before[1]) / dt
            self._speed += dt / self._memory * (self._measured - self._speed)
        self._before = (t, y)
        if t >= self._set + REFRESH:
            self._set = t
            speed = self._speed if self._released is None else 0.0
            self._task.set_target(self._place, (0.0, speed, 0.0))

    def release(self, t: float, fall: float) -> None:
        """Let go from time t [s] on, within `fall` seconds."""
        if self._released is None:
            self._released = (t, self.due, fall)
