"""Bodies, joints and frames that only one engine has, or has elsewhere."""

from __future__ import annotations

from collections.abc import Iterator

import mujoco
import numpy as np

from sims.audit.load import Engines
from sims.audit.names import body_name, joint_names
from sims.audit.pair import COMPOSITE, Pair
from sims.audit.result import Check, Finding, listed, named, once

__all__ = ["BODIES", "SECOND_ROOT", "SKEWED", "structure", "structure_checks"]

SECOND_ROOT = "second root dropped"
BODIES = "bodies or frames missing"
SKEWED = "orientation is no rotation"
ORTHOGONAL = 1e-9  # largest entry of R R^T - I that counts as a rotation


def structure_checks(pair: Pair) -> list[Check]:
    """How many joints are unmatched, and how many are out of order."""
    unmatched = (*pair.only_pin, *pair.only_mujoco)
    moved = _out_of_order(pair)
    return [
        Check("joints known to one engine", len(unmatched), 0, "joints",
              listed(unmatched), pair.model.njoints - 1, pair.engine.njnt),
        Check("joints in another order", len(moved), 0, "joints", listed(moved)),
    ]  # fmt: skip


def structure(engines: Engines, pair: Pair) -> Iterator[Finding]:
    """What differs in the tree itself."""
    yield from _roots(pair)
    yield from _missing(engines, pair)
    yield from _joints(pair)
    yield from _order(pair)
    yield from _several_degrees(pair)
    yield from _skewed(pair)


def _extra_roots(pair: Pair) -> list[int]:
    engine, known = pair.engine, {f.mujoco for f in pair.frames if not f.site}
    roots = np.flatnonzero(engine.body_parentid[1:] == 0) + 1
    return [int(i) for i in roots[1:] if int(i) not in known]


def _roots(pair: Pair) -> Iterator[Finding]:
    engine, extra = pair.engine, _extra_roots(pair)
    if not extra:
        return
    labels = joint_names(engine)
    joints = [
        name
        for name, body in zip(labels, engine.jnt_bodyid, strict=True)
        if engine.body_rootid[body] in extra
    ]
    bodies = [f"'{body_name(engine, i)}'" for i in extra]
    mass = sum(float(engine.body_subtreemass[i]) for i in extra)
    yield Finding(
        SECOND_ROOT,
        f"root {named('body', bodies)}; joints: {listed(joints) or 'none'}",
        f"reads the first root, '{body_name(engine, 1)}', and skips the rest silently",
        f"has {1 + len(extra)} root bodies; the skipped ones weigh {mass:.6g} kg",
        "One file per robot. Leave other arms, tables and work-pieces to the scene.",
        "error",
    )


def _missing(engines: Engines, pair: Pair) -> Iterator[Finding]:
    engine, extra = pair.engine, _extra_roots(pair)
    dropped = {
        f"body '{engine.body(i).name}'"
        for i in range(1, engine.nbody)
        if engine.body_rootid[i] in extra
    } | {
        f"site '{engine.site(i).name}'"
        for i in range(engine.nsite)
        if engine.body_rootid[engine.site_bodyid[i]] in extra
    }
    lost = [name for name in pair.lost if name not in dropped]
    if lost:
        framed = "<frame" in engines.text
        yield Finding(
            BODIES,
            listed(lost),
            "does not have them" + (" (it skips what is inside <frame>)" * framed),
            "has them",
            "Write poses on the bodies themselves, without <frame>."
            if framed
            else "Rename what shares a name; look for elements Pinocchio skips.",
            "error",
        )


def _joints(pair: Pair) -> Iterator[Finding]:
    if not pair.names:
        yield Finding(
            "nothing to compare", "all joints",
            f"joints: {listed(list(pair.model.names)[1:]) or 'none'}",
            f"joints: {listed(joint_names(pair.engine)) or 'none'}",
            "The engines have no hinge or slide of the same name.", "error",
        )  # fmt: skip
    if pair.only_pin or (pair.only_mujoco and not _extra_roots(pair)):
        yield Finding(
            "joint sets differ",
            listed((*pair.only_pin, *pair.only_mujoco)),
            f"only here: {listed(pair.only_pin) or 'none'}",
            f"only here: {listed(pair.only_mujoco) or 'none'}",
            "The numbers above are of the common joints, the others at rest. Name "
            "every joint and avoid what one engine skips.",
            "error",
        )


def _out_of_order(pair: Pair) -> list[str]:
    order = [pair.names[i] for i in np.argsort(pair.pin_v, kind="stable")]
    both = zip(pair.names, order, strict=True)
    return [name for name, other in both if name != other]


def _order(pair: Pair) -> Iterator[Finding]:
    if _out_of_order(pair):
        order = [pair.names[i] for i in np.argsort(pair.pin_v, kind="stable")]
        yield Finding(
            "joint order",
            listed(_out_of_order(pair)),
            ", ".join(order),
            ", ".join(pair.names),
            "Never copy q, v or torque between the engines as whole vectors: map by "
            "joint name. wbc uses Pinocchio's order.",
            "error",
        )


def _several_degrees(pair: Pair) -> Iterator[Finding]:
    kinds, labels = pair.engine.jnt_type, joint_names(pair.engine)
    free = [s for s, k in zip(labels, kinds, strict=True) if _is(k, "FREE")]
    if free:
        yield Finding(
            "free joint",
            listed(free),
            "quaternion x y z w; linear velocity in the body's own axes",
            "quaternion w x y z; linear velocity in world axes, angular in body axes",
            "Convert both when copying. Compared with the base at rest. wbc controls "
            "fixed-base robots.",
            "note",
        )
    ball = [s for s, k in zip(labels, kinds, strict=True) if _is(k, "BALL")]
    if ball:
        yield Finding(
            "ball joint", listed(ball), "quaternion x y z w", "quaternion w x y z",
            "Convert when copying. Compared at rest only. wbc wants hinges and slides.",
            "note",
        )  # fmt: skip
    merged = [n for n in pair.model.names if n.startswith(COMPOSITE)]
    if merged:
        yield Finding(
            "joints merged", listed(merged),
            "makes one composite joint of all joints of a body",
            "keeps one joint a degree of freedom",
            "Give every joint a body of its own: wbc refuses composite joints.", "note",
        )  # fmt: skip


def _skewed(pair: Pair) -> Iterator[Finding]:
    """Pinocchio takes an axisangle as it is written, of whatever length."""
    model = pair.model
    placed = [(model.names[i], model.jointPlacements[i]) for i in range(model.njoints)]
    placed += [(frame.name, frame.placement) for frame in model.frames]
    skew = [
        name
        for name, X in placed
        if np.abs(X.rotation @ X.rotation.T - np.eye(3)).max() > ORTHOGONAL
    ]
    if skew:
        yield Finding(
            SKEWED,
            listed(once(skew)),
            "uses a matrix that is no rotation: it stretches what hangs on it",
            "normalises what the file says",
            "Write axes of length 1 in axisangle, or use quat. Robot.from_mjcf "
            "mends this.",
            "error",
        )


def _is(kind: int, name: str) -> bool:
    return bool(kind == getattr(mujoco.mjtJoint, f"mjJNT_{name}"))
