"""Tasks along a path: stay on it, travel at a speed, keep an axis at its angles."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.base import CatalogueTask
from tasks.evaluator import Code
from tasks.path import Path, still
from wbc import PD, Damper, Robot
from wbc.arrays import Array, number, positive
from wbc.binding import announce
from wbc.checks import named
from wbc.errors import InputError
from wbc.kernel import NO_TABLE

__all__ = ["PointOnCurve", "TravelSpeed"]


@final
class PointOnCurve(CatalogueTask):
    """Origin of a frame on a curve, two rows across it [m]; along it is free.

    With s the position of the nearest point, e_i = n_i(s) . (p - c(s)); s moves with
    the robot, so Jacobian and drift contain its motion.

    Args:
        frame: name of the robot's frame.
        curve: any path.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: "<frame> on curve" by default.

    Raises:
        InputError: unusable gains.
    """

    code = Code.ON_CURVE

    def __init__(
        self,
        frame: str,
        curve: Path,
        *,
        stiffness: ArrayLike = 100.0,
        damping: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        law = PD(stiffness, damping)
        rows = ("across 1", "across 2")
        super().__init__(named(name, f"{frame} on curve"), "m", rows, law, (frame,))
        self.curve = still(curve, self.name)

    def parameters(self, robot: Robot) -> Array:
        """None."""
        del robot
        return NO_TABLE

    def table(self, robot: Robot) -> Array:
        """The curve."""
        del robot
        return self.curve.table


@final
class TravelSpeed(CatalogueTask):
    """Speed along a path, one row [m/s]: ds/dt = v_ref(t, s).

    v_ref rises smoothly in time from `start` on and falls smoothly in space towards
    `end`, where the frame comes to rest: v_ref = speed * rise(t) * fall(end - s).
    Put back beyond the end, it creeps back.

    Args:
        frame: name of the robot's frame.
        path: what it travels along, in the direction of growing s.
        speed: [m/s].
        ramp: duration of the rise [s]; the fall takes speed * ramp of the path.
        start: when to set off [s].
        end: where to stop [m], the path's length by default.
        gain: how fast a speed error dies out [1/s].
        name: "<frame> speed" by default.

    Raises:
        InputError: a number that is not positive, a start that is not finite, or an
            end beyond the path.
    """

    code = Code.SPEED

    def __init__(
        self,
        frame: str,
        path: Path,
        *,
        speed: float,
        ramp: float = 0.5,
        start: float = 0.0,
        end: float | None = None,
        gain: float = 50.0,
        name: str | None = None,
    ) -> None:
        law = Damper(positive(gain, "gain"))
        super().__init__(
            named(name, f"{frame} speed"), "m/s", ("along",), law, (frame,)
        )
        self.path = still(path, self.name)
        self.speed = speed
        self.ramp = positive(ramp, "ramp")
        self.start = number(start, "start")
        self.end = path.length if end is None else positive(end, "end")
        if self.end > path.length:
            raise InputError(
                f"'{self.name}' should stop at {self.end} m, but its path ends at "
                f"{path.length:.6g} m."
            )

    @property
    def speed(self) -> float:
        """Along the path [m/s]; may be changed on the way.

        Raises:
            InputError: when set, not a number greater than 0; it stays as it was.
        """
        return self._speed

    @speed.setter
    def speed(self, speed: float) -> None:
        self._speed = positive(speed, "speed")
        announce(self)

    def parameters(self, robot: Robot) -> Array:
        """Speed, ramp, start, end (4,)."""
        del robot
        return np.array([self.speed, self.ramp, self.start, self.end])

    def table(self, robot: Robot) -> Array:
        """The path."""
        del robot
        return self.path.table


def smooth_rise(u: float) -> tuple[float, float]:
    """Quintic step from 0 to 1 over u in [0, 1], and its slope."""
    u = min(max(u, 0.0), 1.0)
    return u**3 * (10.0 - 15.0 * u + 6.0 * u * u), 30.0 * u * u * (1.0 - u) ** 2
