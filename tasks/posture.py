"""Tasks in joint space: a posture, and damping."""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.base import CatalogueTask
from tasks.evaluator import Code
from tasks.locking import listed_joints
from wbc import PD, Damper, Robot
from wbc.arrays import Array, IntArray, frozen, numbers
from wbc.errors import InputError
from wbc.kernel import NO_TABLE

__all__ = ["Damping", "Posture"]


@final
class Posture(CatalogueTask):
    """Joints at a target: e = q - q_d [rad or m], one row a joint.

    Args:
        target: (n,), or (k,) for k named joints; the robot's home by default.
        joints: names of the joints; all by default.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "posture" by default.

    Raises:
        InputError: a target that is not finite, unusable gains; at binding, a target
            of the wrong size for the robot.
    """

    code = Code.AT_TARGET

    def __init__(
        self,
        target: ArrayLike | None = None,
        *,
        joints: Sequence[str] | None = None,
        stiffness: ArrayLike = 25.0,
        damping: ArrayLike | None = None,
        name: str = "posture",
    ) -> None:
        super().__init__(name, "rad", (), PD(stiffness, damping))
        self.joints = listed_joints(joints, name)
        self._target: Array | None = None
        self._bound: list[weakref.ref[Array]] = []
        if target is not None:
            self.set_target(target)

    def set_target(self, target: ArrayLike) -> None:
        """Change the target, also for the stacks that the task stands in already.

        Raises:
            InputError: not finite, or not as long as before; the target stays.
        """
        in_use = [a for a in (ref() for ref in self._bound) if a is not None]
        known = in_use if self._target is None else [self._target, *in_use]
        given = numbers(target, f"target of '{self.name}'")
        shape = known[0].shape if known else given.shape
        if len(shape) != 1 or shape == (0,):
            raise InputError(f"target of '{self.name}' must be of shape (n,).")
        checked = frozen(given, shape, f"target of '{self.name}'")
        if any(array.shape != shape for array in known):
            raise InputError(
                f"'{self.name}' stands in stacks of different robots: give each one."
            )
        self._target = checked
        for array in in_use:
            array[:] = checked

    def row_names(self, robot: Robot) -> tuple[str, ...]:
        """The joints' names."""
        return robot.joint_names if self.joints is None else self.joints

    def check(self, robot: Robot) -> None:
        """Joints exist and the target has one value for each."""
        for joint in self.joints or ():
            robot.joint_index(joint)
        super().check(robot)
        count = len(self.row_names(robot))
        if self._target is not None and self._target.size != count:
            raise InputError(
                f"target of '{self.name}' has {self._target.size} values, but robot "
                f"'{robot.name}' needs {count}: was it made for another robot?"
            )

    def parameters(self, robot: Robot) -> Array:
        """The target; the robot's home while none was given."""
        if self._target is not None:
            return self._target
        return robot.q_home[_indices(robot, self.joints)]

    def live_parameters(self, robot: Robot) -> Array:
        """A copy for one stack, which `set_target` follows as long as it is in use."""
        live = self.parameters(robot).copy()
        self._bound = [ref for ref in self._bound if ref() is not None]
        self._bound.append(weakref.ref(live))
        return live

    def table(self, robot: Robot) -> Array:
        """Indices of the joints."""
        return np.array(_indices(robot, self.joints), dtype=np.float64)

    def joint_indices(self, robot: Robot) -> IntArray:
        """Of its rows."""
        return np.array(_indices(robot, self.joints))


@final
class Damping(CatalogueTask):
    """Joint velocities that should vanish, one row a joint [rad/s or m/s].

    Args:
        rate: how fast they do [1/s].
        joints: names of the joints; all by default.
        name: "damping" by default.

    Raises:
        InputError: the rate is negative or not finite.
    """

    code = Code.AT_REST

    def __init__(
        self,
        rate: ArrayLike = 5.0,
        *,
        joints: Sequence[str] | None = None,
        name: str = "damping",
    ) -> None:
        super().__init__(name, "rad/s", (), Damper(rate))
        self.joints = listed_joints(joints, name)

    def row_names(self, robot: Robot) -> tuple[str, ...]:
        """The joints' names."""
        return robot.joint_names if self.joints is None else self.joints

    def check(self, robot: Robot) -> None:
        """Joints exist."""
        for joint in self.joints or ():
            robot.joint_index(joint)
        super().check(robot)

    def parameters(self, robot: Robot) -> Array:
        """None."""
        del robot
        return NO_TABLE

    def table(self, robot: Robot) -> Array:
        """Indices of the joints."""
        return np.array(_indices(robot, self.joints), dtype=np.float64)

    def joint_indices(self, robot: Robot) -> IntArray:
        """Of its rows."""
        return np.array(_indices(robot, self.joints))


def _indices(robot: Robot, joints: tuple[str, ...] | None) -> list[int]:
    every = robot.joint_names
    return [every.index(joint) for joint in (every if joints is None else joints)]
