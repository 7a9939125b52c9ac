"""Furniture of a scene: room, boxes, pipes. Nothing of it collides unless asked."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import ArrayLike

__all__ = ["add_box", "add_cylinder", "add_room"]

FLOOR = (0.62, 0.65, 0.69, 1.0)
SKY = (0.62, 0.72, 0.84)


def add_room(spec: mujoco.MjSpec) -> None:
    """A floor, two lights and a pleasant view."""
    spec.worldbody.add_geom(
        name="floor",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[3.0, 3.0, 0.1],
        rgba=FLOOR,
        contype=0,
        conaffinity=0,
    )
    for x, y, shadow in ((1.2, -1.6, True), (-1.0, 1.6, False)):
        spec.worldbody.add_light(
            type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
            pos=[x, y, 3.5],
            dir=[0.5 - x, -y, -3.5],
            diffuse=[0.42] * 3,
            specular=[0.15] * 3,
            castshadow=shadow,
        )
    spec.visual.headlight.ambient = [0.28] * 3
    spec.visual.headlight.diffuse = [0.30] * 3
    spec.visual.headlight.specular = [0.1] * 3
    spec.visual.quality.shadowsize = 4096
    spec.visual.global_.offwidth = 1920
    spec.visual.global_.offheight = 1080
    spec.add_texture(
        name="sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=SKY,
        rgb2=[1.0, 1.0, 1.0],
        width=256,
        height=1536,
    )
    spec.stat.center = [0.5, 0.0, 0.6]
    spec.stat.extent = 1.6


def add_box(
    spec: mujoco.MjSpec,
    name: str,
    low: Sequence[float],
    high: Sequence[float],
    rgba: Sequence[float],
) -> None:
    """A box between two corners [m]."""
    a, b = np.array(low, dtype=float), np.array(high, dtype=float)
    spec.worldbody.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=(a + b) / 2.0,
        size=(b - a) / 2.0,
        rgba=rgba,
        contype=0,
        conaffinity=0,
    )


def add_cylinder(
    spec: mujoco.MjSpec,
    name: str,
    ends: ArrayLike,
    radius: float,
    rgba: Sequence[float],
) -> None:
    """A cylinder between the two rows of `ends` (2, 3) [m]."""
    a, b = np.asarray(ends, dtype=float)
    spec.worldbody.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        fromto=np.concatenate([a, b]),
        size=[radius, 0.0, 0.0],
        rgba=rgba,
        contype=0,
        conaffinity=0,
    )
