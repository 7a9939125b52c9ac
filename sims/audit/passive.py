"""Torques that MuJoCo adds by itself: springs, gravity compensation, fluid."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from sims.audit.names import body_name, dof_names
from sims.audit.numbers import PASSIVE, Numbers
from sims.audit.pair import Pair
from sims.audit.result import Check, Finding, named, once

__all__ = ["passive", "passive_check"]

TOLERANCE = 1e-9  # torque that counts as none [Nm]
ADVICE = {
    "spring": "Remove stiffness, or model the spring as a task.",
    "gravcomp": "Remove gravcomp: the controller would cancel gravity a second time.",
    "fluid": "Set density, viscosity and wind of <option> to 0.",
}


def passive_check(pair: Pair, theirs: Numbers) -> Check:
    """The largest of these torques, none of which Pinocchio knows [Nm]."""
    name, unit = "springs, gravcomp, fluid", "Nm"
    torque = np.array([np.abs(theirs[key]) for key in PASSIVE])
    if not torque.size:
        return Check(name, 0.0, TOLERANCE, unit)
    worst = float(torque.max())
    _, _, dof = np.unravel_index(int(np.argmax(torque)), torque.shape)
    check = Check(name, worst, TOLERANCE, unit)
    if check.ok:
        return check
    present = [k for k, t in zip(PASSIVE, torque, strict=True) if t.max() > TOLERANCE]
    joint = dof_names(pair.engine)[dof]
    return Check(name, worst, TOLERANCE, unit, joint, 0.0, worst, tuple(present))


def passive(pair: Pair, theirs: Numbers) -> Iterator[Finding]:
    """One finding for each kind of passive torque that is present."""
    names = dof_names(pair.engine)
    for key in PASSIVE:
        torque = np.abs(theirs[key]).max(axis=0, initial=0.0)
        moved = once([names[i] for i in np.flatnonzero(torque > TOLERANCE)])
        if moved:
            yield Finding(
                key,
                _bodies(pair) * (key == "gravcomp") + named("joint", moved),
                "knows nothing of it",
                f"adds up to {torque.max():.6g} Nm in qfrc_passive",
                ADVICE[key],
                "error",
            )


def _bodies(pair: Pair) -> str:
    heavy = np.flatnonzero(pair.engine.body_gravcomp)
    return named("body", [body_name(pair.engine, int(i)) for i in heavy]) + "; "
