"""The cutting cell: two arms, the meat between them, one simulated world."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, final

import mujoco
import numpy as np

from sims.cell import Observation
from sims.cutting.layout import CUTTER, GRIP, PULLER, TIP
from sims.joints import find_joints, find_motors
from sims.mismatch import Mismatch
from sims.sensors import Encoders
from sims.wrist import WristSensor
from wbc import Robot
from wbc.arrays import Array

__all__ = ["ArmView", "CuttingCell"]


@final
class ArmView:
    """What one controller sees and moves of the cell: an arm, or both as one robot.

    Args:
        robot: the controller's model.
        model: the world.
        data: its state.
        wrists: force sensors that it reads.
        encoders: joint sensors.

    Raises:
        InputError: a joint of the robot is not in the scene, or has no motor.
    """

    def __init__(
        self,
        robot: Robot,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        wrists: Sequence[WristSensor],
        encoders: Encoders,
    ) -> None:
        self.name, self.robot, self.model, self.data = robot.name, robot, model, data
        joints = find_joints(model, robot.joint_names)
        self.qpos = model.jnt_qposadr[joints]
        self.dofs = model.jnt_dofadr[joints]
        self._motors = find_motors(model, joints)
        self._wrists, self._encoders = tuple(wrists), encoders

    def observe(self, wrenches: dict[str, Array]) -> Observation:
        """Joint readings of this instant, with what the wrists felt."""
        d = self.data
        q, v = self._encoders.read(d.qpos[self.qpos], d.qvel[self.dofs])
        own = {wrist.name: wrenches[wrist.name] for wrist in self._wrists}
        return Observation(d.time, q, v, own)

    def apply(self, torque: Array) -> None:
        """Set the motors' torques (n,) [Nm]."""
        self.data.ctrl[self._motors] = torque

    def restart(self) -> None:
        """Forget earlier readings."""
        self._encoders.reset()

    @property
    def truth(self) -> tuple[Array, Array]:
        """Real positions and velocities (n,)."""
        return self.data.qpos[self.qpos], self.data.qvel[self.dofs]


@final
class CuttingCell:
    """The world and its two arms.

    Args:
        spec: the scene with both arms.
        robots: what controllers know: the two arms, or one robot of both.
        tissue: makes the meat's process of (model, data).
        mismatch: how the simulated arms differ from the models; None for not at all.
    """

    def __init__(
        self,
        spec: mujoco.MjSpec,
        robots: Sequence[Robot],
        tissue: Any,
        *,
        mismatch: Mismatch | None = None,
    ) -> None:
        self.name = "cutting"
        self.wrists = [
            WristSensor(f"{arm}_wrist_sensor", name=arm) for arm in (CUTTER, PULLER)
        ]
        for wrist in self.wrists:
            wrist.mount(spec)
        self.model = spec.compile()
        for wrist in self.wrists:
            wrist.bind(self.model)
        self.data = mujoco.MjData(self.model)
        self.views = [
            ArmView(robot, self.model, self.data, self._sensors_of(robot), Encoders())
            for robot in robots
        ]
        if mismatch is not None:
            dofs = np.concatenate([view.dofs for view in self.views])
            limits = np.concatenate([robot.tau_max for robot in robots])
            mismatch.apply(self.model, dofs, limits)
        self.tissue = tissue(self.model, self.data)
        self._tip, self._grip = self._site(TIP), self._site(GRIP)
        self.wrenches: dict[str, Array] = {}

    def _sensors_of(self, robot: Robot) -> list[WristSensor]:
        return [w for w in self.wrists if w.site in robot.frames]

    def _site(self, name: str) -> int:
        return int(self.model.site(name).id)

    @property
    def tip(self) -> Array:
        """True position (3,) of the knife's tip [m]."""
        return self.data.site_xpos[self._tip].copy()

    @property
    def grip(self) -> Array:
        """True position (3,) of the grip [m]."""
        return self.data.site_xpos[self._grip].copy()

    @property
    def knife_orientation(self) -> Array:
        """True orientation (3, 3) of the knife."""
        return self.data.site_xmat[self._tip].reshape(3, 3).copy()

    def reset(self, postures: dict[str, Array]) -> None:
        """All at rest, joints by name of their robot, motors carrying the weight."""
        m, d = self.model, self.data
        mujoco.mj_resetData(m, d)
        for view in self.views:
            d.qpos[view.qpos] = postures[view.name]
            view.restart()
        self.tissue.reset()
        mujoco.mj_forward(m, d)
        for view in self.views:
            view.apply(d.qfrc_bias[view.dofs])
        mujoco.mj_forward(m, d)
        for wrist in self.wrists:
            wrist.reset(d)
        self._enter(self.tip)

    def observe(self) -> list[Observation]:
        """What every view sees now."""
        return [view.observe(self.wrenches) for view in self.views]

    def apply(self, torques: Sequence[Array]) -> None:
        """Set the motors' torques, one array a view."""
        for view, torque in zip(self.views, torques, strict=True):
            view.apply(torque)

    def step(self) -> None:
        """Finish the time step and begin the next one."""
        mujoco.mj_step2(self.model, self.data)
        self._enter(self.data.site_xpos[self._tip].copy())

    def _enter(self, before: Array) -> None:
        """Begin a step: kinematics, then what the meat does to the knife and itself."""
        mujoco.mj_step1(self.model, self.data)
        self.tissue.apply(self.data, before, self.tip)
        self.wrenches = {wrist.name: wrist.read(self.data) for wrist in self.wrists}
