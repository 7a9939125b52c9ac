"""Contact: what P4 leaves to future work; a peg finds its hole, a crank is turned."""

from __future__ import annotations

from sims.cell import ArmCell
from sims.contact.scene import CRANK, HOLE, scene
from sims.mismatch import Mismatch
from sims.wrist import WristSensor
from wbc import Robot
from wbc.checks import expect

__all__ = ["CRANK", "HOLE", "cell"]


def cell(
    robot: Robot,
    *,
    mismatch: bool = False,
    seed: int = 0,
    wrist: WristSensor | None = None,
) -> ArmCell:
    """The cell around an arm with the peg of `robots.tools`.

    Args:
        robot: the arm, with sites "wrist_sensor" and "peg_tip".
        mismatch: simulate an arm whose masses, centres of mass and joint friction
            differ from the controller's model.
        seed: of the mismatch.
        wrist: the force/torque sensor; a perfect one by default.
    """
    expect(Robot, robot=robot)
    differs = Mismatch.when(mismatch, seed)
    wrist = WristSensor() if wrist is None else wrist
    return ArmCell("contact", robot, scene(robot), mismatch=differs, wrist=wrist)
