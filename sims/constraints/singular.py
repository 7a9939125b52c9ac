"""Goals at singularities, at the border of the workspace and beyond, and back again."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import final

import numpy as np
import pinocchio as pin

from sims.constraints.case import READY, Case, Stack, Trial, limits, rise
from sims.constraints.chatter import reversals
from sims.constraints.surface import TIP
from sims.log import Log
from sims.metrics import Metric
from sims.report.figures import time_series
from tasks import Damping, FramePose, FramePosition, SingularDamping
from wbc import Hierarchy, Robot, SaturatedPD, resolve
from wbc.arrays import Array

__all__ = ["SINGULAR", "cases", "figures", "metrics", "reported"]

STIFF = 2500.0
SPEED, ACCELERATION = 1.5, 5.0
"""Largest that the goal asks for [m/s, m/s^2; rad/s, rad/s^2]."""
REST = 40.0
"""Rate at which free joints come to rest [1/s]."""
WAIT, AFTER = 0.5, 1.5
"""Rest at the goal, and after the return [s]."""
SHOULDER = np.array([0.15, 0.0, 0.43])
REACH = 0.59 + np.hypot(0.13, 0.684) + 0.34
"""From joint 2 to the tip with elbow and wrist stretched [m]."""
SINGULAR = 0.05
"""Smallest singular value over the norm of J from where a posture is a singular one."""
NO_TURN = np.zeros(3)
SAMPLE = 20
"""Ticks between two looks at the singular values."""
SWING, WINDOW, REVERSALS = 0.02, 100, 2
"""At most two turning points of a joint's torque, 2 % of its limit apart, in 0.1 s: one
swing to and fro, as when the arm brakes. A bang-bang cycle has dozens."""


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


def _excursions(robot: Robot) -> dict[str, Excursion]:
    stretched = np.radians([0.0, 20.0, -60.0, 0.0, 40.0, 0.0])
    bent, flipped = (
        np.radians([0.0, 5.0, -110.0, *wrist])
        for wrist in ([-30.0, 25.0, 0.0], [85.0, -20.0, 0.0])
    )
    turned = np.radians([20.0, -40.0, -120.0, 0.0, 70.0, 0.0])
    F, G = (robot.state(q).frame(TIP) for q in (bent, flipped))
    wrist = robot.state(turned).frame("link5").p
    over = 1.15 * np.array([-wrist[0], 0.004 - wrist[1], 0.0])
    p = robot.state(READY).frame(TIP).p
    out = np.array([0.90, 0.20, 0.30])
    border = SHOULDER + REACH * out / np.linalg.norm(out) - p
    return {
        "elbow": Excursion(stretched, np.array([0.6, 0.0, 0.1]), 1.5, NO_TURN),
        "wrist": Excursion(bent, G.p - F.p, 1.5, pin.log3(G.R @ F.R.T)),
        "shoulder": Excursion(turned, over, 1.5, NO_TURN),
        "border": Excursion(READY, border, 2.5),
        "beyond": Excursion(READY, border + 0.3 * out / np.linalg.norm(out), 2.5),
    }


def cases(robot: Robot) -> list[Case]:
    """One run for each excursion."""
    return [
        Case(
            f"singular_{name}",
            partial(_stack, robot, trip),
            2.0 * trip.time + WAIT + AFTER,
            trip.start,
        )
        for name, trip in _excursions(robot).items()
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


def weakness(trial: Trial) -> tuple[Array, Array]:
    """Smallest singular value of the goal, relative to its norm, at some times.

    Returns:
        Indices of the ticks (K,), and the values (K,).
    """
    log, rows = trial.log, len(_goal(trial).rows)
    ticks = np.arange(0, log.t.size, SAMPLE)
    J = [log.robot.state(log.q[k]).frame(TIP).J[:rows] for k in ticks]
    s = np.linalg.svd(np.array(J), compute_uv=False)
    return ticks, s[:, -1] / np.linalg.norm(s, axis=1)


def reported(trial: Trial) -> bool:
    """Whether the tick nearest to the singularity says what is lost, and to whom.

    The analysis finds a direction less than the goal has rows; the explanation says
    that the goal is not met, how much is missing, and that a singular direction is why.
    """
    log, (hierarchy, script) = trial.log, trial.stack
    ticks, values = weakness(trial)
    k = int(ticks[np.argmin(values)])
    if script is not None:
        script(float(log.t[k]))
    state = log.robot.state(log.q[k], log.v[k], float(log.t[k]))
    goal = Hierarchy.of(_goal(trial))
    level = goal.analyse(state, metric="joint", tolerance=SINGULAR).level("goal")
    task = resolve(state, hierarchy, trial.resolver).explain().task("goal")
    blamed = any(blocker.task == "singular damping" for blocker in task.blockers)
    return level.rank < level.rows and not task.met and blamed


def metrics(trials: dict[str, Trial], mismatch: bool) -> list[Metric]:
    """Bounded and smooth all the way, and back where it began."""
    del mismatch
    mine = {name: trial for name, trial in trials.items() if _mine(name)}
    logs = [trial.log for trial in mine.values()]
    values = {
        "singular_joint_speed_max_fraction": (max(map(_speed, logs)), 1.0),
        "singular_torque_max_fraction": (max(map(_torque, logs)), 1.0),
        "singular_torque_reversals": (max(map(_chatter, logs)), REVERSALS),
        "singular_recovery_error_m": (max(_back(log)[0] for log in logs), 1e-3),
        "singular_recovery_error_rad": (_turned_back(mine), 5e-3),
        "singular_value_reached": (
            max(float(weakness(t)[1].min()) for t in mine.values()),
            SINGULAR,
        ),
        "singular_unreported": (sum(not reported(t) for t in mine.values()), 0.0),
    }
    return [Metric(k, float(value), bound) for k, (value, bound) in values.items()]


def _goal(trial: Trial) -> FramePose | FramePosition:
    task = next(t for t in trial.stack[0].tasks() if t.name == "goal")
    assert isinstance(task, FramePose | FramePosition)
    return task


def _speed(log: Log) -> float:
    return float((np.abs(log.v) / log.robot.v_max).max())


def _torque(log: Log) -> float:
    return float((np.abs(log.torque) / log.robot.tau_max).max())


def _chatter(log: Log) -> int:
    load = log.torque / log.robot.tau_max
    return max(reversals(x, SWING, WINDOW) for x in load.T)


def _back(log: Log) -> tuple[float, float]:
    """Distance [m] and angle [rad] between the tip's last pose and its first one."""
    p, R = log.p[TIP], log.R[TIP]
    angle = np.linalg.norm(pin.log3(R[-1] @ R[0].T))
    return float(np.linalg.norm(p[-1] - p[0])), float(angle)


def _turned_back(trials: dict[str, Trial]) -> float:
    poses = [t.log for t in trials.values() if isinstance(_goal(t), FramePose)]
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
        errors[name] = np.append(
            log.errors["goal"], np.full(t.size - log.t.size, np.nan)
        )
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
