"""Joint limits as P4 section III-B has them: a joint near its limit is locked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import final

import numpy as np

from wbc import Robot, Rows, SaturatedPD, State, Task
from wbc.arrays import positive
from wbc.checks import names
from wbc.errors import InputError
from wbc.settled import Settled

__all__ = ["JointLocking"]


@final
class JointLocking(Settled, Task):
    """Joints in an activation zone at their limits are held in its middle, P4 eq. (18).

    Inside the zone a joint's row is an equality, an attraction to the middle of the
    zone with bounded speed; outside there is no row. The locking is plain: a joint that
    has entered the zone stays, also when the tasks below would lead it out, and speed
    and acceleration limits are not known. `JointLimits` has neither flaw; this is the
    paper's way, for comparison.

    Args:
        zone: width of the activation zone [rad or m].
        joints: names of the joints; all by default.
        stiffness: of the attraction [1/s^2].
        speed: largest speed of the attraction [rad/s or m/s].
        acceleration: largest braking that it asks for [rad/s^2 or m/s^2].
        name: "joint locking" by default.

    Raises:
        InputError: a number is not greater than 0; at binding, a range too small for
            two zones.
        UnknownName: at binding, there is no such joint.
    """

    def __init__(
        self,
        zone: float = 0.1,
        *,
        joints: Sequence[str] | None = None,
        stiffness: float = 400.0,
        speed: float = 0.5,
        acceleration: float = 20.0,
        name: str = "joint locking",
    ) -> None:
        super().__init__(name, "rad")
        self.zone = positive(zone, "zone")
        self.joints = listed_joints(joints, name)
        self.law = SaturatedPD(stiffness, speed, acceleration)

    def row_names(self, robot: Robot) -> tuple[str, ...]:
        """The joints' names."""
        return robot.joint_names if self.joints is None else self.joints

    def check(self, robot: Robot) -> None:
        """Joints exist, and two zones fit into each range."""
        for joint in self.row_names(robot):
            i = robot.joint_index(joint)
            if robot.q_max[i] - robot.q_min[i] <= 2.0 * self.zone:
                raise InputError(
                    f"zone {self.zone} of '{self.name}' leaves '{joint}' no range."
                )

    def update(self, state: State, rows: Rows) -> None:
        """Write the rows: equalities in the zone, no bounds outside."""
        robot, half = state.robot, self.zone / 2.0
        rows.A[:] = rows.drift[:] = 0.0
        for row, joint in enumerate(self.row_names(robot)):
            i = robot.joint_index(joint)
            q, low, high = state.q[i], robot.q_min[i] + half, robot.q_max[i] - half
            rows.A[row, i] = 1.0
            rows.rate[row] = state.v[i]
            rows.error[row] = max(q - high, 0.0) + min(q - low, 0.0)
            if low + half < q < high - half:
                rows.lower[row], rows.upper[row] = -np.inf, np.inf
                continue
            error = q - (low if q < (low + high) / 2.0 else high)
            one = slice(row, row + 1)
            rows.error[row] = error
            wish = self.law.acceleration(rows.error[one], rows.rate[one])
            rows.lower[one] = rows.upper[one] = wish


def listed_joints(joints: Sequence[str] | None, task: str) -> tuple[str, ...] | None:
    """Names of a task's joints, None for all.

    Raises:
        InputError: not a list of different names, or an empty one.
    """
    if joints is None:
        return None
    return names(joints, f"joints of '{task}'", some=True)
