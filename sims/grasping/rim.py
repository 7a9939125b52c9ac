"""The rim grasp as tasks: what the tcp keeps to while the reference moves."""

from __future__ import annotations

from typing import Final, final

from sims.grasping.motion import Reference
from sims.grasping.plan import TCP
from tasks import FramePose, JointLimits, Posture, TorqueLimits
from wbc import Hierarchy

__all__ = ["RimGrasp"]

STIFFNESS: Final = 14400.0
"""Of the grasp [1/s^2]."""


@final
class RimGrasp:
    """Torque limits >> joint limits >> the grasp >> a posture.

    Attributes:
        hierarchy: the stack.
    """

    def __init__(self, first: Reference) -> None:
        self._pose = FramePose(
            TCP, first.p, first.R, stiffness=STIFFNESS, name="rim grasp"
        )
        self._posture = Posture(first.q, stiffness=25.0)
        self.hierarchy: Hierarchy = (
            TorqueLimits() >> JointLimits(margin=0.02) >> self._pose >> self._posture
        )

    def follow(self, reference: Reference) -> None:
        """Move to a reference."""
        self._pose.set_target(reference.p, reference.R, reference.V, reference.A)
        self._posture.set_target(reference.q)
