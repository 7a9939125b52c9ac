"""The work-pieces: a T-joint and a pipe saddle on a table, as geometry and scene."""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np

from sims.scene import add_box, add_cylinder, add_room
from tasks import Curve, Line
from wbc import Robot
from wbc.arrays import Array

__all__ = ["CURVE", "CURVE_WORK", "POINT", "SEAM", "SEAM_AXIS", "scene"]

TABLE: Final = 0.38
"""Height of the table [m]."""
PLATE: Final = 0.02
"""Thickness of the plates [m]."""
SEAM: Final = Line.between((0.95, -0.22, TABLE + PLATE), (0.95, 0.20, TABLE + PLATE))
"""The fillet of the T-joint, where web and flange meet [m]."""
POINT: Final = np.array([0.95, 0.02, TABLE + PLATE])
"""The spot of the point weld [m]."""
SEAM_AXIS: Final = np.array([1.0, 0.0, -1.0]) / np.sqrt(2.0)
"""Direction of the torch at the seam: work angle 45 degrees."""

MAIN_RADIUS: Final = 0.15
BRANCH_RADIUS: Final = 0.075
SADDLE: Final = np.array([0.80, 0.50, TABLE + MAIN_RADIUS])
"""Where the axes of main pipe (along y) and branch (upright) cross [m]."""
CURVE_WORK: Final = -0.6
"""Work angle of the saddle [rad]: about half-way between the two pipe walls."""


def _saddle() -> Curve:
    """The saddle's side that faces the robot, 150 degrees of it, normals from the main.

    The pipes x^2 + y^2 = r^2 and x^2 + z^2 = R^2 meet where z = sqrt(R^2 - x^2).
    """
    angle = np.radians(np.linspace(255.0, 105.0, 41))
    x, y = BRANCH_RADIUS * np.cos(angle), BRANCH_RADIUS * np.sin(angle)
    z = np.sqrt(MAIN_RADIUS**2 - x**2)
    normals = np.column_stack([x, np.zeros_like(x), z]) / MAIN_RADIUS
    return Curve(SADDLE + np.column_stack([x, y, z]), normals)


CURVE: Final = _saddle()
"""The saddle seam [m]; its first normal is that of the main pipe."""

STEEL: Final = (0.62, 0.64, 0.67, 1.0)
DARK_STEEL: Final = (0.50, 0.52, 0.56, 1.0)
WOOD: Final = (0.36, 0.38, 0.42, 1.0)


def scene(robot: Robot) -> mujoco.MjSpec:
    """The arm in its cell; nothing collides, contact is not part of this process."""
    spec = mujoco.MjSpec.from_string(robot.mjcf)
    add_room(spec)
    add_box(spec, "table", (0.55, -0.36, 0.0), (1.20, 0.74, TABLE), WOOD)
    top = TABLE + PLATE
    add_box(spec, "flange", (0.84, -0.26, TABLE), (1.08, 0.24, top), STEEL)
    add_box(spec, "web", (0.95, -0.26, top), (0.97, 0.24, top + 0.13), DARK_STEEL)
    x, y, _ = SADDLE
    main = np.array([[x, y - 0.17, SADDLE[2]], [x, y + 0.17, SADDLE[2]]])
    branch = np.array([SADDLE, [x, y, TABLE + 2.0 * MAIN_RADIUS + 0.14]])
    add_cylinder(spec, "main_pipe", main, MAIN_RADIUS, STEEL)
    add_cylinder(spec, "branch_pipe", branch, BRANCH_RADIUS, DARK_STEEL)
    return spec


def start_of(path: Line | Curve) -> Array:
    """Where a path begins (3,) [m]."""
    return np.array(path.at(0.0).c[0])
