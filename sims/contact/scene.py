"""A block with a hole, and a crank with another: what the peg is to deal with."""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np

from sims.scene import add_box, add_room
from wbc import Robot
from wbc.arrays import Array

__all__ = [
    "AXIS",
    "CLEARANCE",
    "CRANK",
    "CRANK_JOINT",
    "HOLE",
    "LEVER",
    "PEG",
    "TIP",
    "scene",
]

TIP: Final = "peg_tip"
PEG: Final = 0.010
"""Radius of the peg [m]."""
CLEARANCE: Final = 2e-4
"""The hole is so much wider than the peg [m]."""
HOLE: Final = np.array([0.88, 0.20, 0.45])
"""Where the block's hole begins [m]; it goes straight down."""
DEPTH: Final = 0.030
"""Of the hole [m]."""
RIBS: Final = 12
SIDES: Final = 16
"""A round hole as a polygon: its flats touch the circle from outside."""

CRANK: Final = np.array([0.80, -0.22, 0.50])
"""Where the crank's axis goes through the lever's upper face [m]."""
AXIS: Final = np.array([np.sin(0.03), -np.sin(0.02), 1.0])
"""The crank's axis, tilted by about two degrees; of any length."""
LEVER: Final = 0.12
"""Radius of the crank [m]."""
THICKNESS: Final = 0.010
"""Of the lever [m]."""
BUSH: Final = 1e-3
"""The crank's hole is so much wider than the peg [m]."""
RESISTANCE, DRAG = 0.6, 0.3
"""Dry [Nm] and viscous [Nm s] friction of the crank."""
CRANK_JOINT: Final = "crank"
FRICTION: Final = 0.2

BLOCK: Final = (0.60, 0.64, 0.70, 1.0)
DARK: Final = (0.36, 0.38, 0.42, 1.0)
BRASS: Final = (0.80, 0.66, 0.34, 1.0)


def scene(robot: Robot) -> mujoco.MjSpec:
    """The arm with the peg, the block and the crank; only peg and holes collide."""
    spec = mujoco.MjSpec.from_string(robot.mjcf)
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    add_room(spec)
    add_box(spec, "table", (0.55, -0.50, 0.0), (1.10, 0.42, 0.36), DARK)
    x, y, z = HOLE
    low, high = (x - 0.045, y - 0.045, 0.36), (x + 0.045, y + 0.045, z - DEPTH)
    add_box(spec, "foot", low, high, BLOCK)
    block = spec.worldbody.add_body(name="block", pos=HOLE)
    add_hole(spec, block, PEG + 0.5 * CLEARANCE, 0.045, DEPTH, BLOCK)
    _add_crank(spec)
    return spec


def add_hole(
    spec: mujoco.MjSpec,
    body: mujoco.MjsBody,
    radius: float,
    outer: float,
    depth: float,
    rgba: tuple[float, ...],
    centre: tuple[float, float] = (0.0, 0.0),
) -> None:
    """A ring of boxes whose inner faces surround a hole along -z from the origin.

    The boxes overlap, which does not narrow the hole: it is what no inner face's
    half-space covers. Soft friction (`solreffriction`) keeps a peg that slides from
    losing contact for single steps.
    """
    half = 0.5 * (outer - radius)
    for k in range(SIDES):
        angle = 2.0 * np.pi * k / SIDES
        middle = (radius + half) * np.array([np.cos(angle), np.sin(angle)])
        name = f"{body.name}_side{k}"
        body.add_geom(
            name=name,
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=[centre[0] + middle[0], centre[1] + middle[1], -0.5 * depth],
            quat=[np.cos(0.5 * angle), 0.0, 0.0, np.sin(0.5 * angle)],
            size=[half, outer * np.tan(np.pi / SIDES), 0.5 * depth],
            mass=0.02,
            rgba=rgba,
            contype=0,
            conaffinity=0,
        )
        for rib in range(RIBS):
            spec.add_pair(
                geomname1=f"peg_rib{rib}",
                geomname2=name,
                condim=3,
                friction=[FRICTION, FRICTION, 0.005, 0.0001, 0.0001],
                solref=[0.01, 1.0],
                solreffriction=[0.3, 1.0],
            )


def _add_crank(spec: mujoco.MjSpec) -> None:
    axis = AXIS / np.linalg.norm(AXIS)
    base, foot = CRANK - 0.04 * axis, [*CRANK[:2], 0.36]
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        fromto=[*foot, *base],
        size=[0.03, 0.0, 0.0],
        rgba=DARK,
        contype=0,
        conaffinity=0,
    )
    crank = spec.worldbody.add_body(name="crank", pos=CRANK, quat=_upright(axis))
    crank.add_joint(
        name=CRANK_JOINT,
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=[0.0, 0.0, 1.0],
        frictionloss=RESISTANCE,
        damping=[DRAG, 0.0, 0.0],
    )
    shapes = (
        (mujoco.mjtGeom.mjGEOM_CYLINDER, [0.0, 0.0, -0.026], [0.024, 0.024, 0.0]),
        (
            mujoco.mjtGeom.mjGEOM_BOX,
            [0.5 * (LEVER - 0.022), 0.0, -0.5 * THICKNESS],
            [0.5 * (LEVER - 0.022), 0.014, 0.5 * THICKNESS],
        ),
    )
    for kind, pos, size in shapes:
        crank.add_geom(
            type=kind,
            pos=pos,
            size=size,
            mass=0.3,
            rgba=BRASS,
            contype=0,
            conaffinity=0,
        )
    add_hole(spec, crank, PEG + 0.5 * BUSH, 0.022, THICKNESS, BRASS, (LEVER, 0.0))


def _upright(axis: Array) -> Array:
    """Quaternion (4,) that turns z to a unit vector near it."""
    quat = np.append(1.0 + axis[2], np.cross([0.0, 0.0, 1.0], axis))
    turned: Array = quat / np.linalg.norm(quat)
    return turned
