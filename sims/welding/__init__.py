"""Welding: a 6-axis arm welds a spot, a straight seam and a saddle (P4, IV-B)."""

from __future__ import annotations

from sims.cell import ArmCell
from sims.mismatch import Mismatch
from sims.sensors import Encoders
from sims.welding.workpiece import CURVE, POINT, SEAM, scene
from wbc import Robot
from wbc.checks import expect

__all__ = ["CURVE", "POINT", "SEAM", "cell"]


def cell(
    robot: Robot,
    *,
    mismatch: bool = False,
    seed: int = 0,
    encoders: Encoders | None = None,
) -> ArmCell:
    """The welding cell around a robot that was read from MJCF.

    Args:
        robot: the arm, with a site "torch_tip".
        mismatch: simulate an arm whose masses, centres of mass and joint friction
            differ from the controller's model.
        seed: of the mismatch.
        encoders: joint sensors; perfect by default.
    """
    expect(Robot, robot=robot)
    differs = Mismatch.when(mismatch, seed)
    return ArmCell("welding", robot, scene(robot), mismatch=differs, encoders=encoders)
