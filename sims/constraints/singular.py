"""Goals at singularities, at the border of the workspace and beyond, and back again."""

from __future__ import annotations

from functools import partial

import numpy as np
import pinocchio as pin

from sims.constraints.case import Case, Stack, Trial, limits, rise
from sims.constraints.chatter import reversals, travel
from sims.constraints.excursion import Excursion, excursions
from sims.constraints.surface import TIP
from sims.constraints.weakness import SINGULAR, goal_of, reported, weakness
from sims.log import Log
from sims.metrics import Metric
from sims.report.figures import time_series
from tasks import Damping, FramePose, FramePosition, SingularDamping
from wbc import Robot, SaturatedPD
from wbc.arrays import Array

__all__ = ["cases", "figures", "metrics"]

STIFF = 2500.0
SPEED, ACCELERATION = 1.5, 5.0
"""Largest that the goal asks for [m/s, m/s^2; rad/s, rad/s^2]."""
REST = 40.0
"""Rate at which free joints come to rest [1/s]."""
WAIT, AFTER = 0.5, 2.0
"""Rest at the goal, and after the return [s]."""
WINDOW = 100
"""Ticks in which chatter is looked for: 0.1 s."""
TRAVEL = 1.0
"""Of a torque in that time, up and down, over its limit: one full swing at most."""
SWING, REVERSALS = 0.02, 4
"""Turning points in that time of swings beyond 2 % of the limit: 20 Hz at most, where
switching from tick to tick would give a hundred."""


def cases(robot: Robot) -> list[Case]:
    """One run for each excursion."""
    return [
        Case(
            f"singular_{name}",
            partial(_stack, robot, trip),
            2.0 * trip.time + WAIT + AFTER,
            trip.start,
        )
        for name, trip in excursions(robot).items()
    ]


def _stack(robot: Robot, trip: Excursion, q: Array, begin: float) -> Stack:
    """The goal with its singularities damped, below the limits."""
    F, turn = robot.state(q).frame(TIP), trip.turn
    goal: FramePose | FramePosition
    if turn is None:
        goal = FramePosition(TIP, F.p, name="goal")
    else:
        goal = FramePose(TIP, F.p, F.R, name="goal")
    goal.law = SaturatedPD(STIFF, SPEED, ACCELERATION)

    def script(t: float) -> None:
        out = rise(t - begin, trip.time)
        back = rise(t - begin - trip.time - WAIT, trip.time)
        s, sd, sdd = (a - b for a, b in zip(out, back, strict=True))
        p, way = F.p + s * trip.way, trip.way
        if isinstance(goal, FramePosition):
            goal.set_target(p, sd * way, sdd * way)
        else:
            R, twist = pin.exp3(s * turn) @ F.R, np.concatenate([way, turn])
            goal.set_target(p, R, sd * twist, sdd * twist)

    level = goal + SingularDamping(goal)
    return limits() >> level >> Damping(REST), script


def metrics(trials: dict[str, Trial], mismatch: bool) -> list[Metric]:
    """Bounded and smooth all the way, and back where it began."""
    del mismatch
    mine = {name: trial for name, trial in trials.items() if _mine(name)}
    logs = [trial.log for trial in mine.values()]
    values = {
        "singular_joint_speed_max_fraction": (max(map(_speed, logs)), 1.0),
        "singular_torque_max_fraction": (max(map(_torque, logs)), 1.0),
        "singular_torque_travel_fraction": (max(map(_travel, logs)), TRAVEL),
        "singular_torque_reversals": (max(map(_reversals, logs)), REVERSALS),
        "singular_recovery_error_m": (max(_back(log)[0] for log in logs), 1e-3),
        "singular_recovery_error_rad": (_turned_back(mine), 5e-3),
        "singular_value_reached": (
            max(float(weakness(t)[1].min()) for t in mine.values()),
            SINGULAR,
        ),
        "singular_unreported": (sum(not reported(t) for t in mine.values()), 0.0),
    }
    return [Metric(k, float(value), bound) for k, (value, bound) in values.items()]


def _speed(log: Log) -> float:
    return float((np.abs(log.v) / log.robot.v_max).max())


def _torque(log: Log) -> float:
    return float((np.abs(log.torque) / log.robot.tau_max).max())


def _travel(log: Log) -> float:
    return max(travel(x, WINDOW) for x in (log.torque / log.robot.tau_max).T)


def _reversals(log: Log) -> int:
    load = log.torque / log.robot.tau_max
    return max(reversals(x, SWING, WINDOW) for x in load.T)


def _back(log: Log) -> tuple[float, float]:
    """Distance [m] and angle [rad] between the tip's last pose and its first one."""
    p, R = log.p[TIP], log.R[TIP]
    angle = np.linalg.norm(pin.log3(R[-1] @ R[0].T))
    return float(np.linalg.norm(p[-1] - p[0])), float(angle)


def _turned_back(trials: dict[str, Trial]) -> float:
    poses = [t.log for t in trials.values() if isinstance(goal_of(t), FramePose)]
    return max(_back(log)[1] for log in poses)


def figures(trials: dict[str, Trial]) -> list[tuple[str, str]]:
    """How singular each run gets, how far the goal is, and the torque beyond reach."""
    logs = {k.removeprefix("singular_"): trials[k].log for k in trials if _mine(k)}
    last = max(logs.values(), key=lambda log: log.t.size)
    t = last.t - last.t[0]
    values, errors = {}, {}
    for name, log in logs.items():
        ticks, values_at = weakness(trials[f"singular_{name}"])
        values[name] = np.interp(t, t[ticks], values_at, right=np.nan)
        missing = np.full(t.size - log.t.size, np.nan)
        errors[name] = np.append(log.errors["goal"], missing)
    load = {
        joint: last.torque[:, i] / last.robot.tau_max[i]
        for i, joint in enumerate(last.robot.joint_names)
    }
    singular = time_series(
        "Smallest singular value over the norm of J",
        t,
        values,
        "relative [-]",
        bounds={"singular": SINGULAR},
    )
    return [
        ("Every goal leads into a singularity and out of it.", singular),
        (
            "What cannot be reached is missed, and met again on return.",
            time_series("Error of the goal", t, errors, "error [m, rad]"),
        ),
        (
            "The goal waits 0.3 m beyond reach: the torques stay calm.",
            time_series("Torques over their limits: beyond", t, load, "share [-]"),
        ),
    ]


def _mine(name: str) -> bool:
    return name.startswith("singular_")
