"""What the cell is tried with: seeded cylinders and start postures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from sims.grasping.cylinder import Cylinder, seeded_cylinders
from sims.grasping.plan import TCP
from sims.grasping.scene import STAND
from wbc import Robot
from wbc.arrays import Array

__all__ = ["COUNT", "Case", "seeded_cases"]

COUNT: Final = 12
READY: Final = np.radians([0.0, -20.0, -122.0, 0.0, 52.0, 180.0])
"""A posture over the table with the fingers down [rad]."""
SPREAD: Final = 0.35
"""Of the start postures about it [rad]."""
LOWEST: Final = 0.70
"""Height of the tcp at the start [m]: free of everything on the table."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Case:
    """A cylinder and the posture (n,) from which it is to be grasped [rad]."""

    cylinder: Cylinder
    start: Array


def seeded_cases(robot: Robot, seed: int, count: int = COUNT) -> list[Case]:
    """The first `count` cases of a seed."""
    rng = np.random.default_rng([seed, 1])
    cylinders = seeded_cylinders(seed, count, STAND)
    return [Case(cylinder, _start(robot, rng)) for cylinder in cylinders]


def _start(robot: Robot, rng: np.random.Generator) -> Array:
    while True:
        q = READY + rng.uniform(-SPREAD, SPREAD, READY.size)
        if robot.state(q).frame(TCP).p[2] > LOWEST:
            return q
