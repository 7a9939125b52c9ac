"""The tasks of both arms, as two hierarchies or as one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from sims.cutting.layout import CUTTER, GRIP, PULLER, TIP
from sims.settle import settle
from tasks import (
    Clearance,
    FrameOrientation,
    FramePose,
    Impedance,
    JointLimits,
    KnifePose,
    Posture,
    TorqueLimits,
)
from wbc import Hierarchy, Level, Robot
from wbc.arrays import Array

__all__ = ["Stacks", "posture_at", "stacks"]

KNIFE_STIFFNESS = 3600.0
"""Kp of P0 eq. (15) [1/s^2]; Kd is critical."""
PULL_MASS = 4.0
"""Md of the pulling arm [kg]."""
PULL_STIFFNESS = (2.0e4, 0.0, 2.0e4)
"""Kp across the pull [N/m], none along it, or 100 N would not be reached."""
PULL_DAMPING = (550.0, 80.0, 550.0)
"""Kd [N s/m], about critical across the pull."""
TURNING = 1600.0
"""Of the bracket's orientation [1/s^2]."""
APART = 0.18
"""Between elbows and between wrists, whose housings have radii of about 0.08 [m]."""
MARGIN = 0.02
"""From the position limits [rad]."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Stacks:
    """What the controllers work on.

    Attributes:
        hierarchies: one a robot.
        knife: the moving target of the cutting arm.
        pull: force and place of the pulling arm.
    """

    hierarchies: tuple[Hierarchy, ...]
    knife: KnifePose
    pull: Impedance


def stacks(
    robots: tuple[Robot, ...], postures: dict[str, Array], *, rocking: bool = False
) -> Stacks:
    """Limits >> the task of each arm >> null-space damping (P0 section III).

    Args:
        robots: cutting and pulling arm, or one robot of both.
        postures: where each robot starts, by its name; targets are where it is there.
        rocking: leave the knife's rotation about the blade's normal free.
    """
    knife, pull, upright = _tasks(robots, postures, rocking)
    if len(robots) == 1:
        (both,) = robots
        apart = _clearance()
        work = apart >> knife + pull + upright
        return Stacks((_ranked(work, postures[both.name]),), knife, pull)
    cutter, puller = robots
    cutting = _ranked(Hierarchy.of(knife), postures[cutter.name])
    pulling = _ranked(Hierarchy.of(pull + upright), postures[puller.name])
    return Stacks((cutting, pulling), knife, pull)


def _clearance() -> Level:
    """Elbows and wrists of the two arms, kept apart above all work."""
    elbows = Clearance(f"{CUTTER}_link4", f"{PULLER}_link4", APART, name="elbows apart")
    wrists = Clearance(f"{CUTTER}_link6", f"{PULLER}_link6", APART, name="wrists apart")
    return elbows + wrists


def _ranked(work: Hierarchy, q: Array) -> Hierarchy:
    limits = TorqueLimits() >> JointLimits(margin=MARGIN)
    return limits >> work >> Posture(q, stiffness=1.0, damping=5.0, name="null space")


def _tasks(
    robots: tuple[Robot, ...], postures: dict[str, Array], rocking: bool
) -> tuple[KnifePose, Impedance, FrameOrientation]:
    tip = robots[0].state(postures[robots[0].name]).frame(TIP)
    grip = robots[-1].state(postures[robots[-1].name]).frame(GRIP)
    knife = KnifePose(
        TIP,
        tip.p,
        tip.R,
        rocking=rocking,
        sensor=CUTTER,
        sensor_frame=f"{CUTTER}_wrist_sensor",
        stiffness=KNIFE_STIFFNESS,
        name="knife",
    )
    pull = Impedance(
        GRIP,
        grip.p,
        mass=PULL_MASS,
        stiffness=PULL_STIFFNESS,
        damping=PULL_DAMPING,
        sensor=PULLER,
        sensor_frame=f"{PULLER}_wrist_sensor",
        name="pull",
    )
    upright = FrameOrientation(GRIP, grip.R, stiffness=TURNING, name="bracket upright")
    return knife, pull, upright


def posture_at(robot: Robot, frame: str, p: Array, R: Array) -> Array:
    """A posture (n,) with a frame at a pose, near the arm's home.

    Raises:
        InputError: out of reach.
    """
    limits = TorqueLimits() >> JointLimits(margin=MARGIN)
    stack = limits >> FramePose(frame, p, R) >> Posture(stiffness=9.0)
    aimed = robot.q_home.copy()
    base = robot.state(aimed).frame(frame.split("_")[0]).p
    aimed[0] += np.arctan2(p[1] - base[1], p[0] - base[0])
    return settle(robot, stack, aimed, exact=3)
