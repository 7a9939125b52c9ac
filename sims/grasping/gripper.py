"""The gripper's mechanism and its force control.

The controller of the arm sees a rigid tool (`robots/tools/gripper.xml`). The scene
makes the fingers slide, coupled as by rack and pinion, so that they meet in the middle
whatever pulls on the object; each is driven by a force and damped, so that it closes at
a bounded speed and then holds with exactly that force.
"""

from __future__ import annotations

from enum import Enum
from typing import Final, final

import mujoco
import numpy as np

from sims.cell import Cell
from wbc import InputError
from wbc.arrays import positive

__all__ = ["Grip", "Gripper", "add_fingers"]

JOINTS: Final = ("finger_left", "finger_right")
REFERENCE: Final = 0.010
"""Distance of a pad from the tcp in the tool's file [m]."""
OPENED: Final = 0.014
"""The same with the gripper open [m]."""
DAMPING: Final = 1000.0
"""Of a finger [N s/m]: 50 N close at 50 mm/s."""
STRONGEST: Final = 80.0
"""Largest force of a finger [N]."""
SPINDLE: Final = 0.5
"""Inertia of the drive, as a mass that moves with each finger [kg]."""
STIFFNESS: Final = 20000.0
"""Of opening to a width [N/m]."""
EMPTY: Final = 5e-4
"""A pad this near to the tcp has met nothing [m]."""
STILL: Final = 1e-3
"""Fingers slower than this have stopped [m/s]."""
PATIENCE: Final = 50
"""Ticks that a new command gets before fingers at rest count as having stopped."""


@final
class Grip(Enum):
    """What the fingers do."""

    OPEN = "open"
    MOVING = "moving"
    HOLDING = "holding"
    EMPTY = "closed on nothing"


def add_fingers(spec: mujoco.MjSpec) -> None:
    """Make the fingers of a mounted gripper slide, coupled and driven."""
    for name in JOINTS:
        spec.body(name).add_joint(
            name=name,
            type=mujoco.mjtJoint.mjJNT_SLIDE,
            axis=[1.0, 0.0, 0.0],
            ref=REFERENCE,
            limited=mujoco.mjtLimited.mjLIMITED_TRUE,
            range=[0.0, OPENED + 0.001],
            armature=SPINDLE,
            damping=[DAMPING, 0.0, 0.0],
        )
        motor = spec.add_actuator(
            name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT
        )
        motor.ctrllimited = mujoco.mjtLimited.mjLIMITED_TRUE
        motor.ctrlrange = [-STRONGEST, STRONGEST]
    rack = spec.add_equality(
        name="rack", type=mujoco.mjtEq.mjEQ_JOINT, name1=JOINTS[0], name2=JOINTS[1]
    )
    rack.objtype = mujoco.mjtObj.mjOBJ_JOINT
    rack.data[:5] = [0.0, 1.0, 0.0, 0.0, 0.0]
    rack.solref = [0.004, 1.0]


@final
class Gripper:
    """Closes with a force, opens to a width, and tells what it holds.

    Args:
        cell: whose scene went through `add_fingers`.
        force: that each finger closes with [N].

    Raises:
        InputError: the scene has no such fingers, or they are not that strong.
    """

    def __init__(self, cell: Cell, force: float = 50.0) -> None:
        self._data, m = cell.data, cell.model
        kinds = (mujoco.mjtObj.mjOBJ_JOINT, mujoco.mjtObj.mjOBJ_ACTUATOR)
        joints, motors = (
            [mujoco.mj_name2id(m, kind, name) for name in JOINTS] for kind in kinds
        )
        if min(*joints, *motors) < 0:
            raise InputError(f"cell '{cell.name}' has no gripper: use add_fingers.")
        self.force = positive(force, "force")
        if force > STRONGEST:
            raise InputError(f"force is {force} N; a finger has {STRONGEST} N at most.")
        self._qpos, self._dofs = m.jnt_qposadr[joints], m.jnt_dofadr[joints]
        self._motors = np.array(motors)
        self._wanted: float | None = OPENED
        self._ticks = 0
        self._data.qpos[self._qpos] = OPENED  # a fresh cell has them at the reference

    @property
    def gap(self) -> float:
        """Distance between the pads [m]."""
        return float(self._data.qpos[self._qpos].sum())

    @property
    def grip(self) -> Grip:
        """What the fingers do at this instant."""
        speed = float(np.abs(self._data.qvel[self._dofs]).max())
        if speed > STILL or self._ticks < PATIENCE:
            return Grip.MOVING
        if self._wanted is not None:
            return Grip.OPEN
        return Grip.EMPTY if self.gap < 2.0 * EMPTY else Grip.HOLDING

    def close(self) -> None:
        """Close with the force, from the next `update` on."""
        self._wanted, self._ticks = None, 0

    def open(self, width: float = 2.0 * OPENED) -> None:
        """Open to a width between the pads [m], from the next `update` on.

        Raises:
            InputError: not a width that the fingers can take.
        """
        half = 0.5 * positive(width, "width")
        if half > OPENED:
            raise InputError(
                f"width is {width * 1e3:.1f} mm; the gripper opens to "
                f"{2e3 * OPENED:.0f} mm at most."
            )
        self._wanted, self._ticks = half, 0

    def update(self) -> None:
        """Drive the fingers at this instant; once a tick."""
        self._ticks += 1
        push = np.full(2, -self.force)
        if self._wanted is not None:
            pull = STIFFNESS * (self._wanted - self._data.qpos[self._qpos])
            push = np.clip(pull, -self.force, self.force)
        self._data.ctrl[self._motors] = push
