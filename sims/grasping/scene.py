"""The grasping cell as a scene: arm with gripper, stand, cylinder, place to put it."""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np

from sims.grasping.cylinder import RECESS, Cylinder
from sims.grasping.gripper import add_fingers
from sims.scene import add_box, add_room
from wbc import Robot
from wbc.arrays import Array

__all__ = ["GOAL", "STAND", "add_cylinder_body", "scene"]

TABLE: Final = 0.34
"""Height of the table [m]."""
STAND: Final = 0.40
"""Height of the middle of the stands' upper faces [m]."""
GOAL: Final = np.array([0.72, 0.30, STAND])
"""Where cylinders are put, base centre [m]."""
FACETS: Final = 36
"""Boxes that make a round wall; convex shapes are all that can collide."""
FEET: Final = 6
FOOT: Final = 0.002
"""Radius of a foot [m]; feet end where the base is."""
GRIP, REST = 2, 1
"""Bits of the contact masks: what fingers touch, and what stands on stands."""
FRICTION: Final = (0.8, 0.005, 0.0001)

WOOD: Final = (0.36, 0.38, 0.42, 1.0)
STEEL: Final = (0.62, 0.64, 0.67, 1.0)
GREEN: Final = (0.35, 0.55, 0.42, 1.0)
TUBE: Final = (0.83, 0.53, 0.24, 1.0)
BLOCK: Final = (0.42, 0.58, 0.78, 1.0)


def scene(robot: Robot, cylinder: Cylinder | None) -> mujoco.MjSpec:
    """The cell with a cylinder on its stand; without one, an empty stand.

    Contact settings are those that hold an object without creep: elliptic cones,
    `impratio` 10, `condim` 4 and a few iterations that take out slip.
    """
    spec = mujoco.MjSpec.from_string(robot.mjcf)
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.impratio = 10.0
    spec.option.noslip_iterations = 3
    add_room(spec)
    add_fingers(spec)
    add_box(spec, "table", (0.45, -0.50, 0.0), (1.10, 0.50, TABLE), WOOD)
    add_stand(spec, "goal", GOAL, np.eye(3), GREEN)
    if cylinder is not None:
        add_stand(spec, "stand", cylinder.p, cylinder.R, STEEL)
        add_cylinder_body(spec, cylinder, "object")
    return spec


def add_stand(
    spec: mujoco.MjSpec,
    name: str,
    p: Array,
    R: Array,
    rgba: tuple[float, ...],
    *,
    free: bool = False,
) -> None:
    """A block whose upper face goes through p (3,) across the z axis of R (3, 3)."""
    half = np.array([0.075, 0.075, 0.5 * (STAND - TABLE) + 0.015])
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, np.ascontiguousarray(R).ravel())
    body = spec.worldbody.add_body(name=name, pos=p, quat=quat)
    if free:
        body.add_freejoint(name=name)
    body.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=[0.0, 0.0, -half[2]],
        size=half,
        rgba=rgba,
        contype=REST,
        conaffinity=REST,
        friction=FRICTION,
        solref=[0.005, 1.0],
    )


def add_cylinder_body(spec: mujoco.MjSpec, cylinder: Cylinder, name: str) -> None:
    """A free body: a ring of boxes for the wall, feet, and what fills a solid one."""
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, np.ascontiguousarray(cylinder.R).ravel())
    body = spec.worldbody.add_body(name=name, pos=cylinder.p, quat=quat)
    body.add_freejoint(name=name)
    body.add_site(name=name, group=4)
    colour = BLOCK if cylinder.solid else TUBE
    floor = cylinder.height - RECESS if cylinder.solid else 0.0
    share = _wall_share(cylinder, floor)
    _add_wall(body, cylinder, floor, share * cylinder.mass, colour)
    if cylinder.solid:
        body.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            pos=[0.0, 0.0, 0.5 * floor],
            size=[cylinder.radius, 0.5 * floor, 0.0],
            mass=(1.0 - share) * cylinder.mass,
            rgba=colour,
            contype=0,
            conaffinity=0,
        )
    _add_feet(body, cylinder)


def _wall_share(cylinder: Cylinder, floor: float) -> float:
    """Share of the volume that is in the wall."""
    ring = cylinder.radius**2 - (cylinder.radius - cylinder.wall) ** 2
    wall = ring * (cylinder.height - floor)
    return float(wall / (wall + cylinder.radius**2 * floor))


def _add_wall(
    body: mujoco.MjsBody,
    cylinder: Cylinder,
    floor: float,
    mass: float,
    rgba: tuple[float, ...],
) -> None:
    rim, half = cylinder.rim, np.pi / FACETS
    for angle in 2.0 * half * np.arange(FACETS):
        body.add_geom(
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=[
                rim * np.cos(angle),
                rim * np.sin(angle),
                0.5 * (floor + cylinder.height),
            ],
            quat=[np.cos(0.5 * angle), 0.0, 0.0, np.sin(0.5 * angle)],
            size=[
                0.5 * cylinder.wall,
                cylinder.radius * np.tan(half),
                0.5 * (cylinder.height - floor),
            ],
            mass=mass / FACETS,
            rgba=rgba,
            contype=GRIP,
            conaffinity=GRIP,
            condim=4,
            friction=FRICTION,
            solref=[0.005, 1.0],
        )


def _add_feet(body: mujoco.MjsBody, cylinder: Cylinder) -> None:
    """Spheres that touch the stand in points: a round base would in too many."""
    for angle in 2.0 * np.pi / FEET * np.arange(FEET):
        body.add_geom(
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            pos=[cylinder.rim * np.cos(angle), cylinder.rim * np.sin(angle), FOOT],
            size=[FOOT, 0.0, 0.0],
            mass=0.0,
            rgba=STEEL,
            contype=REST,
            conaffinity=REST,
            condim=4,
            friction=FRICTION,
            solref=[0.005, 1.0],
        )
