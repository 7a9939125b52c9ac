"""What tasks on forces share: a frame, its axes, and the sensor that feels for it."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np
from numpy.typing import ArrayLike

from tasks.kernels.touch import FORCE, TARGET, TARGET_ROTATION
from tasks.target import POINT, UPRIGHT, take_target
from wbc import Robot, State, Task
from wbc.arrays import Array, rotation
from wbc.checks import text
from wbc.errors import InputError, SolverError
from wbc.settled import Settled

__all__ = ["TouchTask"]

AXES = ("x", "y", "z")


class TouchTask(Settled, Task):
    """A task on a frame F that feels the wrench of the robot on its surroundings.

    Its rows are the twist of F in task axes D: J_D = blockdiag(R, R)^T J, so that each
    is a direction of D, and a gain matrix R K R^T of the papers is one gain a row.

    Args:
        name: how reports call it.
        unit: of each row's error.
        frame: name of F.
        rows: 3 for the linear rows alone, 6 with the angular ones.
        numbers: how many its kernels read (`tasks.kernels.touch`).
        axes: (3, 3) R_WD; the world's by default.
        sensor: name of the force sensor in `State.wrenches`.
        sensor_frame: where it sits on the robot; its wrench is about this point.

    Raises:
        InputError: the axes are no rotation; at the first tick, the sensor is missing.
    """

    def __init__(
        self,
        name: str,
        unit: str,
        frame: str,
        rows: int,
        numbers: int,
        axes: ArrayLike | None,
        sensor: str,
        sensor_frame: str,
    ) -> None:
        self.sensor_frame = text(sensor_frame, f"sensor_frame of '{name}'")
        super().__init__(name, unit, (frame, sensor_frame))
        self.frame, self.sensor = frame, text(sensor, f"sensor of '{name}'")
        self.size = rows
        self._numbers, self._wrench = np.zeros(numbers), np.zeros(6)
        self._R = self._numbers[:TARGET].reshape(3, 3)
        self._target = self._numbers[TARGET:TARGET_ROTATION].reshape(3, 3)
        self._R_d = self._numbers[TARGET_ROTATION:FORCE].reshape(3, 3)
        self._force = self._numbers[FORCE : FORCE + rows]
        self._R[:] = self._R_d[:] = np.eye(3)
        self._heard = False
        if axes is not None:
            self.set_axes(axes)

    def _aim(
        self, target: ArrayLike, velocity: ArrayLike, acceleration: ArrayLike
    ) -> None:
        """Move p_d, its velocity and acceleration, (3,) in the world."""
        given = (target, UPRIGHT, velocity, acceleration)
        take_target(self.name, POINT, given, self._target.reshape(9))

    def set_axes(self, axes: ArrayLike) -> None:
        """Turn the task axes D: (3, 3) R_WD; they count as fixed during a tick.

        Raises:
            InputError: no rotation; the axes stay as they were.
        """
        self._R[:] = rotation(axes, f"axes of '{self.name}'")

    @property
    def axes(self) -> Array:
        """R_WD, (3, 3)."""
        return self._R.copy()

    @property
    def target(self) -> Array:
        """Where F's origin should be in the directions that move, (3,) [m]."""
        return np.array(self._target[0])

    @property
    def orientation(self) -> Array:
        """R_d, (3, 3); the identity where three rows do not turn."""
        return self._R_d.copy()

    @property
    def force(self) -> Array:
        """What F should exert, in D, one number a row [N, Nm]."""
        return self._force.copy()

    def row_names(self, robot: Robot) -> tuple[str, ...]:
        """Linear directions, then angular ones."""
        del robot
        kinds = ("p", "R")[: self.size // 3]
        return tuple(f"{kind} {axis}" for kind in kinds for axis in AXES)

    def wish_units(self, rows: int) -> tuple[str, ...]:
        """All rows are accelerations, those that press too."""
        return (("m/s^2",) * 3 + ("rad/s^2",) * 3)[:rows]

    @abstractmethod
    def reset(self) -> None:
        """Forget what was remembered of earlier ticks."""

    def _listen(self, state: State) -> None:
        """Take the measured wrench (6,) of the robot ON its surroundings.

        Raises:
            InputError: the sensor never was there.
            SolverError: it fell silent, so that the controller holds the robot.
        """
        measured = state.wrenches.get(self.sensor)
        if measured is None and self._heard:
            raise SolverError(f"force sensor '{self.sensor}' fell silent.")
        if measured is None:
            known = ", ".join(state.wrenches) or "(none)"
            raise InputError(
                f"task '{self.name}' needs force sensor '{self.sensor}', but the "
                f"controller was told of: {known}. Pass wrenches={{'{self.sensor}': "
                "...}, or name another one with sensor=..."
            )
        self._heard = True
        self._wrench[:] = measured
