"""The pose of a blade that cuts: tip on a moving point, blade along its path."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.base import CatalogueTask, run_kernel
from tasks.evaluator import Code
from tasks.kernels.touch import press
from tasks.target import POSE, STILL, take_target
from wbc import PD, Kernel, Robot, Rows, State
from wbc.arrays import Array
from wbc.checks import flag, named, text
from wbc.errors import UnknownName
from wbc.kernel import NO_TABLE

__all__ = ["KnifePose"]

NORMAL, ACROSS, DOWN = (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)


@final
class KnifePose(CatalogueTask):
    """A blade's tip at p_d and its orientation R_d, against what it cuts.

    Computed torque as in P0 eqs. (15)-(17), mended: the measured wrench h of the knife
    on its surroundings enters as J^T h, without which cutting forces push the knife
    off by h / (Lambda kp). Blade frame: z from handle to tip, edge along -x, flat sides
    across y.

    Args:
        frame: name of the frame at the tip.
        position: (3,) p_d [m].
        orientation: (3, 3) R_d.
        rocking: leave the rotation about the blade's normal y free: two rows keep the
            flat of the blade where it should be, instead of three.
        sensor: name of the force sensor; None for no compensation.
        sensor_frame: where it sits on the robot; its wrench is about this point.
        stiffness: [1/s^2], one number or one a row.
        damping: [1/s], critical by default.
        name: "<frame> knife pose" by default.

    Raises:
        InputError: unusable target or gains.
        UnknownName: at the first tick, the sensor is missing.
    """

    code = Code.POSE

    def __init__(
        self,
        frame: str,
        position: ArrayLike,
        orientation: ArrayLike,
        *,
        rocking: bool = False,
        sensor: str | None = None,
        sensor_frame: str = "wrist_sensor",
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        flag(rocking=rocking)
        name = named(name, f"{frame} knife pose")
        turned = ("tilt 1", "tilt 2") if rocking else ("R x", "R y", "R z")
        rows = ("p x", "p y", "p z", *turned)
        law = PD(stiffness, damping)
        super().__init__(name, "m, rad", rows, law, (frame,))
        self.rocking = rocking
        self.sensor = None if sensor is None else text(sensor, f"sensor of '{name}'")
        self.sensor_frame = text(sensor_frame, f"sensor_frame of '{name}'")
        self._parameters, self._wrench = np.zeros(24), np.zeros(6)
        self._axis = np.concatenate([NORMAL, ACROSS, DOWN, np.zeros(9)])
        self.set_target(position, orientation)

    def set_target(
        self,
        position: ArrayLike,
        orientation: ArrayLike,
        twist: ArrayLike = STILL,
        acceleration: ArrayLike = STILL,
    ) -> None:
        """Move the target; twist and its derivative are [linear; angular], world axes.

        Raises:
            InputError: unusable values; the target stays as it was.
        """
        given = (position, orientation, twist, acceleration)
        p = self._parameters
        take_target(self.name, POSE, given, p)
        if self.rocking:
            axis = self._axis
            axis[9:12], axis[12:15], axis[15:] = p[10:18:3], p[18:21], p[21:24]

    def parameters(self, robot: Robot) -> Array:
        """Those of `FramePose`, live."""
        del robot
        return self._parameters

    def check(self, robot: Robot) -> None:
        """Both frames exist."""
        super().check(robot)
        if self.sensor is not None:
            robot.frame_id(self.sensor_frame)

    def kernel(self, robot: Robot) -> Kernel | None:
        """The compiled half; none for a rocking blade, with its rows of two kernels."""
        return None if self.rocking else super().kernel(robot)

    def evaluate(self, state: State, out: Rows) -> None:
        """Write the rows."""
        F = state.flat(self.frames[0])
        p = self._parameters
        if not self.rocking:
            run_kernel(Code.POSE, p, NO_TABLE, F, state, out)
            return
        upper, lower = _part(out, 0, 3), _part(out, 3, 5)
        run_kernel(Code.ON_POINT, p[:9], NO_TABLE, F, state, upper)
        run_kernel(Code.ALONG, self._axis, NO_TABLE, F, state, lower)

    def advance(self, state: State, torque: Array) -> None:
        """Count on the measured wrench: add J^T h."""
        if self.sensor is None:
            return
        measured = state.wrenches.get(self.sensor)
        if measured is None:
            raise UnknownName("force sensor", self.sensor, state.wrenches)
        self._wrench[:] = measured
        press(state.flat(self.sensor_frame), self._wrench, torque)


def _part(rows: Rows, begin: int, end: int) -> Rows:
    return Rows(*(array[begin:end] for array in rows))
