"""Why two engines differ: mend one trait of Pinocchio's model at a time and look."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from typing import Final

import mujoco
import numpy as np
import pinocchio as pin

from sims.audit.numbers import (
    QUANTITIES,
    Numbers,
    Quantity,
    effective_gravity,
    pin_numbers,
)
from sims.audit.pair import Pair
from sims.audit.result import Check
from wbc.arrays import Array

__all__ = ["ARMATURE", "GRAVITY", "INERTIA", "ROOT_POSE", "checks", "compare", "root"]

RELATIVE = 1e-9  # of the largest entry, at least of 1
ROOT_POSE: Final = "root pose ignored"
GRAVITY: Final = "gravity"
ARMATURE: Final = "armature"
INERTIA: Final = "inertia"
AXES: Final[dict[str, tuple[str, ...]]] = {
    "xyz": ("x", "y", "z"),
    "twist": ("vx", "vy", "vz", "wx", "wy", "wz"),
    "all": ("all bodies",),
}


def compare(key: str, pair: Pair, mine: Numbers, theirs: Numbers) -> Check:
    """The worst difference of one quantity, and the entry where it is."""
    quantity, a, b = QUANTITIES[key], mine[key], theirs[key]
    tolerance = RELATIVE * max(1.0, float(np.abs(b).max(initial=0.0)))
    if not a.size:
        return Check(quantity.name, 0.0, tolerance, quantity.unit)
    difference = np.abs(a - b)
    worst = np.unravel_index(int(np.argmax(difference)), a.shape)
    value = float(difference[worst])
    check = Check(quantity.name, value, tolerance, quantity.unit)
    if check.ok:
        return check
    where = _entry(pair, quantity, tuple(int(i) for i in worst[1:]))
    return replace(check, where=where, pin=float(a[worst]), mujoco=float(b[worst]))


def _entry(pair: Pair, quantity: Quantity, index: tuple[int, ...]) -> str:
    axes = AXES | {"joint": pair.names, "frame": tuple(f.name for f in pair.frames)}
    return ", ".join(axes[a][i] for a, i in zip(quantity.axes, index, strict=True))


def checks(pair: Pair, q: Array, v: Array, theirs: Numbers) -> list[Check]:
    """Every quantity compared; what differs carries the mends that make it equal."""
    mends = _mends(pair)
    known: dict[frozenset[str], Numbers] = {}

    def with_mends(chosen: Iterable[str]) -> Numbers:
        key = frozenset(chosen)
        if key not in known:
            model = pair.model.copy()
            for name in sorted(key, key=list(mends).index):
                mends[name](model)
            known[key] = pin_numbers(pair, model, q, v)
        return known[key]

    def equal(key: str, chosen: Iterable[str]) -> bool:
        return compare(key, pair, with_mends(chosen), theirs).ok

    found = []
    for key in QUANTITIES:
        check = compare(key, pair, with_mends(()), theirs)
        if not check.ok:
            because = _needed(list(mends), partial(equal, key))
            check = replace(check, because=tuple(because))
        found.append(check)
    return found


def _needed(names: list[str], equal: Callable[[list[str]], bool]) -> list[str]:
    """A smallest set of mends after which the engines are equal; empty if none is."""
    if not equal(names):
        return []
    for name in list(names):
        fewer = [n for n in names if n != name]
        if equal(fewer):
            names = fewer
    return names


def _mends(pair: Pair) -> dict[str, Callable[[pin.Model], None]]:
    """What could be wrong with Pinocchio's model, and MuJoCo's value for it."""
    engine = pair.engine

    def armature(model: pin.Model) -> None:
        values = np.array(model.armature)
        values[pair.pin_v] = engine.dof_armature[pair.mj_v]
        model.armature = values

    def gravity(model: pin.Model) -> None:
        model.gravity.linear = effective_gravity(engine)

    mends: dict[str, Callable[[pin.Model], None]] = {
        ROOT_POSE: lambda model: _place_root(model, root(engine)),
        GRAVITY: gravity,
        ARMATURE: armature,
    }
    if all(engine.body(i).name for i in range(engine.nbody)):
        mends[INERTIA] = lambda model: _copy_inertia(pair, model)
    return mends


def root(engine: mujoco.MjModel) -> pin.SE3:
    """Pose of MuJoCo's first root body in the world; identity if it can move."""
    if engine.nbody < 2 or engine.body_jntnum[1]:
        return pin.SE3.Identity()
    w, x, y, z = engine.body_quat[1]
    R = pin.Quaternion(w, x, y, z).toRotationMatrix()
    return pin.SE3(R, np.array(engine.body_pos[1]))


def _place_root(model: pin.Model, X: pin.SE3) -> None:
    for i in range(1, model.njoints):
        if model.parents[i] == 0:
            model.jointPlacements[i] = X * model.jointPlacements[i]
    for i in range(1, model.nframes):
        if model.frames[i].parentJoint == 0:
            model.frames[i].placement = X * model.frames[i].placement


def _copy_inertia(pair: Pair, model: pin.Model) -> None:
    """Give every joint the inertia that MuJoCo's bodies of the same names have."""
    engine = pair.engine
    sums = [pin.Inertia.Zero() for _ in range(model.njoints)]
    for frame in pair.frames:
        if not frame.site:
            placed = model.frames[frame.pin]
            body = _body_inertia(engine, frame.mujoco)
            sums[placed.parentJoint] += placed.placement.act(body)
    for i in range(1, model.njoints):
        model.inertias[i] = sums[i]


def _body_inertia(engine: mujoco.MjModel, body: int) -> pin.Inertia:
    w, x, y, z = engine.body_iquat[body]
    R = pin.Quaternion(w, x, y, z).toRotationMatrix()
    about_centre = R @ np.diag(engine.body_inertia[body]) @ R.T
    return pin.Inertia(
        float(engine.body_mass[body]), np.array(engine.body_ipos[body]), about_centre
    )
