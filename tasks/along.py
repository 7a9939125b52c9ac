"""Tasks along a path: stay on it, travel at a speed, keep an axis at its angles."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.path import Path
from wbc import PD, Damper, MotionTask, Rows, State
from wbc.arrays import frozen, positive
from wbc.errors import InputError

__all__ = ["PointOnCurve", "TravelSpeed"]


@final
class PointOnCurve(MotionTask):
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
        super().__init__(name or f"{frame} on curve", "m", rows, law, (frame,))
        self.curve = curve

    def evaluate(self, state: State, out: Rows) -> None:
        """Write the rows."""
        F = state.frame(self.frames[0])
        along = self.curve.follow(state, self.frames[0])
        c = along.point.c
        offset = F.p - c[0]
        slip = F.V[:3] - c[1] * along.rate
        for i, n in enumerate((along.point.n1, along.point.n2)):
            by_s = float(n[1] @ offset - n[0] @ c[1])
            out.error[i] = n[0] @ offset
            out.J[i] = n[0] @ F.J[:3] + by_s * along.J
            turned = n[2] @ offset * along.rate + 2.0 * (n[1] @ slip)
            out.drift[i] = (
                n[0] @ (F.drift[:3] - c[2] * along.rate**2)
                + turned * along.rate
                + by_s * along.drift
            )


@final
class TravelSpeed(MotionTask):
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
        super().__init__(name or f"{frame} speed", "m/s", ("along",), law, (frame,))
        self.path, self.speed = path, positive(speed, "speed")
        self.ramp = positive(ramp, "ramp")
        self.start = float(frozen(start, (), "start"))
        self.end = path.length if end is None else positive(end, "end")
        if self.end > path.length:
            raise InputError(
                f"'{self.name}' should stop at {self.end} m, but its path ends at "
                f"{path.length:.6g} m."
            )

    def evaluate(self, state: State, out: Rows) -> None:
        """Write the row; its error is the speed error."""
        along = self.path.follow(state, self.frames[0])
        rise, rise_rate = smooth_rise((state.t - self.start) / self.ramp)
        fall, fall_slope = self._fall(self.end - along.s)
        reference = self.speed * rise * fall
        change = self.speed * (
            rise_rate / self.ramp * fall - rise * fall_slope * along.rate
        )
        out.error[0] = along.rate - reference
        out.J[0] = along.J
        out.rate[0] = -reference
        out.drift[0] = along.drift - change

    def _fall(self, left: float) -> tuple[float, float]:
        """Share of the speed with `left` metres to go, and its slope [1/m]."""
        if not np.isfinite(left):
            return 1.0, 0.0
        k = 0.5 * np.pi / (self.speed * self.ramp)
        if left >= self.speed * self.ramp:
            return 1.0, 0.0
        if left <= 0.0:
            return max(k * left, -1.0), k if k * left > -1.0 else 0.0
        return float(np.sin(k * left)), float(k * np.cos(k * left))


def smooth_rise(u: float) -> tuple[float, float]:
    """Quintic step from 0 to 1 over u in [0, 1], and its slope."""
    u = min(max(u, 0.0), 1.0)
    return u**3 * (10.0 - 15.0 * u + 6.0 * u * u), 30.0 * u * u * (1.0 - u) ** 2
