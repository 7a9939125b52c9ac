"""Which joint and which frame of one engine is which of the other's, by name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import mujoco
import numpy as np
import pinocchio as pin

from sims.audit.names import joint_names
from wbc.arrays import Array, BoolArray, IntArray

__all__ = [
    "COMPOSITE",
    "Frame",
    "Pair",
    "Slot",
    "pair",
    "unbounded",
]

UNBOUNDED = 1e30
COMPOSITE = "Composite_"
HINGE, SLIDE = int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)
SPREAD = {HINGE: np.pi, SLIDE: 1.0}  # of a joint without limits [rad, m]


class Slot(NamedTuple):
    """A one-degree joint's place in Pinocchio's vectors; nq is 2 for (cos, sin)."""

    joint: int
    q: int
    nq: int
    v: int


class Frame(NamedTuple):
    """A body or site that both engines know."""

    name: str
    site: bool
    pin: int
    mujoco: int


@dataclass(frozen=True, slots=True, eq=False)
class Pair:
    """Two models and the map between them.

    Attributes:
        model: Pinocchio's.
        engine: MuJoCo's.
        names: (n,) hinges and slides that both have, in MuJoCo's order.
        slots: (n,) their places in Pinocchio's vectors.
        ids: (n,) their indices in MuJoCo.
        pin_v: (n,) their velocity indices in Pinocchio.
        mj_q: (n,) their position indices in MuJoCo.
        mj_v: (n,) their velocity indices in MuJoCo.
        only_pin: joints, or kinds of joint, that MuJoCo lacks.
        only_mujoco: joints that Pinocchio lacks.
        frames: bodies and sites that both have.
        lost: names of bodies and sites that Pinocchio lacks.
    """

    model: pin.Model
    engine: mujoco.MjModel
    names: tuple[str, ...]
    slots: tuple[Slot, ...]
    ids: IntArray
    pin_v: IntArray
    mj_q: IntArray
    mj_v: IntArray
    only_pin: tuple[str, ...]
    only_mujoco: tuple[str, ...]
    frames: tuple[Frame, ...]
    lost: tuple[str, ...]

    def limits(self, source: str) -> tuple[Array, Array]:
        """Position limits (n,), lower and upper [rad or m]; infinite where none."""
        if source == "mujoco":
            limited = self.engine.jnt_limited[self.ids].astype(bool)
            box = self.engine.jnt_range[self.ids].T
            return np.where(limited, box[0], -np.inf), np.where(limited, box[1], np.inf)
        lower, upper = self.model.lowerPositionLimit, self.model.upperPositionLimit
        low = [lower[s.q] if s.nq == 1 else -np.inf for s in self.slots]
        high = [upper[s.q] if s.nq == 1 else np.inf for s in self.slots]
        return unbounded(low), unbounded(high)

    def chosen(self, where: BoolArray) -> list[str]:
        """Names of the joints at which `where` (n,) is true."""
        return [name for name, it in zip(self.names, where, strict=True) if it]

    def states(self, count: int, seed: int) -> tuple[Array, Array]:
        """Positions and velocities (count, n) within MuJoCo's limits, seeded."""
        rng = np.random.default_rng(seed)
        lower, upper = self.limits("mujoco")
        spread = np.array([SPREAD[int(self.engine.jnt_type[i])] for i in self.ids])
        lower = np.where(np.isfinite(lower), lower, -spread)
        upper = np.where(np.isfinite(upper), upper, spread)
        shape = (count, len(self.names))
        return rng.uniform(lower, upper, shape), rng.uniform(-2.0, 2.0, shape)


def unbounded(values: Sequence[float] | Array) -> Array:
    """The values with whatever an engine uses for "no limit" made infinite."""
    limit = np.array(values, dtype=np.float64)
    return np.where(np.abs(limit) > UNBOUNDED, np.copysign(np.inf, limit), limit)


def pair(model: pin.Model, engine: mujoco.MjModel) -> Pair:
    """Match joints and frames by name."""
    labels = joint_names(engine)
    slots = _slots(model, engine, labels)
    ids = [i for i, s in enumerate(labels) if s in slots]
    ids = [
        i for i in ids if int(engine.jnt_type[i]) in SPREAD and slots[labels[i]].nq < 3
    ]
    frames, lost = _frames(model, engine)
    names = tuple(labels[i] for i in ids)
    return Pair(
        model,
        engine,
        names,
        tuple(slots[name] for name in names),
        np.array(ids, dtype=np.int_),
        np.array([slots[name].v for name in names], dtype=np.int_),
        np.array(engine.jnt_qposadr[ids], dtype=np.int_),
        np.array(engine.jnt_dofadr[ids], dtype=np.int_),
        tuple(name for name in slots if name not in labels),
        tuple(name for name in labels if name not in slots),
        frames,
        lost,
    )


def _slots(
    model: pin.Model, engine: mujoco.MjModel, labels: list[str]
) -> dict[str, Slot]:
    """Pinocchio's joints by name; several joints of one body are one there."""
    slots = {}
    for i in range(1, model.njoints):
        joint, name = model.joints[i], model.names[i]
        inner = name.removeprefix(COMPOSITE)
        if name.startswith(COMPOSITE) and inner in labels:
            body = engine.jnt_bodyid[labels.index(inner)]
            group = [s for k, s in enumerate(labels) if engine.jnt_bodyid[k] == body]
            for k, member in enumerate(group[: joint.nv]):
                slots[member] = Slot(i, joint.idx_q + k, 1, joint.idx_v + k)
        else:
            slots[name] = Slot(i, joint.idx_q, joint.nq, joint.idx_v)
    return slots


def _frames(
    model: pin.Model, engine: mujoco.MjModel
) -> tuple[tuple[Frame, ...], tuple[str, ...]]:
    found, lost = [], []
    sites = [(engine.site(i).name, True, i) for i in range(engine.nsite)]
    bodies = [(engine.body(i).name, False, i) for i in range(1, engine.nbody)]
    for name, site, index in bodies + sites:
        if not name:
            continue
        kind = pin.FrameType.OP_FRAME if site else pin.FrameType.BODY
        if model.existFrame(name, kind):
            found.append(Frame(name, site, model.getFrameId(name, kind), index))
        elif not (site and engine.site_bodyid[index] == 0):
            lost.append(f"site '{name}'" if site else f"body '{name}'")
    return tuple(found), tuple(lost)
