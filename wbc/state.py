"""One instant of a robot, with everything that is derived from it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, final

import numpy as np
import pinocchio as pin

from wbc.arrays import Array
from wbc.errors import UnknownName
from wbc.frames import Frames, FrameState

if TYPE_CHECKING:
    from wbc.robot import Robot
    from wbc.task import Task

__all__ = ["State"]

WORLD_ALIGNED = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
IN_WORLD = pin.Convention.WORLD
NO_WRENCHES: Mapping[str, Array] = {}


@final
class State:
    """One instant: made by `Robot.state`; holding one proves that it is current.

    Attributes:
        robot: whose state it is.
        t: time [s].
        dt: control period [s]: torques are held for so long.
        q: (n,) positions [rad or m].
        v: (n,) velocities [rad/s or m/s].
        M: (n, n) joint-space inertia.
        h: (n,) Coriolis, centrifugal and gravity torques: M vdot + h = tau.
        wrenches: sensor name -> (6,) wrench of the robot ON the environment,
            [force; moment], world axes, at the sensor [N, Nm].
        commanded: (n,) torques sent at the tick before [Nm or N]; None if unknown.
        data: Pinocchio's Data behind all this; do not write to it.
    """

    __slots__ = (
        "M", "_advanced", "_blocks", "_flat", "_frames", "_moved", "_still", "_zero",
        "commanded", "data", "dt", "h", "q", "robot", "t", "v", "wrenches",
    )  # fmt: skip

    def __init__(self, robot: Robot, dt: float) -> None:
        self.robot, self.dt = robot, dt
        self.data = robot.model.createData()
        self.M, self.h = self.data.M, self.data.nle
        self._zero = np.zeros(robot.nv)
        self._frames: dict[str, FrameState] = {}
        self._flat: dict[str, Array] = {}
        self._blocks: dict[str, Frames] = {}
        self._still: pin.Data | None = None
        self._advanced: dict[int, Array] = {}
        self.commanded: Array | None = None
        self._moved = False

    def refresh(
        self, q: Array, v: Array, t: float, wrenches: Mapping[str, Array] = NO_WRENCHES
    ) -> None:
        """Move to another instant; for the controller, which owns its State.

        Nothing is checked and nothing is copied: q and v must stay as they are.
        """
        model, data = self.robot.model, self.data
        self.q, self.v, self.t, self.wrenches = q, v, t, wrenches
        pin.crba(model, data, q, IN_WORLD)  # also computes the joints' Jacobian
        pin.nonLinearEffects(model, data, q, v)
        self._frames.clear()
        self._flat.clear()
        self._advanced.clear()
        self._moved = False

    def frame(self, name: str) -> FrameState:
        """Pose, Jacobian, twist and drift of a frame.

        Raises:
            UnknownName: the robot has no such frame.
        """
        try:
            known = self._frames.get(name)
        except TypeError:  # no name, and not even hashable
            raise UnknownName("frame", name, self.robot.frames) from None
        if known is None:
            known = self._frames[name] = self._compute(self.robot.frame_id(name))
        return known

    def flat(self, name: str) -> Array:
        """The same in one array (24 + 6 n,), as compiled code reads it (`wbc.frames`).

        It holds until the next instant, which overwrites it.

        Raises:
            UnknownName: the robot has no such frame.
        """
        known = self._flat.get(name)
        if known is None:
            block = self._blocks.get(name) or self._block(name)
            known = self._flat[name] = block.update()[0]
        return known

    def _block(self, name: str) -> Frames:
        robot = self.robot
        block = Frames(robot.model, self.data, [name], [robot.frame_id(name)])
        self._blocks[name] = block
        return block

    def position(self, name: str) -> Array:
        """Origin (3,) of a frame in the world [m]; cheap where no more is wanted.

        Raises:
            UnknownName: the robot has no such frame.
        """
        model, data = self.robot.model, self.data
        X_WF = pin.updateFramePlacement(model, data, self.robot.frame_id(name))
        return np.array(X_WF.translation)

    def jacobian(self, name: str) -> Array:
        """Jacobian (6, n) of a frame's twist, as in its `FrameState`; cheap likewise.

        Raises:
            UnknownName: the robot has no such frame.
        """
        return self._jacobian(self.robot.frame_id(name))

    def _jacobian(self, index: int) -> Array:
        model, data = self.robot.model, self.data
        pin.updateFramePlacement(model, data, index)
        J = pin.getFrameJacobian(model, data, index, WORLD_ALIGNED)
        return np.ascontiguousarray(J.reshape(6, model.nv))  # (6,) for a single column

    def wrench(self, sensor: str) -> Array:
        """Measured wrench (6,) of the robot on the environment, world axes.

        Raises:
            UnknownName: nothing was measured under that name.
        """
        try:
            return self.wrenches[sensor]
        except (KeyError, TypeError):
            raise UnknownName("force sensor", sensor, self.wrenches) from None

    def advanced(self, task: Task) -> Array:
        """Torques (n,) of the contact forces that a task counts on [Nm].

        The first to ask moves on what the task remembers: once at an instant, however
        many stacks it stands in.
        """
        known = self._advanced.get(id(task))
        if known is None:
            known = self._advanced[id(task)] = np.zeros(self.h.size)
            task.advance(self, known)
        return known

    def gravity(self) -> Array:
        """Gravity torques (n,) [Nm]."""
        model = self.robot.model
        if self._still is None:  # Pinocchio overwrites what frames are computed from
            self._still = model.createData()
        return np.array(pin.computeGeneralizedGravity(model, self._still, self.q))

    def _compute(self, index: int) -> FrameState:
        model, data = self.robot.model, self.data
        if not self._moved:
            pin.forwardKinematics(model, data, self.q, self.v, self._zero)
            self._moved = True
        J, X_WF = self._jacobian(index), data.oMf[index]
        drift = pin.getFrameClassicalAcceleration(model, data, index, WORLD_ALIGNED)
        return FrameState(
            np.array(X_WF.translation),
            np.array(X_WF.rotation),
            J @ self.v,
            drift.vector,
            J,
        )
