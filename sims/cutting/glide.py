"""Straight ways of the knife between two poses, rest to rest."""

from __future__ import annotations

from typing import final

import numpy as np

from sims.cutting.stroke import KnifeTarget, upright
from sims.cutting.timelaw import Motion, Quintic
from wbc.arrays import Array

__all__ = ["Glide"]


@final
class Glide:
    """From one place and heading to another, all on one quintic.

    Args:
        p: (3,) where it begins [m].
        heading: angle of the blade there [rad].
        p_end: (3,) where it ends [m].
        heading_end: [rad].
        duration: [s].
    """

    def __init__(
        self,
        p: Array,
        heading: float,
        p_end: Array,
        heading_end: float,
        duration: float,
    ) -> None:
        self._p, self._heading = np.array(p), float(heading)
        self._step, self._turn = np.array(p_end) - self._p, heading_end - heading
        self.duration = duration
        self._law = Quintic(1.0, duration)

    def at(self, share: Motion) -> KnifeTarget:
        """The target where `share` of the way is done."""
        u, ud, udd = share
        theta = Motion(
            self._heading + u * self._turn, ud * self._turn, udd * self._turn
        )
        d = self._step
        return upright(self._p + u * d, ud * d, udd * d, theta)

    def share(self, t: float) -> Motion:
        """Share of the way at time t [s]."""
        return self._law.at(t)
