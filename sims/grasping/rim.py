"""The stack of the rim grasp: P4's four constraints on a cylinder that moves."""

from __future__ import annotations

from typing import Final, final

import numpy as np

from sims.grasping.motion import Reference
from sims.grasping.plan import TCP
from tasks import Cylinder, JointLimits, MovingFrame, Posture, TorqueLimits, rim_grasp
from wbc import Hierarchy

__all__ = ["RimGrasp"]

STIFFNESS: Final = 14400.0
"""Of the grasp [1/s^2]."""
APPROACH, CLOSING = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)
"""Axes of the tcp."""


@final
class RimGrasp:
    """Torque limits >> joint limits >> rim grasp (7 rows, rank 5) >> posture.

    The cylinder that the constraints speak of is led to the real one, comes to rest
    there, and leads the real one once it is in the grip. So the constraints hold from
    the first tick to the last, and what they leave free, the angle along the rim, is
    the posture's all the way.

    Args:
        first: pose of the tcp at the beginning.
        radius: of the rim [m].
        flipped: whether the closing direction points towards the cylinder's axis.

    Attributes:
        hierarchy: the stack.
    """

    def __init__(self, first: Reference, radius: float, *, flipped: bool) -> None:
        self._carrier = MovingFrame(name="led cylinder")
        centre = (radius if flipped else -radius, 0.0, 0.0)
        cylinder = Cylinder(centre, -np.array(APPROACH), radius, on=self._carrier)
        grasp = rim_grasp(
            TCP, cylinder, approach=APPROACH, closing=CLOSING, stiffness=STIFFNESS
        )
        self._posture = Posture(first.q, stiffness=100.0)
        self.hierarchy: Hierarchy = (
            TorqueLimits() >> JointLimits(margin=0.02) >> grasp >> self._posture
        )
        self.follow(first)

    def follow(self, reference: Reference) -> None:
        """Lead the cylinder, and the posture for what the rim leaves free."""
        self._carrier.set(reference.p, reference.R, reference.V, reference.A)
        self._posture.set_target(reference.q)
