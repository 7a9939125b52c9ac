"""The posture near a given one that puts a frame at a pose, within joint limits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
import pinocchio as pin

from wbc import Robot
from wbc.arrays import Array

__all__ = ["Reached", "nearest"]

MET: Final = 1e-6
"""Of position [m] and orientation [rad]."""
MARGIN: Final = 0.05
"""Kept from the joint limits [rad]."""
ROUNDS: Final = 60
LARGEST: Final = 0.4
"""Step of a joint [rad]."""
DAMPING: Final = 1e-3
ALIGNED = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED


@final
@dataclass(frozen=True, slots=True, eq=False)
class Reached:
    """A pose, and how near the robot comes.

    Attributes:
        X: the pose asked for.
        q: (n,) the posture [rad].
        miss: what is left, position [m] and orientation [rad] together.
    """

    X: pin.SE3
    q: Array
    miss: float

    @property
    def met(self) -> bool:
        """Whether the pose is reached."""
        return self.miss < MET


def nearest(robot: Robot, frame: str, X: pin.SE3, q: Array) -> Reached:
    """Damped least squares from q (n,), which stays near it where there is a choice."""
    model, data, index = robot.model, robot.model.createData(), robot.frame_id(frame)
    low, high = robot.q_min + MARGIN, robot.q_max - MARGIN
    q, miss = np.clip(q, low, high), np.inf
    for _ in range(ROUNDS):
        pin.computeJointJacobians(model, data, q)
        here = pin.updateFramePlacement(model, data, index)
        left = np.concatenate(
            [
                X.translation - here.translation,
                pin.log3(X.rotation @ here.rotation.T),
            ]
        )
        miss = float(np.linalg.norm(left))
        if miss < 0.01 * MET:
            break
        J = pin.getFrameJacobian(model, data, index, ALIGNED)
        damping = DAMPING * min(miss, 0.1) * np.eye(6)
        step = J.T @ np.linalg.solve(J @ J.T + damping, left)
        step *= min(1.0, LARGEST / max(float(np.abs(step).max()), 1e-12))
        q = np.clip(q + step, low, high)
    return Reached(X, q, miss)
