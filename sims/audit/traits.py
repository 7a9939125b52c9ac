"""Traits of a file that one engine reads and the other ignores, each as a finding."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import mujoco
import numpy as np
import pinocchio as pin

from sims.audit.causes import ARMATURE, GRAVITY, INERTIA, ROOT_POSE, root
from sims.audit.load import Engines
from sims.audit.names import body_name, dof_names
from sims.audit.numbers import effective_gravity
from sims.audit.pair import Pair
from sims.audit.result import Finding, listed, named, once
from wbc.arrays import Array

__all__ = ["COUPLED", "causes", "inertia_cause", "traits"]

COUPLED = "tendon or actuator armature"
SMALL = 1e-9  # armature that counts as none [kg m^2]


def causes(engines: Engines, pair: Pair, needed: set[str]) -> Iterator[Finding]:
    """A finding for each mend that the checks turned out to need."""
    found: dict[str, Callable[[], Finding]] = {
        ROOT_POSE: lambda: _root_pose(pair),
        GRAVITY: lambda: _gravity(pair),
        ARMATURE: lambda: _armature(pair),
        INERTIA: lambda: _inertia(engines, pair),
    }
    yield from (make() for name, make in found.items() if name in needed)
    if engines.bare and INERTIA not in needed and engines.kind == "MJCF":
        yield from _harmless_geoms(engines, pair)


def _root_pose(pair: Pair) -> Finding:
    X = root(pair.engine)
    angle = np.degrees(np.linalg.norm(pin.log3(X.rotation)))
    return Finding(
        ROOT_POSE,
        f"root body '{body_name(pair.engine, 1)}'",
        "puts the root at the world's origin, silently",
        f"pos {_vector(X.translation)} m, turned by {angle:.6g} degrees",
        "Keep the root at identity and put the pose on a body below it. "
        "Robot.from_mjcf mends this.",
        "error",
    )


def _gravity(pair: Pair) -> Finding:
    flag = pair.engine.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_GRAVITY
    return Finding(
        GRAVITY,
        '<option><flag gravity="disable"/>' if flag else "<option gravity>",
        f"{_vector(pair.model.gravity.linear)} m/s^2, whatever the file says",
        f"{_vector(effective_gravity(pair.engine))} m/s^2",
        "Set model.gravity.linear in Pinocchio. Robot.from_mjcf does so.",
        "error",
    )


def _armature(pair: Pair) -> Finding:
    mine = np.array(pair.model.armature)[pair.pin_v]
    theirs = pair.engine.dof_armature[pair.mj_v]
    bad = np.flatnonzero(np.abs(mine - theirs) > SMALL)
    return Finding(
        ARMATURE,
        named("joint", [pair.names[i] for i in bad]),
        f"{_vector(mine[bad])} kg m^2",
        f"{_vector(theirs[bad])} kg m^2",
        "M differs on the diagonal by exactly this. Set model.armature in Pinocchio.",
        "error",
    )


def inertia_cause(engines: Engines) -> str:
    """What the finding is called that explains different inertias."""
    if engines.total_mass > 0:
        return "settotalmass"
    return "inertial missing" if engines.bare else INERTIA


def _inertia(engines: Engines, pair: Pair) -> Finding:
    cause = inertia_cause(engines)
    where, mine, theirs, advice = {
        "settotalmass": (
            "<compiler settotalmass>",
            "does not know settotalmass",
            f"scales all bodies to {engines.total_mass:.6g} kg",
            "Remove settotalmass and write the masses that are meant.",
        ),
        "inertial missing": (
            named("body", _bare_and_heavy(engines, pair) or engines.bare),
            "infers mass and inertia from geoms in its own way, or takes zero",
            "infers mass and inertia from geoms and meshes",
            "Write <inertial> with mass, pos and inertia on every body.",
        ),
        INERTIA: (
            "masses or inertias of bodies that have <inertial>",
            "see the entries above",
            "see the entries above",
            "Look at <compiler>: inertiafromgeom, balanceinertia, boundmass, "
            "boundinertia.",
        ),
    }[cause]
    return Finding(cause, where, mine, theirs, advice, "error")


def _harmless_geoms(engines: Engines, pair: Pair) -> Iterator[Finding]:
    heavy = _bare_and_heavy(engines, pair)
    if heavy:
        yield Finding(
            "inertial missing",
            named("body", heavy),
            "infers mass and inertia from geoms",
            "infers mass and inertia from geoms, here with the same result",
            "Write <inertial>: editing a geom must not change the dynamics.",
            "note",
        )


def _bare_and_heavy(engines: Engines, pair: Pair) -> list[str]:
    engine = pair.engine
    heavy = {body_name(engine, int(i)) for i in np.flatnonzero(engine.body_mass)}
    return [name for name in engines.bare if name in heavy]


def traits(pair: Pair) -> Iterator[Finding]:
    """Damping, friction, equality constraints and coupled armature."""
    engine, model, names = pair.engine, pair.model, dof_names(pair.engine)
    for what, theirs, mine in (
        ("damping", engine.dof_damping, model.damping),
        ("frictionloss", engine.dof_frictionloss, model.upperDryFrictionLimit),
    ):
        at = np.flatnonzero(theirs)
        read = np.array(mine)[pair.pin_v]
        if at.size:
            yield Finding(
                what,
                named("joint", once([names[i] for i in at])),
                f"stores it (up to {read.max(initial=0.0):.6g}), but neither M nor h "
                "nor aba contains it",
                f"applies it in every step (up to {theirs.max():.6g})",
                "Set it to 0 for exact torque control, or leave it in as a mismatch "
                "that the controller does not know.",
                "note",
            )
    if engine.neq:
        yield Finding(
            "equality constraints",
            listed([engine.equality(i).name or f"#{i}" for i in range(engine.neq)]),
            "reads none of them",
            "holds them in every step",
            "Remove them from the robot's file, or declare them to the controller.",
            "error",
        )
    if engine.tendon_armature.any() or engine.actuator_armature.any():
        yield Finding(
            COUPLED,
            "<tendon> or <actuator>",
            "knows nothing of it",
            "adds it to M and h",
            "Put the armature on the joints.",
            "error",
        )


def _vector(values: Array) -> str:
    return " ".join(f"{x:.6g}" for x in values)
