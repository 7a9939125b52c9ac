"""The cutting cell as a scene: room, table, both arms and the meat."""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
import pinocchio as pin

from sims.cutting.layout import CUTTER, GRIP, PULLER, TABLE, robot_of
from sims.cutting.meat import Meat
from sims.scene import add_box, add_room

__all__ = ["LEANING", "PLACE", "UPRIGHT", "scene"]

PLACE: Final = (0.475, 0.14)
"""Middle of the seam above the table (x, y) [m]: both arms reach all of it."""
UPRIGHT: Final = np.diag([-1.0, 1.0, -1.0])
"""Orientation of the knife, tool down, P0 eq. (12)."""
LEAN: Final = np.radians(30.0)
LEANING: Final = np.array(pin.exp3(np.array([-LEAN, 0.0, 0.0]))) @ UPRIGHT
"""Orientation of the bracket: its wrist keeps clear of the other arm's."""
EXPLICIT: Final = 6e4 * 0.01
"""Viscosity up to which Euler is stable, at half the cost and with the same results
(`Meat.add_to`) [Pa s]."""
STEEL: Final = (0.55, 0.58, 0.62, 1.0)


def scene(meat: Meat) -> mujoco.MjSpec:
    """Arms, table and meat; nothing collides, the knife and the links are a process."""
    spec = mujoco.MjSpec.from_string(robot_of(CUTTER, PULLER).mjcf)
    add_room(spec)
    add_box(spec, "table", (0.24, -0.10, TABLE - 0.03), (0.72, 0.80, TABLE), STEEL)
    for x in (0.26, 0.66):
        for y in (-0.08, 0.74):
            leg = f"leg {x} {y}"
            add_box(spec, leg, (x, y, 0.0), (x + 0.04, y + 0.04, TABLE - 0.03), STEEL)
    meat.add_to(spec)
    offset = np.array(spec.site(GRIP).pos)
    if meat.young * meat.damping <= EXPLICIT:
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_EULER
    meat.attach(spec, f"{PULLER}_bracket", meat.grip - LEANING @ offset, LEANING)
    return spec
