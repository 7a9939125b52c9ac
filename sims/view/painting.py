"""Marks put into a scene of MuJoCo, whoever renders it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import mujoco
import numpy as np

from sims.view.marks import Connector, Mark, Solid

__all__ = ["paint"]

SHAPES: Final = {
    "ball": mujoco.mjtGeom.mjGEOM_SPHERE,
    "box": mujoco.mjtGeom.mjGEOM_BOX,
    "tube": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "line": mujoco.mjtGeom.mjGEOM_CAPSULE,
    "arrow": mujoco.mjtGeom.mjGEOM_ARROW,
}
GLOW: Final = 0.35
"""Light of its own, so that colours read the same from all sides."""


def paint(scene: mujoco.MjvScene, marks: Sequence[Mark]) -> None:
    """Add marks to what a scene has already, as many as there is room for."""
    for mark in marks[: scene.maxgeom - scene.ngeom]:
        geom = scene.geoms[scene.ngeom]
        if isinstance(mark, Solid):
            _solid(geom, mark)
        else:
            _connector(geom, mark)
        geom.emission, geom.label = GLOW, mark.label
        geom.category = mujoco.mjtCatBit.mjCAT_DECOR
        scene.ngeom += 1


def _solid(geom: mujoco.MjvGeom, mark: Solid) -> None:
    mujoco.mjv_initGeom(
        geom,
        SHAPES[mark.shape],
        mark.size,
        mark.p,
        np.ascontiguousarray(mark.R).ravel(),
        np.array(mark.colour, dtype=np.float32),
    )


def _connector(geom: mujoco.MjvGeom, mark: Connector) -> None:
    colour = np.array(mark.colour, dtype=np.float32)
    nothing = np.zeros(3)
    mujoco.mjv_initGeom(
        geom, SHAPES[mark.shape], nothing, nothing, np.eye(3).ravel(), colour
    )
    mujoco.mjv_connector(geom, SHAPES[mark.shape], mark.radius, mark.a, mark.b)
