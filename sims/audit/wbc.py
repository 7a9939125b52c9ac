"""What `Robot` says of the file, and whether its model equals MuJoCo's."""

from __future__ import annotations

import warnings
from pathlib import Path

import mujoco
import numpy as np

from sims.audit.actuators import torque_limits
from sims.audit.causes import compare
from sims.audit.limits import limit_check
from sims.audit.load import Engines
from sims.audit.numbers import mujoco_numbers, pin_numbers
from sims.audit.pair import pair
from sims.audit.result import Check, Finding
from wbc import Robot
from wbc.errors import ModelError, WbcError
from wbc.mjcf import read_mjcf

__all__ = ["verdict", "wbc_checks"]

COMPARED = ("M", "h", "p", "R", "J", "drift")


def verdict(engines: Engines, path: Path) -> Finding:
    """Whether wbc loads the file as it is; the ModelError's message if not."""
    reader = "from_mjcf" if engines.kind == "MJCF" else "from_urdf"
    where = f"Robot.{reader}"
    try:
        with warnings.catch_warnings():  # a division by zero is no way to refuse
            warnings.simplefilter("error", RuntimeWarning)
            getattr(Robot, reader)(path)
    except WbcError as error:
        return Finding("wbc refuses the file", where, "", "", str(error), "note")
    except Exception as error:  # ours to mend, but not by losing the audit
        message = f"{type(error).__name__}: {error}. Please report it."
        return Finding("wbc fails on the file", where, "", "", message, "error")
    return Finding("wbc loads the file", where, "", "", "", "note")


def wbc_checks(
    engines: Engines, engine: mujoco.MjModel, states: int, seed: int
) -> list[Check]:
    """The model of `read_mjcf` against MuJoCo; empty where wbc refuses the file.

    Where a name of MuJoCo's is unknown to wbc, nothing is compared. What Pinocchio's
    own reader makes of the file plays no part.
    """
    if engines.kind != "MJCF":
        return []
    try:
        mjcf = read_mjcf(engines.text)
    except ModelError:
        return []
    both = pair(mjcf.model, engine)
    if both.only_mujoco or both.lost or not both.names:
        return []
    q, v = both.states(states, seed)
    mine, theirs = pin_numbers(both, both.model, q, v), mujoco_numbers(both, q, v)
    found = [compare(key, both, mine, theirs) for key in COMPARED]
    box = [np.array(both.limits(side)) for side in ("pin", "mujoco")]
    torque = np.array([mjcf.torque.get(name, np.inf) for name in both.names])
    limits = [
        limit_check("position limits", both, box[0], box[1], "rad or m"),
        limit_check("torque limits", both, torque, torque_limits(both), "Nm or N"),
    ]
    return [*found, *limits]
