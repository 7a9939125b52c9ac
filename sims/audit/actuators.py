"""Torque limits of both engines, and what MuJoCo's actuators do with a control."""

from __future__ import annotations

from collections.abc import Iterator

import mujoco
import numpy as np

from sims.audit.pair import Pair, unbounded
from sims.audit.result import Finding, listed, named, value
from wbc.arrays import Array, BoolArray

__all__ = ["actuators", "effort_limits", "torque_findings", "torque_limits"]

ON_JOINT = [int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT)]


def effort_limits(pair: Pair) -> Array:
    """Pinocchio's torque limits (n,), infinite where it has none [Nm or N]."""
    return unbounded(np.array(pair.model.upperEffortLimit)[pair.pin_v])


def torque_limits(pair: Pair) -> Array:
    """Largest torque (n,) that MuJoCo's actuators can apply either way [Nm or N]."""
    return np.array([_joint_limit(pair.engine, int(joint)) for joint in pair.ids])


def _joint_limit(engine: mujoco.MjModel, joint: int) -> float:
    """The smaller side of the sum of the actuators' ranges; motors may oppose."""
    ranges = [_actuator_range(engine, a) for a in _drivers(engine, joint)]
    total = np.sum(ranges, axis=0) if ranges else np.array([-np.inf, np.inf])
    if engine.jnt_actfrclimited[joint]:
        lower, upper = engine.jnt_actfrcrange[joint]
        total = np.array([max(total[0], lower), min(total[1], upper)])
    return max(0.0, float(min(-total[0], total[1])))


def torque_findings(pair: Pair, differ: BoolArray) -> Iterator[Finding]:
    """Torque limits that differ (n,), that Pinocchio does not read, that are absent."""
    effort, torque = effort_limits(pair), torque_limits(pair)
    if differ.any():
        yield Finding(
            "torque limits",
            named("joint", pair.chosen(differ)),
            f"{_values(effort[differ])} Nm",
            f"{_values(torque[differ])} Nm",
            "MuJoCo clips at the tightest of ctrlrange, forcerange and "
            "actuatorfrcrange, Pinocchio reads the last alone: state the same in all.",
            "error",
        )
    unread = np.isinf(effort) & np.isfinite(torque)
    if unread.any():
        yield Finding(
            "torque limits not read",
            named("joint", pair.chosen(unread)),
            "no limit: it reads no actuators",
            f"{_values(torque[unread])} Nm",
            "Robot.from_mjcf reads them; with Pinocchio alone set them yourself.",
            "note",
        )
    absent = np.isinf(effort) & np.isinf(torque)
    if absent.any():
        yield Finding(
            "no torque limits",
            named("joint", pair.chosen(absent)),
            "no limit",
            "no limit",
            "Give the motors ctrlrange, or pass torque_limit to Robot.",
            "note",
        )


def actuators(pair: Pair) -> Iterator[Finding]:
    """Actuators whose control is not simply a joint torque."""
    engine = pair.engine
    odd = [a for a in range(engine.nu) if not _plain(engine, a)]
    if odd:
        yield Finding(
            "actuators other than motors",
            listed([engine.actuator(a).name or f"(actuator {a})" for a in odd]),
            "reads no actuators",
            "ctrl is not the joint torque (servo, gear, gain, tendon or dynamics)",
            "Torque control needs <motor joint=... gear=1> on every joint.",
            "note",
        )
    idle = np.array([not _drivers(engine, int(i)) for i in pair.ids], dtype=np.bool_)
    if engine.nu and idle.any():
        yield Finding(
            "joints without actuator",
            named("joint", pair.chosen(idle)),
            "reads no actuators",
            "nothing drives them",
            "Add a motor, or expect them to hang.",
            "note",
        )


def _drivers(engine: mujoco.MjModel, joint: int) -> list[int]:
    return [
        a
        for a in range(engine.nu)
        if int(engine.actuator_trntype[a]) in ON_JOINT
        and engine.actuator_trnid[a, 0] == joint
    ]


def _actuator_range(engine: mujoco.MjModel, actuator: int) -> Array:
    """Least and largest torque (2,) at the joint [Nm or N]."""
    bounds = np.array([-np.inf, np.inf])
    if engine.actuator_forcelimited[actuator]:
        bounds = np.array(engine.actuator_forcerange[actuator])
    if engine.actuator_ctrllimited[actuator] and _is_motor(engine, actuator):
        gain = engine.actuator_gainprm[actuator, 0]
        lower, upper = np.sort(engine.actuator_ctrlrange[actuator] * gain)
        bounds = np.array([max(bounds[0], lower), min(bounds[1], upper)])
    gear = float(engine.actuator_gear[actuator, 0])
    return np.sort(bounds * gear) if gear else np.zeros(2)


def _is_motor(engine: mujoco.MjModel, actuator: int) -> bool:
    return bool(
        engine.actuator_dyntype[actuator] == mujoco.mjtDyn.mjDYN_NONE
        and engine.actuator_gaintype[actuator] == mujoco.mjtGain.mjGAIN_FIXED
        and engine.actuator_biastype[actuator] == mujoco.mjtBias.mjBIAS_NONE
    )


def _plain(engine: mujoco.MjModel, actuator: int) -> bool:
    joint = engine.actuator_trntype[actuator] == mujoco.mjtTrn.mjTRN_JOINT
    gain = engine.actuator_gear[actuator, 0] * engine.actuator_gainprm[actuator, 0]
    return bool(joint and gain == 1 and _is_motor(engine, actuator))


def _values(limits: Array) -> str:
    return ", ".join(value(float(x)) for x in limits)
