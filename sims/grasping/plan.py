"""Which point of the rim, and the postures from there to the goal: a plan."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
import pinocchio as pin

from sims.grasping.cylinder import Cylinder, turn_z
from sims.grasping.reach import Reached, nearest
from wbc import InputError, Robot
from wbc.arrays import Array

__all__ = ["HOVER", "LIFT", "TCP", "Plan", "make_plan"]

TCP: Final = "tcp"
HOVER: Final = 0.06
"""Height above the rim from which the fingers come down along the axis [m]."""
LIFT: Final = 0.10
"""[m]"""
CLEARANCE: Final = 5e-4
"""Height above the goal at which the fingers let go [m]."""
UP: Final = np.array([0.0, 0.0, 1.0])
ANGLES: Final = 24
"""Places on the rim that are tried for each way round of the gripper."""
REFINEMENTS: Final = 5
"""How often the best of them is looked at more closely, twice as fine each time."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """Poses of the tcp with the postures that reach them, in the order of the job.

    Attributes:
        above: over the rim, fingers open.
        grasp: at the rim.
        lifted: straight up from there.
        over: with the cylinder upright over the goal.
        placed: with the cylinder on the goal, but for a hair.
        away: over the rim again.
        flipped: whether the closing direction points towards the axis.
    """

    above: Reached
    grasp: Reached
    lifted: Reached
    over: Reached
    placed: Reached
    away: Reached
    flipped: bool


def make_plan(robot: Robot, cylinder: Cylinder, goal: Array, start: Array) -> Plan:
    """Choose the place on the rim that is nearest to the present posture.

    P4 solves the grasp constraints "to obtain the target pose closest to the previous
    waypoint"; left free are the angle along the rim and the gripper's way round.

    Args:
        robot: the arm.
        cylinder: what to grasp.
        goal: (3,) where its base is to stand [m].
        start: (n,) present posture [rad].

    Raises:
        InputError: the cylinder or the goal is out of reach; nothing has moved yet.
    """
    best = min(
        (_pick(robot, cylinder, start, flipped) for flipped in (False, True)),
        key=lambda found: (not found[0].met, np.linalg.norm(found[0].q - start)),
    )
    above, flipped = best
    _need(above, cylinder, "a place over its rim")
    grasp = nearest(robot, TCP, shifted(above.X, HOVER), above.q)
    _need(grasp, cylinder, "its rim")
    lifted = nearest(robot, TCP, raised(grasp.X, LIFT), grasp.q)
    _need(lifted, cylinder, f"{LIFT} m above the grasp")
    top = pin.SE3(np.eye(3), goal + (cylinder.height + CLEARANCE) * UP)
    over = _around(robot, cylinder, raised(top, HOVER), lifted.q, flipped)
    _need(over, cylinder, "the goal")
    placed = nearest(robot, TCP, raised(over.X, -HOVER), over.q)
    _need(placed, cylinder, "the goal")
    away = nearest(robot, TCP, raised(placed.X, HOVER), placed.q)
    return Plan(above, grasp, lifted, over, placed, away, flipped)


def rim_pose(cylinder: Cylinder, top: pin.SE3, angle: float, flipped: bool) -> pin.SE3:
    """Pose of the tcp at an angle of the rim [rad], given the pose of the top.

    The approach direction z is against the axis, the closing direction x radial.
    """
    side = -1.0 if flipped else 1.0
    R = np.column_stack([[side, 0, 0], [0, -side, 0], [0, 0, -1.0]])
    on_rim = pin.SE3(turn_z(angle) @ R, turn_z(angle) @ [cylinder.rim, 0.0, 0.0])
    return top * on_rim


def shifted(X: pin.SE3, depth: float) -> pin.SE3:
    """A pose further along its own z axis [m]."""
    return pin.SE3(X.rotation, X.translation + depth * X.rotation[:, 2])


def raised(X: pin.SE3, height: float) -> pin.SE3:
    """A pose further up [m]."""
    return pin.SE3(X.rotation, X.translation + height * UP)


def _pick(
    robot: Robot, cylinder: Cylinder, start: Array, flipped: bool
) -> tuple[Reached, bool]:
    hover = pin.SE3(cylinder.R, cylinder.top + HOVER * cylinder.axis)
    return _around(robot, cylinder, hover, start, flipped), flipped


def _around(
    robot: Robot, cylinder: Cylinder, top: pin.SE3, q: Array, flipped: bool
) -> Reached:
    """The posture nearest to q (n,) with the tcp anywhere on a circle like the rim."""

    def reach(angle: float) -> Reached:
        return nearest(robot, TCP, rim_pose(cylinder, top, angle, flipped), q)

    step = 2.0 * np.pi / ANGLES
    tried = {step * i: reach(step * i) for i in range(ANGLES)}
    for _ in range(REFINEMENTS):
        best = min(tried, key=lambda angle: _cost(tried[angle], q))
        step *= 0.5
        tried |= {angle: reach(angle) for angle in (best - step, best + step)}
    return min(tried.values(), key=lambda reached: _cost(reached, q))


def _cost(reached: Reached, q: Array) -> tuple[float, float]:
    """What is missing, then how far away it is."""
    way = float(np.linalg.norm(reached.q - q))
    return (0.0 if reached.met else reached.miss, way)


def _need(reached: Reached, cylinder: Cylinder, what: str) -> None:
    if not reached.met:
        raise InputError(
            f"'{cylinder.name}' is out of reach: the arm misses {what} by "
            f"{reached.miss:.2g} m. Move it closer; the arm has not moved."
        )
