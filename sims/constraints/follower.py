"""The script of the hybrid run: find a plate, align with it, slide along it."""

from __future__ import annotations

import numpy as np

from sims.constraints.case import DOWN, rise
from tasks import AxisAlignment, HybridForceMotion
from wbc.arrays import Array, unit

__all__ = ["SLIDE", "Follower", "axes_along"]

REST = 0.5
"""At rest before a look at the force [s]: while the probe turns, friction bends it."""
LOOK = 0.2
"""Time over which it is averaged [s]."""
TURN = 1.0
"""Time of a turn towards it [s]."""
ALIGNED = 4e-3
"""Between force and probe: then only the normal force is left [rad]."""
TURNS = 4
"""At most so many: friction that sticks would bend the force again and again."""
SLIDE, LENGTH = 5.0, 0.202
"""The slide takes so long [s] and goes so far [m]."""


class Follower:
    """The script of the run: what the sensor feels decides what comes next.

    Attributes:
        task: presses along z of its axes D.
        axis: turns the probe along the same direction.
        found: when contact was felt [s], NaN before.
        slid: when the slide began [s], NaN before.
    """

    def __init__(self, task: HybridForceMotion, axis: AxisAlignment) -> None:
        self.task, self.axis = task, axis
        self.found = self.slid = np.nan
        self._since, self._turns = 0.0, 0
        self._sum = np.zeros(3)
        self._direction, self._next = DOWN, DOWN

    def __call__(self, t: float) -> None:
        """Move the targets to time t [s]."""
        if np.isnan(self.found):
            if self.task.touching:
                self.found = self._since = t
        elif not np.isnan(self.slid):
            self._slide(t - self.slid)
        elif t < self._since + REST + LOOK:
            if t >= self._since + REST:
                self._sum += self.task.felt[:3]
        elif not self._sum.any():
            self._turn(t, t - self._since - REST - LOOK)
        else:
            self._decide(t)

    def _decide(self, t: float) -> None:
        """Turn again if the mean force is not along the probe; slide if it is."""
        self._next = unit(self._sum, "the mean force")
        self._sum[:] = 0.0
        self._begin = self.task.position
        self.task.set_target(self._begin)
        aligned = np.linalg.norm(self._next - self._direction) < ALIGNED
        if aligned or self._turns == TURNS:
            self.slid = t
        self._turns += 1

    def _turn(self, t: float, since: float) -> None:
        """From the old direction to the new one, task axes and probe alike."""
        s, _, _ = rise(since, TURN)
        way = (1.0 - s) * self._direction + s * self._next
        direction = unit(way, "the direction of the turn")
        self.task.set_axes(axes_along(direction))
        self.axis.set_target(direction)
        if since >= TURN:
            self._direction, self._since = self._next, t

    def _slide(self, t: float) -> None:
        """Along the plate, in the direction of y as far as it goes."""
        way = LENGTH * axes_along(self._direction)[:, 1]
        s, sd, sdd = rise(t, SLIDE)
        self.task.set_target(self._begin + s * way, None, sd * way, sdd * way)


def axes_along(z: Array) -> Array:
    """R_WD (3, 3), its z axis along z (3,) and its y axis near to the world's."""
    x = np.cross([0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])
