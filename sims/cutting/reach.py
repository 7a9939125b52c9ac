"""How far the cutting arm reaches with its knife upright."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sims.cutting.layout import CUTTER, TIP
from wbc import InputError, Robot
from wbc.arrays import Array

__all__ = ["Reach", "check_reach", "reach"]

MARGIN = 0.005
"""Kept from the stretched arm [m]."""


class Reach(NamedTuple):
    """Distances from the base's axis that the tip can take at one height [m]."""

    nearest: float
    farthest: float


def reach(robot: Robot, z: float) -> Reach:
    """Reach at tip height z with the knife pointing straight down.

    The wrist stands above the tip; between shoulder and wrist lie two links and the
    elbow's range.
    """
    home = robot.state(robot.q_home)
    shoulder, elbow, wrist = (home.frame(f"{CUTTER}_link{k}").p for k in (2, 4, 6))
    upper = float(np.linalg.norm(elbow - shoulder))
    fore = float(np.linalg.norm(wrist - elbow))
    F = home.frame(TIP)
    tool = float((F.p - wrist) @ F.R[:, 2])
    fold = robot.q_max[robot.joint_index(f"{CUTTER}_joint4")]
    rise = z + tool - shoulder[2]
    folded = upper**2 + fore**2 + 2.0 * upper * fore * np.cos(fold)
    stretched = (upper + fore - MARGIN) ** 2
    return Reach(*(float(np.sqrt(max(d - rise**2, 0.0))) for d in (folded, stretched)))


def check_reach(robot: Robot, line: Array, what: str) -> None:
    """See that a guide line (k, 3) can be cut, before anything moves.

    Raises:
        InputError: a point of it is too near or too far.
    """
    base = robot.state(robot.q_home).frame(CUTTER).p
    radii = np.linalg.norm((line - base)[:, :2], axis=1)
    for point, radius in zip(line, radii, strict=True):
        near, far = reach(robot, float(point[2]))
        if not near <= radius <= far:
            raise InputError(
                f"{what} runs through ({point[0]:.3f}, {point[1]:.3f}, {point[2]:.3f})"
                f" m, {radius:.3f} m from the cutting arm's axis, out of reach: at "
                f"that height the upright knife reaches {near:.3f} to {far:.3f} m. "
                "Move the meat."
            )
