"""What stands where in the cutting cell, and how the passages are timed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from robots import compose, lwr4
from wbc import InputError, Robot
from wbc.arrays import positive

__all__ = [
    "CUTTER",
    "DEPTHS",
    "GRIP",
    "PULLER",
    "TABLE",
    "TIP",
    "Plan",
    "placed",
    "robot_of",
]

CUTTER: Final = "cutter"
PULLER: Final = "puller"
TIP: Final = "cutter_knife_tip"
GRIP: Final = "puller_grip"
TABLE: Final = 0.27
"""Height of the table [m], P0 section IV."""
DEPTHS: Final = (0.35, 0.33, 0.31, 0.29, 0.27)
"""Heights of the knife's tip, one a passage [m], P0 Table II."""
BASES: Final = {CUTTER: (0.0, 0.0, 0.0), PULLER: (0.0, 0.4, 0.0)}
TOOLS: Final = {CUTTER: "knife", PULLER: "bracket"}


def placed(*names: str) -> dict[str, compose.Placed]:
    """Arms by name with their tools, where P0 section II puts their bases."""
    return {n: compose.Placed(lwr4.mjcf(TOOLS[n]), BASES[n]) for n in names}


def robot_of(*names: str) -> Robot:
    """One arm, or both as one robot of 14 axes."""
    return compose.load(placed(*names))


@final
@dataclass(frozen=True, slots=True)
class Plan:
    """Depths and times of the passages.

    Attributes:
        depths: heights of the tip, from the top down [m].
        stroke: duration of the cut of one passage [s].
        travel: of the way back above the meat [s].
        lift: of a lift, and of a descent [s].
        settling: from the start of the pull to the first passage [s].
        overrun: how far before and beyond the meat a passage begins and ends [m].
        height: of the way back [m].
        pull: force of the pulling arm [N].
        order: of the polynomial that is fitted to a guide line.

    Raises:
        InputError: a depth below the table, depths that do not descend, or a number
            that is not positive.
    """

    depths: tuple[float, ...] = DEPTHS
    stroke: float = 2.8
    travel: float = 1.1
    lift: float = 0.6
    settling: float = 1.5
    overrun: float = 0.012
    height: float = 0.40
    pull: float = 100.0
    order: int = 2

    @property
    def duration(self) -> float:
        """Of the whole, if nothing holds the knife up [s]."""
        passage = self.travel + self.stroke + 2.0 * self.lift
        return self.settling + passage * len(self.depths) + 1.0

    def __post_init__(self) -> None:
        """Check everything once."""
        for name in ("stroke", "travel", "lift", "settling", "overrun", "pull"):
            positive(getattr(self, name), name)
        if not self.depths:
            raise InputError("a plan needs at least one passage.")
        for number, depth in enumerate(self.depths, 1):
            if not depth >= TABLE - 1e-9:
                raise InputError(
                    f"passage {number} at z = {depth} m is deeper than the table at "
                    f"z = {TABLE} m: the knife would hit it."
                )
        if (np.diff(self.depths) >= 0.0).any():
            raise InputError(f"depths must descend from the top: {self.depths}.")
        if self.height <= self.depths[0]:
            raise InputError(f"the way back at {self.height} m is not above the cut.")
