"""The jobs of the welding cell, each a stack of tasks, a start and a script."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np

from sims.settle import settle
from sims.view.jogger import Jogger
from sims.welding.jog import Jog
from sims.welding.workpiece import CURVE, CURVE_WORK, POINT, SEAM, SEAM_AXIS, start_of
from tasks import (
    AxisAlignment,
    AxisAlongPath,
    Damping,
    FrameOrientation,
    JointLimits,
    PointOnCurve,
    PointOnLine,
    PointOnPoint,
    Posture,
    TorqueLimits,
    TravelSpeed,
)
from wbc import Hierarchy, Robot
from wbc.arrays import Array

__all__ = ["CURVE_SPEED", "SEAM_SPEED", "TIP", "TRAVEL", "Part", "parts"]

TIP = "torch_tip"
STIFFNESS = 14400.0
"""Of the weld itself [1/s^2]; the orientation follows at a lower one."""
TURNING = 900.0
SEAM_SPEED = 0.04
"""[m/s], as in P4 section IV-B."""
CURVE_SPEED = 0.02
"""[m/s]"""
TRAVEL = 0.17
"""Travel angle of the curve [rad]: the torch pushes by 10 degrees."""
SPEED_GAIN = 400.0
RAMP = 0.5
"""Of the travel speed [s]."""
DEPARTURE = 0.5
"""When the torch sets off [s]."""
SADDLE_READY = np.radians([28.0, -4.0, -122.0, 0.0, 52.0, 180.0])
READY = np.radians([0.0, -4.0, -122.0, 0.0, 52.0, 180.0])
"""Postures in front of the saddle and of the T-joint [rad]."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """One job.

    Attributes:
        name: "point", "seam", "seam_still" or "curve".
        hierarchy: what is wanted, most important first.
        start: (n,) where the arm begins, at rest [rad].
        duration: [s].
        script: moves targets to a time [s].
    """

    name: str
    hierarchy: Hierarchy
    start: Array
    duration: float
    script: Callable[[float], None] | None = None


def parts(robot: Robot, jogger: Jogger | None = None) -> list[Part]:
    """Point weld with jogging, straight seam with and without, curved seam.

    Args:
        robot: the arm, with a site "torch_tip".
        jogger: an operator's keyboard; the scripted motion without one.
    """
    ready = _ready(robot, start_of(SEAM), SEAM_AXIS, READY)
    R = robot.state(ready).frame(TIP).R
    at_point = _ready(robot, POINT, SEAM_AXIS, ready, R)
    return [
        _point(at_point, R, jogger),
        _seam(ready, R, jogger, jogged=True),
        _seam(ready, R, jogger, jogged=False),
        _curve(robot),
    ]


def limits() -> Hierarchy:
    """What no task may break: torques first, then joint limits."""
    return TorqueLimits() >> JointLimits(margin=0.02)


def _point(start: Array, R: Array, jogger: Jogger | None) -> Part:
    """P4 section IV-B: tip on a point, the operator jogs the orientation."""
    jogged = FrameOrientation(TIP, R, stiffness=TURNING, name="jogged orientation")
    on_point = PointOnPoint(TIP, POINT, stiffness=STIFFNESS, name="tip on point")
    stack = limits() >> on_point >> jogged >> Damping()
    return Part("point", stack, start, 8.0, _jogging(jogged, R, jogger))


def _seam(start: Array, R: Array, jogger: Jogger | None, *, jogged: bool) -> Part:
    """P4 section IV-B: tip on a line >> speed along it >> orientation."""
    turned = FrameOrientation(TIP, R, stiffness=TURNING, name="jogged orientation")
    on_seam = PointOnLine(TIP, SEAM, stiffness=STIFFNESS, name="tip on seam")
    speed = TravelSpeed(
        TIP,
        SEAM,
        speed=SEAM_SPEED,
        ramp=RAMP,
        start=DEPARTURE,
        gain=SPEED_GAIN,
        name="travel",
    )
    stack = limits() >> on_seam >> speed >> turned >> Damping()
    duration = DEPARTURE + SEAM.length / SEAM_SPEED + 2.0
    if not jogged:
        return Part("seam_still", stack, start, duration)
    return Part("seam", stack, start, duration, _jogging(turned, R, jogger))


def _jogging(
    task: FrameOrientation, R: Array, jogger: Jogger | None
) -> Callable[[float], None]:
    if jogger is None:
        jog = Jog(R)
        return lambda t: jog.script(task, t)
    jogger.begin(R)
    return lambda t: jogger.script(task, t)


def _curve(robot: Robot) -> Part:
    """Tip on a saddle >> speed along it >> work and travel angle; spin is free."""
    on_curve = PointOnCurve(TIP, CURVE, stiffness=STIFFNESS, name="tip on curve")
    speed = TravelSpeed(
        TIP,
        CURVE,
        speed=CURVE_SPEED,
        ramp=RAMP,
        start=DEPARTURE,
        gain=SPEED_GAIN,
        name="travel",
    )
    angles = AxisAlongPath(
        TIP, CURVE, work=CURVE_WORK, travel=TRAVEL, stiffness=TURNING, name="angles"
    )
    stack = limits() >> on_curve >> speed >> angles >> Posture(READY, stiffness=9.0)
    axis = _axis_at_start(angles)
    start = _ready(robot, start_of(CURVE), axis, SADDLE_READY)
    return Part("curve", stack, start, DEPARTURE + CURVE.length / CURVE_SPEED + 2.0)


def _axis_at_start(angles: AxisAlongPath) -> Array:
    return angles.direction_at(angles.path.at(0.0))[0]


def _ready(
    robot: Robot, p: Array, axis: Array, q: Array, R: Array | None = None
) -> Array:
    """A posture with the tip at p and the torch along an axis, or at orientation R."""
    tip = PointOnPoint(TIP, p)
    aim = AxisAlignment(TIP, axis) if R is None else FrameOrientation(TIP, R)
    stack = limits() >> tip >> aim >> Posture(q, stiffness=9.0)
    return settle(robot, stack, q, exact=4)
