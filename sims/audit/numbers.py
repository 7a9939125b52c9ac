"""The numbers that each engine computes for the same seeded states."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

import mujoco
import numpy as np
import pinocchio as pin

from sims.audit.pair import Frame, Pair
from wbc.arrays import Array

__all__ = [
    "PASSIVE",
    "QUANTITIES",
    "Numbers",
    "Quantity",
    "effective_gravity",
    "mujoco_numbers",
    "pin_numbers",
    "rest_positions",
]

ALIGNED = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
FRAME_KEYS = ("p", "R", "J", "drift")
PASSIVE = ("spring", "gravcomp", "fluid")

Numbers = Mapping[str, Array]


class Quantity(NamedTuple):
    """Name, unit and the kinds of its axes after the first, which is the state."""

    name: str
    unit: str
    axes: tuple[str, ...]


QUANTITIES: Final[dict[str, Quantity]] = {
    "gravity": Quantity("gravity vector", "m/s^2", ("xyz",)),
    "total": Quantity("moving mass, in all", "kg", ("all",)),
    "mass": Quantity("mass moved by each joint alone", "kg", ("joint",)),
    "armature": Quantity("armature", "kg m^2", ("joint",)),
    "M": Quantity("M, joint-space inertia", "kg m^2", ("joint", "joint")),
    "h": Quantity("h, Coriolis + gravity torque", "Nm", ("joint",)),
    "p": Quantity("frame positions", "m", ("frame", "xyz")),
    "R": Quantity("frame orientations", "-", ("frame", "xyz", "xyz")),
    "J": Quantity("J, frame Jacobians", "m/rad, -", ("frame", "twist", "joint")),
    "drift": Quantity("Jdot v, frame drift", "m/s^2", ("frame", "twist")),
}


def pin_numbers(pair: Pair, model: pin.Model, q: Array, v: Array) -> Numbers:
    """Pinocchio's numbers at (q, v), both (states, n), of `model` for `pair.model`."""
    data, rest = model.createData(), rest_positions(pair, model)
    columns = np.ix_(pair.pin_v, pair.pin_v)
    rows: dict[str, list[Array]] = {key: [] for key in ("M", "h", *FRAME_KEYS)}
    for qi, vi in zip(q, v, strict=True):
        full, rate = _pin_state(pair, rest, qi, vi)
        upper = np.triu(pin.crba(model, data, full))
        h = np.array(pin.nonLinearEffects(model, data, full, rate))
        pin.forwardKinematics(model, data, full, rate, np.zeros(model.nv))
        pin.computeJointJacobians(model, data, full)
        pin.updateFramePlacements(model, data)
        rows["M"].append((upper + np.triu(upper, 1).T)[columns])
        rows["h"].append(h[pair.pin_v])
        _append_frames(
            rows, pair, [_pin_frame(pair, model, data, f) for f in pair.frames]
        )
    return {k: np.array(x) for k, x in rows.items()} | _pin_constants(pair, model)


def _pin_frame(
    pair: Pair, model: pin.Model, data: pin.Data, frame: Frame
) -> tuple[Array, ...]:
    X = data.oMf[frame.pin]
    J = pin.getFrameJacobian(model, data, frame.pin, ALIGNED)
    J = J.reshape(6, model.nv)[:, pair.pin_v]  # the binding flattens one column
    drift = pin.getFrameClassicalAcceleration(model, data, frame.pin, ALIGNED)
    return np.array(X.translation), np.array(X.rotation), J, drift.vector


def _append_frames(
    rows: dict[str, list[Array]], pair: Pair, frames: list[tuple[Array, ...]]
) -> None:
    """Stack pose, Jacobian and drift of all frames; there may be none."""
    count, n = len(frames), len(pair.names)
    shapes = ((count, 3), (count, 3, 3), (count, 6, n), (count, 6))
    for i, (key, shape) in enumerate(zip(FRAME_KEYS, shapes, strict=True)):
        rows[key].append(np.array([f[i] for f in frames]).reshape(shape))


def _pin_constants(pair: Pair, model: pin.Model) -> dict[str, Array]:
    masses = np.array([inertia.mass for inertia in model.inertias])
    return {
        "gravity": np.array([model.gravity.linear]),
        "total": np.array([[masses[1:].sum()]]),
        "mass": masses[[slot.joint for slot in pair.slots]][None],
        "armature": np.array(model.armature)[pair.pin_v][None],
    }


def _pin_state(pair: Pair, rest: Array, q: Array, v: Array) -> tuple[Array, Array]:
    full, rate = rest.copy(), np.zeros(pair.model.nv)
    for slot, angle in zip(pair.slots, q, strict=True):
        wanted = [angle] if slot.nq == 1 else [np.cos(angle), np.sin(angle)]
        full[slot.q : slot.q + slot.nq] = wanted
    rate[pair.pin_v] = v
    return full, rate


def rest_positions(pair: Pair, model: pin.Model) -> Array:
    """Pinocchio's q (nq,) with free bodies where MuJoCo's qpos0 has them."""
    q, engine = np.array(pin.neutral(model)), pair.engine
    free = np.flatnonzero(engine.jnt_type == mujoco.mjtJoint.mjJNT_FREE)
    joints = [
        i for i in range(1, model.njoints) if "FreeFlyer" in model.joints[i].shortname()
    ]
    for mine, theirs in zip(joints, free, strict=False):
        at = engine.jnt_qposadr[theirs]
        x, y, z, qw, qx, qy, qz = engine.qpos0[at : at + 7]
        X = pin.XYZQUATToSE3(np.array([x, y, z, qx, qy, qz, qw]))
        start = model.joints[mine].idx_q
        q[start : start + 7] = pin.SE3ToXYZQUAT(model.jointPlacements[mine].actInv(X))
    return q


def mujoco_numbers(pair: Pair, q: Array, v: Array) -> Numbers:
    """MuJoCo's numbers at (q, v), both (states, n), and its passive torques.

    The passive torques (states, nv) are of MuJoCo's own degrees of freedom: `spring`,
    `gravcomp` and `fluid`, the first two at the state's position.
    """
    engine = pair.engine
    data, M = mujoco.MjData(engine), np.zeros((engine.nv, engine.nv))
    block = np.ix_(pair.mj_v, pair.mj_v)
    rows: dict[str, list[Array]] = {k: [] for k in ("M", "h", *FRAME_KEYS, *PASSIVE)}
    for qi, vi in zip(q, v, strict=True):
        data.qpos[pair.mj_q], data.qvel[pair.mj_v] = qi, vi
        _forward(engine, data)
        mujoco.mj_fullM(engine, data, M)
        rows["M"].append(M[block])
        rows["h"].append(data.qfrc_bias[pair.mj_v])
        _append_frames(rows, pair, [_mujoco_frame(pair, data, f) for f in pair.frames])
        for key in PASSIVE:
            rows[key].append(np.array(getattr(data, f"qfrc_{key}")))
    return {k: np.array(x) for k, x in rows.items()} | _mujoco_constants(pair)


def _forward(engine: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Everything but collisions and constraints."""
    mujoco.mj_kinematics(engine, data)
    mujoco.mj_comPos(engine, data)
    mujoco.mj_tendon(engine, data)
    mujoco.mj_makeM(engine, data)
    mujoco.mj_transmission(engine, data)
    mujoco.mj_fwdVelocity(engine, data)


def _mujoco_frame(pair: Pair, data: mujoco.MjData, frame: Frame) -> tuple[Array, ...]:
    engine = pair.engine
    J, J_dot = np.zeros((6, engine.nv)), np.zeros((6, engine.nv))
    view = data.site(frame.mujoco) if frame.site else data.body(frame.mujoco)
    body = engine.site_bodyid[frame.mujoco] if frame.site else frame.mujoco
    p = np.array(view.xpos)
    mujoco.mj_jac(engine, data, J[:3], J[3:], p, body)
    mujoco.mj_jacDot(engine, data, J_dot[:3], J_dot[3:], p, body)
    R = np.array(view.xmat).reshape(3, 3)
    return p, R, J[:, pair.mj_v], J_dot @ data.qvel


def _mujoco_constants(pair: Pair) -> dict[str, Array]:
    engine = pair.engine
    weld, mass = engine.body_weldid, engine.body_mass
    bodies = engine.jnt_bodyid[pair.ids]
    moved = np.array([mass[weld == weld[b]].sum() for b in bodies])
    return {
        "gravity": effective_gravity(engine)[None],
        "total": np.array([[mass[weld != 0].sum()]]),
        "mass": moved[None],
        "armature": engine.dof_armature[pair.mj_v][None],
    }


def effective_gravity(engine: mujoco.MjModel) -> Array:
    """Gravity (3,) [m/s^2] that MuJoCo applies: none if the flag disables it."""
    off = engine.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_GRAVITY
    return np.zeros(3) if off else np.array(engine.opt.gravity)
