"""P4 section III-A: to a plane along its normal and align; then along the plane."""

from __future__ import annotations

import numpy as np

from sims.constraints.case import Case, Script, Stack, Trial, limits, posture_at, rise
from sims.constraints.surface import NORMAL, PLANE, TIP
from sims.log import Log
from sims.metrics import Metric
from sims.report.figures import time_series
from tasks import (
    AxisAlignment,
    Damping,
    FrameOrientation,
    FramePosition,
    Line,
    PointOnLine,
    PointOnPlane,
)
from wbc import Robot, SaturatedPD
from wbc.arrays import Array

__all__ = ["ABOVE", "GOAL", "angle", "cases", "distance", "figures", "metrics"]

STIFF, TURNING = 40000.0, 10000.0
"""Stiffness of positions and of orientations [1/s^2]."""
HEIGHT = 0.15
"""Of the start over the plane [m]."""
LEAN = 0.35
"""Between the probe and the vertical at the start [rad]."""
ABOVE = PLANE.point + np.array([-0.05, 0.06, 0.0]) + HEIGHT * NORMAL
GOAL = PLANE.point + np.array([0.10, 0.12, 0.14])
"""Of the second run [m]; it lies off the plane."""
SIDE = PLANE.point + np.array([-0.08, -0.10, 0.0])
"""Over or under where the second run begins [m]."""
TRAVEL_TIME = 2.5
BOUNDS = {
    "plane_distance_final_m": (1e-4, 1e-3),
    "plane_angle_final_rad": (1e-3, 5e-3),
    "plane_position_drift_m": (1e-4, 1e-3),
    "on_plane_distance_max_m": (1e-4, 1e-4),
    "on_plane_angle_max_rad": (1e-3, 1e-3),
    "on_plane_goal_error_m": (1e-3, 1e-3),
}
"""Largest values: with a perfect model, and with a mismatched one."""


def cases(robot: Robot) -> list[Case]:
    """Reach the plane, then align on it; afterwards move on it."""
    axis = np.array([np.sin(LEAN), 0.0, -np.cos(LEAN)])
    start = posture_at(robot, ABOVE, axis)
    on_plane = posture_at(robot, _projected(SIDE), -NORMAL)
    return [
        Case("plane_reach", lambda q, t: _reach(robot, q), 2.0, start),
        Case("plane_align", lambda q, t: _align(robot, q), 1.5),
        Case("on_plane", lambda q, t: _along(robot, q), TRAVEL_TIME + 0.8, on_plane),
    ]


def _on_plane(slow: bool) -> PointOnPlane:
    task = PointOnPlane(TIP, PLANE, stiffness=STIFF, name="tip on plane")
    if slow:
        task.law = SaturatedPD(STIFF, speed=0.12, acceleration=1.0)
    return task


def _reach(robot: Robot, q: Array) -> Stack:
    """P4 eq. (10): along the normal alone, the rest is held."""
    F = robot.state(q).frame(TIP)
    beside = PointOnLine(TIP, Line(F.p, NORMAL), stiffness=STIFF, name="beside")
    turn = FrameOrientation(TIP, F.R, stiffness=TURNING, name="orientation")
    return limits() >> _on_plane(slow=True) >> beside >> turn, None


def _align(robot: Robot, q: Array) -> Stack:
    """P4 eq. (13): the axis to the normal, below the position."""
    F = robot.state(q).frame(TIP)
    here = PointOnLine(TIP, Line(F.p, NORMAL), stiffness=STIFF, name="beside")
    axis = AxisAlignment(TIP, -NORMAL, stiffness=TURNING, name="probe along normal")
    axis.law = SaturatedPD(TURNING, speed=0.6, acceleration=3.0)
    return limits() >> _on_plane(slow=False) >> here >> axis >> Damping(), None


def _along(robot: Robot, q: Array) -> Stack:
    """P4 eq. (14): the plane above, the axis below it, the goal off the plane last."""
    begin = robot.state(q).frame(TIP).p
    axis = AxisAlignment(TIP, -NORMAL, stiffness=TURNING, name="probe along normal")
    goal = FramePosition(TIP, begin, stiffness=STIFF, name="goal")
    stack = limits() >> _on_plane(slow=False) >> axis >> goal >> Damping()
    return stack, _moving(goal, begin, GOAL)


def _moving(task: FramePosition, begin: Array, end: Array) -> Script:
    def script(t: float) -> None:
        s, sd, sdd = rise(t, TRAVEL_TIME)
        way = end - begin
        task.set_target(begin + s * way, sd * way, sdd * way)

    return script


def _projected(p: Array) -> Array:
    """The point of the plane nearest to p (3,)."""
    return p - PLANE.distance(p) * NORMAL


def distance(log: Log) -> Array:
    """Of the tip from the plane (T,) [m], positive outside."""
    return (log.p[TIP] - PLANE.point) @ NORMAL


def angle(log: Log, axis: Array = -NORMAL) -> Array:
    """Between the probe and a direction, (T,) [rad]."""
    z = log.R[TIP][:, :, 2]
    return np.arctan2(np.linalg.norm(np.cross(z, axis), axis=1), z @ axis)


def metrics(trials: dict[str, Trial], mismatch: bool) -> list[Metric]:
    """What the two runs are judged by."""
    align, along = trials["plane_align"].log, trials["on_plane"].log
    held = align.p[TIP] - align.p[TIP][0]
    values = {
        "plane_distance_final_m": abs(distance(align)[-1]),
        "plane_angle_final_rad": angle(align)[-1],
        "plane_position_drift_m": np.linalg.norm(held, axis=1).max(),
        "on_plane_distance_max_m": np.abs(distance(along)).max(),
        "on_plane_angle_max_rad": angle(along).max(),
        "on_plane_goal_error_m": np.linalg.norm(along.p[TIP][-1] - _projected(GOAL)),
    }
    return [Metric(k, float(v), BOUNDS[k][mismatch]) for k, v in values.items()]


def figures(trials: dict[str, Trial]) -> list[tuple[str, str]]:
    """Distance and angle in both runs."""
    reach, align, along = (
        trials[name].log for name in ("plane_reach", "plane_align", "on_plane")
    )
    t = np.concatenate([reach.t, align.t])
    d = np.concatenate([distance(reach), distance(align)])
    a = np.concatenate([angle(reach), angle(align)])
    first = time_series(
        "Move to a plane",
        t,
        {"distance [m]": d, "angle [rad]": a},
        "distance [m], angle [rad]",
        spans=[("reach", t[0], reach.t[-1]), ("align", align.t[0], t[-1])],
    )
    second = time_series(
        "Move on a plane: what should stay zero",
        along.t,
        {"distance [µm]": distance(along) * 1e6, "angle [µrad]": angle(along) * 1e6},
        "distance [µm], angle [µrad]",
    )
    goal = np.linalg.norm(along.p[TIP] - _projected(GOAL), axis=1)
    third = time_series(
        "Move on a plane: way to the projected goal",
        along.t,
        {"distance": goal},
        "distance [m]",
    )
    return [
        ("First down the normal, then the probe turns about a tip that stays.", first),
        ("The goal lies off the plane and ranks below it: it does no harm.", second),
        ("The tip converges to the projection of the goal.", third),
    ]
