"""Where a robot's joints and motors are in a compiled scene."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from wbc.arrays import IntArray
from wbc.errors import InputError

__all__ = ["find_joints", "find_motors"]


def find_joints(model: mujoco.MjModel, names: Sequence[str]) -> list[int]:
    """Numbers of the joints of these names.

    Raises:
        InputError: a joint is not in the scene.
    """
    found = []
    for name in names:
        joint = int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name))
        if joint < 0:
            raise InputError(f"joint '{name}' of the robot is not in the scene.")
        found.append(joint)
    return found


def find_motors(model: mujoco.MjModel, joints: Sequence[int]) -> IntArray:
    """Number of the motor of each joint, (n,).

    Raises:
        InputError: a joint has none, or several.
    """
    driven = model.actuator_trntype == mujoco.mjtTrn.mjTRN_JOINT
    found = []
    for joint in joints:
        motors = np.flatnonzero(driven & (model.actuator_trnid[:, 0] == joint))
        if motors.size != 1:
            name = model.joint(joint).name
            raise InputError(f"joint '{name}' must have one motor, has {motors.size}.")
        found.append(int(motors[0]))
    return np.array(found)
