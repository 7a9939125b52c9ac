"""Grasping: a 6-axis arm takes cylinders by the rim and puts them down (P4, IV-A)."""

from __future__ import annotations

from sims.cell import ArmCell
from sims.grasping.cylinder import Cylinder, seeded_cylinders
from sims.grasping.scene import GOAL, STAND, scene
from sims.mismatch import Mismatch
from sims.sensors import Encoders
from wbc import Robot
from wbc.checks import expect

__all__ = ["GOAL", "STAND", "Cylinder", "cell", "seeded_cylinders"]


def cell(
    robot: Robot,
    cylinder: Cylinder | None,
    *,
    mismatch: bool = False,
    seed: int = 0,
    encoders: Encoders | None = None,
) -> ArmCell:
    """The grasping cell around a robot that was read from MJCF.

    Args:
        robot: the arm with the gripper of `robots.tools`.
        cylinder: what stands there; None for nothing.
        mismatch: simulate an arm whose masses, centres of mass and joint friction
            differ from the controller's model.
        seed: of the mismatch.
        encoders: joint sensors; perfect by default.
    """
    expect(Robot, robot=robot)
    differs = Mismatch.when(mismatch, seed)
    expect(Cylinder | None, cylinder=cylinder)
    spec = scene(robot, cylinder)
    return ArmCell("grasping", robot, spec, mismatch=differs, encoders=encoders)
