"""A frame that no joint moves: a conveyor, a turntable, a tracked work-piece."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from wbc.arrays import Array, frozen, number, rotation
from wbc.checks import expect, text
from wbc.errors import InputError
from wbc.relative import MOVING_SIZE

__all__ = ["FrameMotion", "MovingFrame"]

ORIGIN = (0.0, 0.0, 0.0)
STILL = (0.0,) * 6
UPRIGHT = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@final
@dataclass(frozen=True, slots=True, eq=False)
class FrameMotion:
    """Where a frame is and how it moves, at one instant.

    Attributes:
        position: (3,) of its origin in the world [m].
        orientation: (3, 3) rotation, its axes in the world.
        twist: (6,) [linear; angular], world axes at its origin [m/s, rad/s].
        acceleration: (6,) derivative of the twist, likewise.
    """

    position: ArrayLike = ORIGIN
    orientation: ArrayLike = UPRIGHT
    twist: ArrayLike = STILL
    acceleration: ArrayLike = STILL


@final
class MovingFrame:
    """A frame that features can be attached to and that moves as it is told.

    Three ways to tell it: `set` at every tick, from a tracker; `steady` for a conveyor
    or a turntable; or a function of time. Velocity and acceleration enter the rate and
    the drift of every constraint on its features. The first two stay compiled; a
    function of time makes its constraints plain Python.

    Args:
        motion: where it is; or a function of time [s] that says so. At rest at the
            origin by default.
        name: how reports call it.

    Raises:
        InputError: a motion of wrong shapes, not finite, or no rotation.
    """

    def __init__(
        self,
        motion: FrameMotion | Callable[[float], FrameMotion] | None = None,
        *,
        name: str = "moving frame",
    ) -> None:
        self.name = text(name, "name of a MovingFrame")
        self.block = np.zeros(MOVING_SIZE)
        self.motion = motion if callable(motion) else None
        given = FrameMotion() if motion is None else motion
        first = given(0.0) if callable(given) else given
        expect(FrameMotion, **{f"motion of '{name}'": first})
        self._write(first)

    @classmethod
    def steady(
        cls,
        velocity: ArrayLike = ORIGIN,
        *,
        spin: ArrayLike = ORIGIN,
        acceleration: ArrayLike = ORIGIN,
        position: ArrayLike = ORIGIN,
        orientation: ArrayLike = UPRIGHT,
        start: float = 0.0,
        name: str = "conveyor",
    ) -> MovingFrame:
        """A frame of constant acceleration and constant angular velocity.

        Args:
            velocity: (3,) at `start` [m/s].
            spin: (3,) angular velocity [rad/s].
            acceleration: (3,) of its origin [m/s^2].
            position: (3,) of its origin at `start` [m].
            orientation: (3, 3) its axes at `start`.
            start: time [s] of these; the motion goes on before and after it.
            name: how reports call it.

        Raises:
            InputError: wrong shapes, not finite, or no rotation.
        """
        frame = cls(name=name)
        v, omega = frozen(velocity, (3,), "velocity"), frozen(spin, (3,), "spin")
        a = frozen(acceleration, (3,), "acceleration")
        twist, change = np.concatenate([v, omega]), np.concatenate([a, np.zeros(3)])
        frame._write(FrameMotion(position, orientation, twist, change))
        frame.block[24] = number(start, "start")
        frame.block[25] = 1.0
        return frame

    def set(
        self,
        position: ArrayLike = ORIGIN,
        orientation: ArrayLike = UPRIGHT,
        twist: ArrayLike = STILL,
        acceleration: ArrayLike = STILL,
    ) -> None:
        """Say where the frame is now; arguments as for `FrameMotion`.

        Raises:
            InputError: unusable values, or a function of time moves the frame; it
                stays where it was.
        """
        if self.motion is not None:
            raise InputError(
                f"'{self.name}' follows a function of time: do not set it."
            )
        self._write(FrameMotion(position, orientation, twist, acceleration))

    def follow(self, t: float) -> None:
        """Go where its function of time, if it has one, wants it at t [s].

        Raises:
            InputError: the function gave unusable values.
        """
        if self.motion is not None:
            self._write(self.motion(t))

    def _write(self, motion: FrameMotion) -> None:
        p = frozen(motion.position, (3,), f"position of '{self.name}'")
        R = rotation(motion.orientation, f"orientation of '{self.name}'")
        V = frozen(motion.twist, (6,), f"twist of '{self.name}'")
        A = frozen(motion.acceleration, (6,), f"acceleration of '{self.name}'")
        block: Array = np.concatenate([p, R.ravel(), V, A, [0.0, 0.0]])
        self.block[:] = block

    def __repr__(self) -> str:
        return f"MovingFrame('{self.name}')"
