"""What a run of the cell is: a stack, a start, a script; and what came of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias, final

import numpy as np

from sims.constraints.surface import TIP
from sims.log import Log
from sims.settle import settle
from tasks import AxisAlignment, JointLimits, PointOnPoint, Posture, TorqueLimits
from tasks.along import smooth_rise
from wbc import Hierarchy, Resolver, Robot
from wbc.arrays import Array

__all__ = [
    "DOWN",
    "READY",
    "Case",
    "Script",
    "Stack",
    "Trial",
    "limits",
    "posture_at",
    "rise",
]

Script: TypeAlias = Callable[[float], None]
Stack: TypeAlias = tuple[Hierarchy, Script | None]

DOWN = np.array([0.0, 0.0, -1.0])
READY = np.radians([0.0, 5.0, -110.0, 0.0, 75.0, 0.0])
"""A posture with the probe over the plate [rad]."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Case:
    """One run.

    Attributes:
        name: of the run.
        make: from the posture (n,) and the time that it begins at, its stack, and a
            script that moves targets.
        duration: [s].
        start: (n,) where the arm begins, at rest; None to go on from the last run.
        robot: as the controller should see it; None for the cell's own.
        resolver: makes one; None for what the user asked for.
        contact: whether the probe can touch the plate.
    """

    name: str
    make: Callable[[Array, float], Stack]
    duration: float
    start: Array | None = None
    robot: Robot | None = None
    resolver: Callable[[], Resolver] | None = None
    contact: bool = False


@final
@dataclass(frozen=True, slots=True, eq=False)
class Trial:
    """A case that was run.

    Attributes:
        case: the case.
        stack: its hierarchy and its script, in the state of the end.
        log: of the run.
        touch: (T,) true normal force between probe and plate [N].
        resolver: what ran it.
    """

    case: Case
    stack: Stack
    log: Log
    touch: Array
    resolver: Resolver


def limits() -> Hierarchy:
    """What no task may break: torques first, then joint limits."""
    return TorqueLimits() >> JointLimits(margin=0.02)


def posture_at(
    robot: Robot, p: Array, axis: Array = DOWN, near: Array = READY
) -> Array:
    """A posture (n,) with the tip at p and the probe along an axis.

    Raises:
        InputError: out of reach.
    """
    tip, aim = PointOnPoint(TIP, p), AxisAlignment(TIP, axis)
    stack = limits() >> tip >> aim >> Posture(near, stiffness=9.0)
    return settle(robot, stack, near, exact=4)


def rise(t: float, duration: float) -> tuple[float, float, float]:
    """A quintic from 0 to 1 and two derivatives, at rest outside 0 <= t <= duration."""
    u = min(max(t / duration, 0.0), 1.0)
    s, sd = smooth_rise(u)
    sdd = 60.0 * u - 180.0 * u**2 + 120.0 * u**3
    return s, sd / duration, sdd / duration**2
