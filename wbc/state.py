"""One instant of a robot, with everything that is derived from it."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from typing import TYPE_CHECKING, Any, TypeVar, final

import numpy as np
import pinocchio as pin

from wbc.arrays import Array
from wbc.errors import UnknownName

if TYPE_CHECKING:
    from wbc.robot import Robot

__all__ = ["FrameState", "State"]

Found = TypeVar("Found")

WORLD_ALIGNED = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
NO_WRENCHES: Mapping[str, Array] = {}


@final
class FrameState:
    """A frame F of the robot at one instant, seen from the world W.

    Attributes:
        p: (3,) p_WF, origin [m].
        R: (3, 3) R_WF.
        J: (6, n) Jacobian of the twist, [linear; angular], world axes at F's origin.
        V: (6,) twist V_WF = J v [m/s, rad/s].
        drift: (6,) dJ/dt v, the classical acceleration at zero joint acceleration.
    """

    __slots__ = ("J", "R", "V", "drift", "p")

    def __init__(self, p: Array, R: Array, J: Array, V: Array, drift: Array) -> None:
        self.p, self.R, self.J, self.V, self.drift = p, R, J, V, drift


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
            [force; moment], world axes [N, Nm].
    """

    __slots__ = (
        "M", "_data", "_frames", "_memory", "_zero", "dt", "h", "q", "robot", "t", "v",
        "wrenches",
    )  # fmt: skip

    def __init__(self, robot: Robot, dt: float) -> None:
        self.robot, self.dt = robot, dt
        self._data = robot.model.createData()
        self._zero = np.zeros(robot.nv)
        self._frames: dict[str, FrameState] = {}
        self._memory: dict[Hashable, Any] = {}

    def refresh(
        self, q: Array, v: Array, t: float, wrenches: Mapping[str, Array] = NO_WRENCHES
    ) -> None:
        """Move to another instant; for the controller, which owns its State.

        Nothing is checked and nothing is copied: q and v must stay as they are.
        """
        model, data = self.robot.model, self._data
        self.q, self.v, self.t, self.wrenches = q, v, t, wrenches
        self.M = pin.crba(model, data, q)
        self.h = pin.nonLinearEffects(model, data, q, v)
        pin.forwardKinematics(model, data, q, v, self._zero)
        pin.computeJointJacobians(model, data, q)
        self._frames.clear()
        self._memory.clear()

    def frame(self, name: str) -> FrameState:
        """Pose, Jacobian, twist and drift of a frame.

        Raises:
            UnknownName: the robot has no such frame.
        """
        known = self._frames.get(name)
        if known is None:
            known = self._frames[name] = self._compute(self.robot.frame_id(name))
        return known

    def remember(self, key: Hashable, make: Callable[[], Found]) -> Found:
        """What `make` gives, computed once at this instant for all who ask by `key`."""
        if key not in self._memory:
            self._memory[key] = make()
        found: Found = self._memory[key]
        return found

    def wrench(self, sensor: str) -> Array:
        """Measured wrench (6,) of the robot on the environment, world axes.

        Raises:
            UnknownName: nothing was measured under that name.
        """
        if sensor not in self.wrenches:
            raise UnknownName("force sensor", sensor, self.wrenches)
        return self.wrenches[sensor]

    def gravity(self) -> Array:
        """Gravity torques (n,) [Nm]."""
        return np.array(
            pin.computeGeneralizedGravity(self.robot.model, self._data, self.q)
        )

    def _compute(self, index: int) -> FrameState:
        model, data = self.robot.model, self._data
        X_WF = pin.updateFramePlacement(model, data, index)
        J = pin.getFrameJacobian(model, data, index, WORLD_ALIGNED)
        J = J.reshape(6, model.nv)  # the binding flattens a single column
        drift = pin.getFrameClassicalAcceleration(model, data, index, WORLD_ALIGNED)
        return FrameState(
            np.array(X_WF.translation),
            np.array(X_WF.rotation),
            J,
            J @ self.v,
            drift.vector,
        )
