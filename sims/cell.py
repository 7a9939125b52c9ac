"""A cell: robots, their surroundings and sensors, behind four verbs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import final

import mujoco

from sims.joints import find_joints, find_motors
from sims.mismatch import Mismatch
from sims.sensors import Encoders
from sims.wrist import WristSensor
from wbc import Robot
from wbc.arrays import Array
from wbc.checks import expect, text

__all__ = ["ArmCell", "Cell", "Observation"]


@final
@dataclass(frozen=True, slots=True, eq=False)
class Observation:
    """What the controller gets to see.

    Attributes:
        t: time [s].
        q: (n,) measured positions [rad].
        v: (n,) measured velocities [rad/s].
        wrenches: sensor name -> (6,) robot on environment, world axes at the sensor
            [N, Nm].
    """

    t: float
    q: Array
    v: Array
    wrenches: dict[str, Array] = field(default_factory=dict)


class Cell(ABC):
    """A simulated work-cell; the loop is observe, apply, step.

    Attributes:
        name: what reports call it.
        robot: the controller's model of the robot.
        model: the simulated world, which may differ from it.
        data: its state.
        wrists: its force sensors; none unless it says so.
    """

    name: str
    robot: Robot
    model: mujoco.MjModel
    data: mujoco.MjData
    wrists: Sequence[WristSensor] = ()

    @abstractmethod
    def reset(self, q: Array) -> None:
        """Put the robot at rest at q (n,), time 0."""

    @abstractmethod
    def observe(self) -> Observation:
        """Sensor readings of this instant."""

    @abstractmethod
    def apply(self, torque: Array) -> None:
        """Set the motors' torques (n,) [Nm]."""

    @abstractmethod
    def step(self) -> None:
        """Move on by one time step."""


@final
class ArmCell(Cell):
    """One arm in a scene that it was compiled into.

    Args:
        name: what reports call it.
        robot: the controller's model.
        spec: the scene with the arm in it, joints named as in the robot.
        mismatch: how the simulated arm differs from the model; None for not at all.
        encoders: what the joint sensors add; perfect ones by default.
        wrist: a force/torque sensor; none by default.

    Raises:
        InputError: a joint of the robot is missing in the scene, or has no motor; an
            argument is of the wrong kind.
        UnknownName: the site of the force/torque sensor is missing.
    """

    def __init__(
        self,
        name: str,
        robot: Robot,
        spec: mujoco.MjSpec,
        *,
        mismatch: Mismatch | None = None,
        encoders: Encoders | None = None,
        wrist: WristSensor | None = None,
    ) -> None:
        expect(Robot, robot=robot)
        expect(mujoco.MjSpec, spec=spec)
        expect(Mismatch | None, mismatch=mismatch)
        expect(Encoders | None, encoders=encoders)
        expect(WristSensor | None, wrist=wrist)
        self.name, self.robot, self._wrist = text(name, "name"), robot, wrist
        if wrist is not None:
            self.wrists = (wrist,)
            wrist.mount(spec)
        self.model = spec.compile()
        self._joints = find_joints(self.model, robot.joint_names)
        self._motors = find_motors(self.model, self._joints)
        self._qpos = self.model.jnt_qposadr[self._joints]
        self._dofs = self.model.jnt_dofadr[self._joints]
        if wrist is not None:
            wrist.bind(self.model)  # the nominal tool, whatever is simulated
        if mismatch is not None:
            mismatch.apply(self.model, self._dofs, robot.tau_max)
        self.data = mujoco.MjData(self.model)
        self._encoders = Encoders() if encoders is None else encoders
        self.reset(robot.q_home)

    def reset(self, q: Array) -> None:
        """Put the arm at rest at q (n,), time 0."""
        mujoco.mj_resetData(self.model, self.data)
        self.data.qpos[self._qpos] = q
        self._encoders.reset()
        if self._wrist is not None:
            self._hold()
            self._wrist.reset(self.data)
        mujoco.mj_step1(self.model, self.data)

    def _hold(self) -> None:
        """Let the motors carry the arm's weight, so that sensors feel it at rest."""
        mujoco.mj_forward(self.model, self.data)
        self.apply(self.data.qfrc_bias[self._dofs])
        mujoco.mj_forward(self.model, self.data)

    def observe(self) -> Observation:
        """Joint readings of this instant, and the wrench of the one before."""
        d = self.data
        q, v = self._encoders.read(d.qpos[self._qpos], d.qvel[self._dofs])
        if self._wrist is None:
            return Observation(d.time, q, v)
        return Observation(d.time, q, v, {self._wrist.name: self._wrist.read(d)})

    def apply(self, torque: Array) -> None:
        """Set the motors' torques (n,) [Nm]."""
        self.data.ctrl[self._motors] = torque

    def step(self) -> None:
        """Finish the time step with the applied torques and begin the next one."""
        mujoco.mj_step2(self.model, self.data)
        mujoco.mj_step1(self.model, self.data)

    @property
    def truth(self) -> tuple[Array, Array]:
        """Real positions and velocities (n,) of the arm."""
        return self.data.qpos[self._qpos], self.data.qvel[self._dofs]
