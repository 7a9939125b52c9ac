"""Ways into singularities of the six-axis arm, to its border and beyond."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
import pinocchio as pin

from sims.constraints.case import READY
from sims.constraints.surface import TIP
from wbc import Robot
from wbc.arrays import Array

__all__ = ["Excursion", "excursions"]

SHOULDER = np.array([0.15, 0.0, 0.43])
REACH = 0.59 + np.hypot(0.13, 0.684) + 0.34
"""From joint 2 to the tip with elbow and wrist stretched [m]."""
BEYOND = 0.3
"""Out of reach [m]."""
ASIDE = 0.004
"""Between the middle of the wrist and axis 1 as it passes by [m]."""
NO_TURN = np.zeros(3)


@final
@dataclass(frozen=True, slots=True, eq=False)
class Excursion:
    """Where the goal goes, and comes back from.

    Attributes:
        start: (6,) posture [rad].
        way: (3,) of the goal from the start [m].
        time: for the way out, and for the way back [s].
        turn: (3,) rotation vector in world axes [rad]; None for a position alone.
    """

    start: Array
    way: Array
    time: float
    turn: Array | None = None


def excursions(robot: Robot) -> dict[str, Excursion]:
    """By name: three singularities, the border, and a point out of reach."""
    stretched = np.radians([0.0, 20.0, -60.0, 0.0, 40.0, 0.0])
    bent, flipped = (
        np.radians([0.0, 5.0, -110.0, *wrist])
        for wrist in ([-30.0, 25.0, 0.0], [85.0, -20.0, 0.0])
    )
    turned = np.radians([20.0, -40.0, -120.0, 0.0, 70.0, 0.0])
    F, G = (robot.state(q).frame(TIP) for q in (bent, flipped))
    wrist = robot.state(turned).frame("link5").p
    over = 1.15 * np.array([-wrist[0], ASIDE - wrist[1], 0.0])
    p = robot.state(READY).frame(TIP).p
    out = np.array([0.90, 0.20, 0.30])
    out /= np.linalg.norm(out)
    border = SHOULDER + REACH * out - p
    return {
        "elbow": Excursion(stretched, np.array([0.6, 0.0, 0.1]), 1.5, NO_TURN),
        "wrist": Excursion(bent, G.p - F.p, 1.5, pin.log3(G.R @ F.R.T)),
        "shoulder": Excursion(turned, over, 1.5, NO_TURN),
        "border": Excursion(READY, border, 2.5),
        "beyond": Excursion(READY, border + BEYOND * out, 2.5),
    }
