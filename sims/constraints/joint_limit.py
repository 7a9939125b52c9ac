"""P4 section III-B: a goal that asks the elbow for more than it has, met four ways."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from sims.constraints.case import READY, Case, Stack, Trial, rise
from sims.constraints.surface import TIP
from sims.log import Log
from sims.metrics import Metric
from sims.report.figures import time_series
from tasks import Damping, FramePosition, JointLimits, JointLocking, TorqueLimits
from wbc import HierarchicalQP, Hierarchy, NullSpace, Resolver, Robot
from wbc.arrays import Array

__all__ = ["cases", "figures", "metrics"]

ELBOW = 2
LIMIT = np.radians(-95.0)
"""Largest angle that the elbow should take; the mechanical one is 0 [rad]."""
ZONE = 0.1
"""The activation zone below it [rad]."""
STIFF = 2500.0
WAY = np.array([0.30, 0.10, 0.20])
"""From the start to the goal [m]."""
OUT, WAIT, BACK = 1.6, 0.4, 1.6
"""Times to go to the goal, to stay, and to return [s]."""
WAYS: dict[str, tuple[str, Callable[[], Resolver] | None]] = {
    "baseline": ("no handling", None),
    "locking": ("locking (P4)", NullSpace),
    "unilateral": ("unilateral projection", NullSpace),
    "qp": ("viable bounds in the QP", HierarchicalQP),
}
"""What each way is called, and the resolver that belongs to it, if any."""


def cases(robot: Robot) -> list[Case]:
    """The same goal four times."""
    q_max = robot.q_max.copy()
    q_max[ELBOW] = LIMIT
    narrow = replace(robot, q_max=q_max)
    return [
        Case(
            f"joint_limit_{way}",
            partial(_stack, narrow, way),
            OUT + WAIT + BACK + 0.4,
            READY,
            robot=narrow,
            resolver=resolver,
        )
        for way, (_, resolver) in WAYS.items()
    ]


def _stack(robot: Robot, way: str, q: Array, t: float) -> Stack:
    """The elbow's limit by one of the ways, above the goal."""
    del t
    begin = robot.state(q).frame(TIP).p
    goal = FramePosition(TIP, begin, stiffness=STIFF, name="goal")
    below = goal >> Damping()
    stack: Hierarchy = TorqueLimits() >> below
    if way == "locking":
        stack = TorqueLimits() >> JointLocking(ZONE, joints=["joint3"]) >> below
    elif way != "baseline":
        stack = TorqueLimits() >> JointLimits(margin=0.02) >> below

    def script(t: float) -> None:
        there, back = rise(t, OUT), rise(t - OUT - WAIT, BACK)
        s, sd, sdd = (a - b for a, b in zip(there, back, strict=True))
        goal.set_target(begin + s * WAY, sd * WAY, sdd * WAY)

    return stack, script


def elbow(log: Log) -> Array:
    """Angle of the elbow (T,) [rad]."""
    return log.q[:, ELBOW]


def errors(log: Log) -> tuple[float, float]:
    """Distance of the tip from the goal [m]: when it waits there, and after return."""
    begin = log.p[TIP][0]
    i = np.searchsorted(log.t, log.t[0] + OUT + WAIT) - 1
    there = float(np.linalg.norm(log.p[TIP][i] - begin - WAY))
    return there, float(np.linalg.norm(log.p[TIP][-1] - begin))


def metrics(trials: dict[str, Trial], mismatch: bool) -> list[Metric]:
    """How far each way lets the elbow go, and what it costs at the goal."""
    del mismatch
    found = []
    for way in WAYS:
        log = trials[f"joint_limit_{way}"].log
        over = float(np.maximum(elbow(log) - LIMIT, 0.0).max())
        bound, sense = (0.05, ">") if way == "baseline" else (0.0, "==")
        there, back = errors(log)
        stuck = float(elbow(log)[-1] > LIMIT - ZONE)
        free = 0.0 if way in ("unilateral", "qp") else None
        name = f"joint_limit_{way}"
        found += [
            Metric(f"{name}_violation_rad", over, bound, sense),
            Metric(f"{name}_goal_error_m", there),
            Metric(f"{name}_return_error_m", back),
            Metric(f"{name}_locked_after_return", stuck, free, "=="),
        ]
    farthest = max(m.value for m in found if m.name.endswith("goal_error_m"))
    return [*found, Metric("joint_limit_goal_error_m", farthest)]


def figures(trials: dict[str, Trial]) -> list[tuple[str, str]]:
    """The elbow and the distance from the goal, all four ways."""
    logs = {title: trials[f"joint_limit_{way}"].log for way, (title, _) in WAYS.items()}
    t = min((log.t for log in logs.values()), key=len)
    degrees = {name: np.degrees(elbow(log))[: t.size] for name, log in logs.items()}
    bounds = {"limit": np.degrees(LIMIT), "zone": np.degrees(LIMIT - ZONE)}
    angles = time_series("Elbow", t, degrees, "angle [deg]", bounds=bounds)
    ways = {name: _from_target(log)[: t.size] * 1e6 for name, log in logs.items()}
    distances = time_series("Distance from the goal", t, ways, "distance [µm]")
    return [
        (
            "The goal asks for an elbow beyond its limit, waits, and comes back. Plain "
            "locking never lets go; the last two ways do, and they coincide.",
            angles,
        ),
        ("All four follow the goal: the wrist does what the elbow may not.", distances),
    ]


def _from_target(log: Log) -> Array:
    """Distance (T,) of the tip from where the moving goal is [m]."""
    begin = log.p[TIP][0]
    share = [rise(t, OUT)[0] - rise(t - OUT - WAIT, BACK)[0] for t in log.t]
    return np.linalg.norm(log.p[TIP] - begin - np.outer(share, WAY), axis=1)
