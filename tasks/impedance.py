"""A point that gives way to forces: by torque (impedance) or by moving (admittance)."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.kernels.compliance import (
    FOLLOWING,
    GAINS,
    MEMORY,
    SIZE,
    admittance,
    give_way,
    impedance,
)
from tasks.kernels.touch import press
from tasks.touch import TouchTask
from wbc import PD, Rows, State
from wbc.arrays import Array, frozen, numbers, positive
from wbc.checks import named
from wbc.errors import InputError, shown

__all__ = ["Admittance", "Impedance"]

STILL = np.zeros(3)


class _Compliant(TouchTask):
    """What the two share: a mass, a damper and a spring to a moving target."""

    def __init__(
        self,
        frame: str,
        target: ArrayLike,
        force: ArrayLike,
        gains: tuple[ArrayLike, ArrayLike, ArrayLike | None],
        axes: ArrayLike | None,
        sensor: str,
        sensor_frame: str,
        name: str,
    ) -> None:
        super().__init__(name, "m", frame, 3, SIZE, axes, sensor, sensor_frame)
        mass, stiffness, damping = gains
        self.mass = _gain(mass, f"mass of '{name}'", zero=False)
        self.stiffness = _gain(stiffness, f"stiffness of '{name}'")
        critical = 2.0 * np.sqrt(self.mass * self.stiffness)
        given = critical if damping is None else damping
        self.damping = _gain(given, f"damping of '{name}'")
        settled = np.concatenate([self.mass, self.stiffness, self.damping])
        self._numbers[GAINS : GAINS + 9] = settled
        self.set_target(target)
        self.set_force(force)

    def set_target(
        self,
        target: ArrayLike,
        velocity: ArrayLike = STILL,
        acceleration: ArrayLike = STILL,
    ) -> None:
        """Move x_d: position [m], velocity, acceleration, (3,) in the world.

        Raises:
            InputError: unusable values; the target stays as it was.
        """
        self._aim(target, velocity, acceleration)

    def set_force(self, force: ArrayLike) -> None:
        """Change h_d (3,) in D, robot on environment [N].

        Raises:
            InputError: not of shape (3,) or not finite; the force stays as it was.
        """
        self._force[:] = frozen(force, (3,), f"force of '{self.name}'")

    def reset(self) -> None:
        """Nothing is remembered."""


@final
class Impedance(_Compliant):
    """A frame's origin behaves as a mass on a spring and a damper (Hogan 1985).

    Md (xdd - xdd_d) + Kd (xd - xd_d) + Kp (x - x_d) = h_d - h with h the measured force
    of the robot on its surroundings: P0 eq. (20), mended. Its J^T h is added to the
    torques, without which the surroundings would be felt twice. Where h_d should be
    exerted exactly, Kp must be 0. Against stiff surroundings Md must not be far below
    the robot's own mass at F, or the sensor's delay makes it ring.

    Args:
        frame: name of the robot's frame.
        target: (3,) x_d [m].
        mass: Md [kg], one number or one for each axis of D.
        stiffness: Kp [N/m].
        damping: Kd [N s/m]; critical, 2 sqrt(Md Kp), by default.
        force: (3,) h_d in D [N]; none by default.
        axes: (3, 3) R_WD; the world's by default.
        sensor: name of the force sensor.
        sensor_frame: where it sits on the robot.
        name: "<frame> impedance" by default.

    Raises:
        InputError: unusable values; at the first tick, no such sensor.
    """

    def __init__(
        self,
        frame: str,
        target: ArrayLike,
        *,
        mass: ArrayLike = 10.0,
        stiffness: ArrayLike = 500.0,
        damping: ArrayLike | None = None,
        force: ArrayLike = STILL,
        axes: ArrayLike | None = None,
        sensor: str = "wrist",
        sensor_frame: str = "wrist_sensor",
        name: str | None = None,
    ) -> None:
        gains = (mass, stiffness, damping)
        name = named(name, f"{frame} impedance")
        super().__init__(frame, target, force, gains, axes, sensor, sensor_frame, name)
        self.claims = (f"force of sensor '{sensor}'", f"moment of sensor '{sensor}'")
        self._felt = np.zeros(6)

    def update(self, state: State, rows: Rows) -> None:
        """Write the rows."""
        self._listen(state)
        F, S = state.flat(self.frame), state.flat(self.sensor_frame)
        impedance(self._numbers, F, S, self._wrench, self._felt, rows)

    def advance(self, state: State, torque: Array) -> None:
        """Add J^T h to the torques."""
        press(state.flat(self.frame), self._felt, torque)


@final
class Admittance(_Compliant):
    """A frame's origin follows a reference that gives way to the measured force.

    The reference x_c obeys the impedance's equation and is integrated once a tick; a
    stiff PD follows it. Rather than by torques the robot complies by moving, which
    suits arms with much friction; it must not be faster than the PD. Light masses ring
    as those of `Impedance` do.

    Args:
        frame: name of the robot's frame.
        target: (3,) x_d [m].
        mass: Md [kg], one number or one for each axis of D.
        stiffness: Kp [N/m].
        damping: Kd [N s/m]; critical, 2 sqrt(Md Kp), by default.
        force: (3,) h_d in D [N]; none by default.
        following: stiffness of the PD that follows x_c [1/s^2].
        axes: (3, 3) R_WD; the world's by default.
        sensor: name of the force sensor.
        sensor_frame: where it sits on the robot.
        name: "<frame> admittance" by default.

    Raises:
        InputError: unusable values; at the first tick, no such sensor.
    """

    def __init__(
        self,
        frame: str,
        target: ArrayLike,
        *,
        mass: ArrayLike = 10.0,
        stiffness: ArrayLike = 500.0,
        damping: ArrayLike | None = None,
        force: ArrayLike = STILL,
        following: float = 2500.0,
        axes: ArrayLike | None = None,
        sensor: str = "wrist",
        sensor_frame: str = "wrist_sensor",
        name: str | None = None,
    ) -> None:
        gains = (mass, stiffness, damping)
        name = named(name, f"{frame} admittance")
        super().__init__(frame, target, force, gains, axes, sensor, sensor_frame, name)
        self.following = PD(positive(following, "following"))
        self._numbers[FOLLOWING : FOLLOWING + 3] = self.following.stiffness
        self._numbers[FOLLOWING + 3 : FOLLOWING + 6] = self.following.damping
        self._memory = np.zeros(MEMORY)

    def reset(self) -> None:
        """Let the reference start from where the robot is at the next tick."""
        self._memory[:] = 0.0

    def update(self, state: State, rows: Rows) -> None:
        """Write the rows."""
        self._listen(state)
        F = state.flat(self.frame)
        admittance(self._numbers, F, self._wrench, self._memory, rows)

    def advance(self, state: State, torque: Array) -> None:
        """Move the reference on by one tick; not by what is not finite."""
        del torque
        give_way(self._numbers, self._memory, state.dt)


def _gain(value: ArrayLike, what: str, *, zero: bool = True) -> Array:
    """One number an axis (3,)."""
    given = numbers(value, what)
    if given.shape not in ((), (3,)):
        raise InputError(f"{what} must be one number, or three, got {shown(value)}.")
    gain = frozen(np.broadcast_to(given, (3,)), (3,), what)
    if (gain < 0.0).any() or (not zero and (gain == 0.0).any()):
        raise InputError(f"{what} must be {'at least' if zero else 'above'} 0.")
    return gain
