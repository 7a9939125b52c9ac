"""Position, velocity and torque limits of both engines side by side."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import mujoco
import numpy as np

from sims.audit.actuators import effort_limits, torque_findings, torque_limits
from sims.audit.load import Engines
from sims.audit.pair import Pair, unbounded
from sims.audit.result import Check, Finding, named, value
from wbc.arrays import Array, BoolArray

__all__ = ["limit_check", "limits", "limits_checks"]

RELATIVE = 1e-9  # of a limit, at least of 1
RANGES = 3  # joints whose ranges a finding spells out


def limit_check(name: str, pair: Pair, mine: Array, theirs: Array, unit: str) -> Check:
    """Compare bounds (n,) or (2, n); equal infinities are equal.

    Args:
        name: of the check.
        pair: whose joints they belong to.
        mine: Pinocchio's.
        theirs: MuJoCo's.
        unit: of the bounds.
    """
    difference = _difference(mine, theirs)
    if not difference.size:
        return Check(name, 0.0, RELATIVE, unit)
    worst = np.unravel_index(int(np.argmax(difference)), difference.shape)
    check = Check(name, float(difference[worst]), float(_allowed(mine)[worst]), unit)
    if check.ok:
        return check
    side = f", {('lower', 'upper')[worst[0]]}" if len(worst) == 2 else ""
    where = f"{pair.names[worst[-1]]}{side}"
    return replace(
        check, where=where, pin=float(mine[worst]), mujoco=float(theirs[worst])
    )


def _difference(mine: Array, theirs: Array) -> Array:
    same = mine == theirs  # infinities too, whose difference would be NaN
    return np.where(same, 0.0, np.abs(np.where(same, 0.0, mine) - theirs))


def _allowed(mine: Array) -> Array:
    return RELATIVE * np.maximum(1.0, np.abs(np.where(np.isfinite(mine), mine, 0.0)))


def limits_checks(pair: Pair) -> list[Check]:
    """Position limits, and torque limits where Pinocchio has any."""
    mine, theirs = (np.array(pair.limits(s)) for s in ("pin", "mujoco"))
    effort, torque = effort_limits(pair), torque_limits(pair)
    read = np.where(np.isinf(effort), torque, effort)
    return [
        limit_check("position limits", pair, mine, theirs, "rad or m"),
        limit_check("torque limits", pair, read, torque, "Nm or N"),
    ]


def limits(engines: Engines, pair: Pair) -> Iterator[Finding]:
    """Limits that differ, that one engine does not read, or that nobody has."""
    yield from _positions(pair)
    effort, torque = effort_limits(pair), torque_limits(pair)
    differ = (_difference(effort, torque) > _allowed(effort)) & np.isfinite(effort)
    yield from torque_findings(pair, differ)
    speed = unbounded(np.array(pair.model.upperVelocityLimit)[pair.pin_v])
    known = np.isfinite(speed)
    if engines.kind == "URDF" and known.any():
        yield Finding(
            "velocity limits",
            named("joint", pair.chosen(known)),
            f"up to {speed[known].max():.6g} rad/s or m/s",
            "has no velocity limits and simulates beyond them",
            "Let the controller hold them.",
            "note",
        )


def _positions(pair: Pair) -> Iterator[Finding]:
    mine, theirs = (np.array(pair.limits(s)) for s in ("pin", "mujoco"))
    differ = (_difference(mine, theirs) > _allowed(mine)).any(axis=0)
    by_cause: dict[str, list[int]] = {}
    for i in np.flatnonzero(differ):
        by_cause.setdefault(_position_advice(pair, int(i), mine), []).append(int(i))
    for advice, joints in by_cause.items():
        yield Finding(
            "position limits",
            named("joint", [pair.names[i] for i in joints]),
            _ranges(mine, joints),
            _ranges(theirs, joints),
            advice,
            "error",
        )
    absent = np.isinf([mine, theirs]).any(axis=(0, 1)) & ~differ
    if absent.any():
        yield _no_positions(pair, np.array(absent))


def _no_positions(pair: Pair, absent: BoolArray) -> Finding:
    return Finding(
        "no position limits",
        named("joint", pair.chosen(absent)),
        "no limit",
        "no limit",
        "Write range, or pass position_limit to Robot.",
        "note",
    )


def _position_advice(pair: Pair, joint: int, mine: Array) -> str:
    engine, index = pair.engine, pair.ids[joint]
    reference = float(engine.qpos0[pair.mj_q[joint]])
    slide = engine.jnt_type[index] == mujoco.mjtJoint.mjJNT_SLIDE
    if not engine.jnt_limited[index]:
        return (
            'Pinocchio does not heed limited="false": remove the range. '
            "Robot.from_mjcf mends this."
        )
    if reference:
        return (
            f"Pinocchio shifts the range by ref ({reference:.6g}), although q means "
            "the same in both engines: remove ref. Robot.from_mjcf mends this."
        )
    if slide and np.allclose(mine[:, joint], np.radians(engine.jnt_range[index])):
        return (
            "Pinocchio takes a slide's metres for degrees and converts them: write "
            '<compiler angle="radian"/>. Robot.from_mjcf mends this.'
        )
    return "Pass position_limit to Robot, or write range on the joint itself."


def _ranges(box: Array, joints: list[int]) -> str:
    shown = [_range(float(box[0, i]), float(box[1, i])) for i in joints[:RANGES]]
    return ", ".join(shown) + (", ..." if len(joints) > RANGES else "")


def _range(lower: float, upper: float) -> str:
    if np.isinf(lower) and np.isinf(upper):
        return "no limit"
    return f"{value(lower)} to {value(upper)}"
