"""A tilted plate on a pedestal, which the ball of the probe may touch."""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np

from sims.scene import add_room
from tasks import Plane
from wbc import Robot

__all__ = ["BALL", "NORMAL", "PLANE", "SURFACE", "TIP", "scene"]

TIP: Final = "probe_tip"
BALL: Final = 0.008
"""Radius of the probe's ball, whose centre is the tip [m]."""
SURFACE: Final = np.array([0.90, 0.0, 0.50])
"""Middle of the plate's upper face [m]."""
TILT: Final = np.array([0.10, -0.12])
"""The plate is turned so about x, then about y [rad]."""
PLATE: Final = np.array([0.20, 0.26, 0.012])
"""Half its length, width and thickness [m]."""
FRICTION: Final = 0.3

ALUMINIUM: Final = (0.66, 0.69, 0.73, 1.0)
PEDESTAL: Final = (0.36, 0.38, 0.42, 1.0)


def _rotation() -> np.ndarray:
    (a, b), R = TILT, np.eye(3)
    Rx = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    Ry = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    return R @ Ry @ Rx


ROTATION: Final = _rotation()
NORMAL: Final = ROTATION[:, 2]
"""Of the plate, upwards; 0.156 rad from the vertical."""
PLANE: Final = Plane(SURFACE + BALL * NORMAL, NORMAL)
"""Where the centre of the ball is when it touches the plate."""


def scene(robot: Robot) -> mujoco.MjSpec:
    """The arm in front of the plate; ball and plate are the only pair that collides.

    The contact is a soft one with an elliptic cone and soft friction: with the usual
    ones a sliding ball loses contact every few steps, whatever the controller does.
    The price: below some mm/s, friction is viscous rather than dry.
    """
    spec = mujoco.MjSpec.from_string(robot.mjcf)
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    add_room(spec)
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, ROTATION.ravel())
    spec.worldbody.add_geom(
        name="plate",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=SURFACE - PLATE[2] * NORMAL,
        quat=quat,
        size=PLATE,
        rgba=ALUMINIUM,
        contype=0,
        conaffinity=0,
    )
    spec.worldbody.add_geom(
        name="pedestal",
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        fromto=[*SURFACE[:2], 0.0, *(SURFACE - 0.02 * NORMAL)],
        size=[0.06, 0.0, 0.0],
        rgba=PEDESTAL,
        contype=0,
        conaffinity=0,
    )
    spec.add_pair(
        geomname1="probe_ball",
        geomname2="plate",
        condim=3,
        friction=[FRICTION, FRICTION, 0.005, 0.0001, 0.0001],
        solref=[0.02, 1.0],
        solreffriction=[0.5, 1.0],
    )
    _add_touch(spec)
    return spec


def _add_touch(spec: mujoco.MjSpec) -> None:
    """The true contact force, for the metrics: a sensor around the ball."""
    probe = spec.body("probe")
    probe.add_site(name="touch", pos=[0.0, 0.0, 0.24], size=[2.0 * BALL] * 3, group=5)
    spec.add_sensor(
        name="touch",
        type=mujoco.mjtSensor.mjSENS_TOUCH,
        objtype=mujoco.mjtObj.mjOBJ_SITE,
        objname="touch",
    )
