"""Constraints: the cases of P4 section III on a 6-axis arm with a touch probe."""

from __future__ import annotations

from sims.cell import ArmCell
from sims.constraints.surface import NORMAL, SURFACE, scene
from sims.mismatch import Mismatch
from sims.wrist import WristSensor
from wbc import Robot
from wbc.checks import expect

__all__ = ["NORMAL", "SURFACE", "cell"]


def cell(
    robot: Robot,
    *,
    mismatch: bool = False,
    seed: int = 0,
    wrist: WristSensor | None = None,
) -> ArmCell:
    """The cell around an arm with the probe of `robots.tools`.

    Args:
        robot: the arm, with sites "wrist_sensor" and "probe_tip".
        mismatch: simulate an arm whose masses, centres of mass and joint friction
            differ from the controller's model.
        seed: of the mismatch.
        wrist: the force/torque sensor; a perfect one by default.
    """
    expect(Robot, robot=robot)
    differs = Mismatch.when(mismatch, seed)
    wrist = WristSensor() if wrist is None else wrist
    return ArmCell("constraints", robot, scene(robot), mismatch=differs, wrist=wrist)
