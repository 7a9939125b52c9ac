"""The knife's way along a guide line: x(t), and the pose that goes with it."""

from __future__ import annotations

import math
from typing import NamedTuple, final

import numpy as np
from numpy.typing import ArrayLike

from sims.cutting.polynomial import Polynomial
from sims.cutting.timelaw import STILL, Motion, Quintic
from wbc import InputError
from wbc.arrays import Array

__all__ = ["R_INIT", "KnifeTarget", "Stroke", "heading", "knife_target", "upright"]

R_INIT = np.diag([-1.0, 1.0, -1.0])
"""P0 eq. (12): the knife's z axis points down, its x axis against the world's."""
NEWTON_STEPS = 8
CONVERGED = 1e-12


class KnifeTarget(NamedTuple):
    """Where the knife should be.

    Attributes:
        p: (3,) of the tip [m].
        R: (3, 3).
        V: (6,) twist [linear; angular], world axes.
        A: (6,) its derivative.
    """

    p: Array
    R: Array
    V: Array
    A: Array


@final
class Stroke:
    """One passage: along a guide line from x = start to x = end, rest to rest.

    Args:
        curve: the guide line.
        start: [m].
        end: [m]; may lie below `start`.
        duration: [s].

    Raises:
        InputError: start and end coincide, or the duration is not positive.
    """

    def __init__(
        self, curve: Polynomial, start: float, end: float, duration: float
    ) -> None:
        if not abs(end - start) > 1e-6:
            raise InputError(f"a passage from x = {start} to {end} m has no length.")
        self.curve, self.start, self.end = curve, float(start), float(end)
        self.law = Quintic(curve.length(self.start, self.end), duration)
        self._x = self.start

    @property
    def duration(self) -> float:
        """Of the time law [s]."""
        return self.law.duration

    def at(self, t: float) -> Motion:
        """X(t) with speed and acceleration [m, m/s, m/s^2].

        Newton on the arc length from `start` to x = s(t), from the last x on.
        """
        s, sd, sdd = self.law.at(t)
        x = self._x
        for _ in range(NEWTON_STEPS):
            bend = self.curve.at(x)
            short = self.curve.length(self.start, x) - s
            step = short / math.sqrt(1.0 + bend.y1 * bend.y1)
            x -= step
            if abs(step) < CONVERGED:
                break
        self._x = x
        bend = self.curve.at(x)
        stretch = math.sqrt(1.0 + bend.y1 * bend.y1)
        xd = sd / stretch
        xdd = sdd / stretch - bend.y1 * bend.y2 * xd * xd / (stretch * stretch)
        return Motion(x, xd, xdd)


def heading(curve: Polynomial, x: Motion) -> Motion:
    """Angle theta = atan(dy/dx) of the blade, P0 eq. (13) as corrected."""
    _, y1, y2, y3 = curve.at(x.value)
    stretch = 1.0 + y1 * y1
    rate = y2 * x.rate / stretch
    bent = (y2 * x.acceleration + y3 * x.rate * x.rate) / stretch
    bent -= 2.0 * y1 * rate * rate
    return Motion(math.atan(y1), rate, bent)


def knife_target(
    curve: Polynomial, x: Motion, z: float, sideways: Motion = STILL
) -> KnifeTarget:
    """Pose of the knife with its tip on the curve at depth z, P0 eqs. (7), (12)-(14).

    Args:
        curve: the guide line.
        x: motion along x.
        z: height of the tip [m].
        sideways: what is added to y, such as the local update.
    """
    y, y1, y2, _ = curve.at(x.value)
    yd = y1 * x.rate + sideways.rate
    ydd = y1 * x.acceleration + y2 * x.rate * x.rate + sideways.acceleration
    return upright(
        (x.value, y + sideways.value, z),
        (x.rate, yd, 0.0),
        (x.acceleration, ydd, 0.0),
        heading(curve, x),
    )


def upright(p: ArrayLike, v: ArrayLike, a: ArrayLike, theta: Motion) -> KnifeTarget:
    """A vertical knife: position (3,), its derivatives, and the blade's heading.

    R = R_init Rz(-theta), P0 eq. (14): the knife's z points down, so -theta about it
    is +theta about the world's.
    """
    c, s = math.cos(theta.value), math.sin(theta.value)
    return KnifeTarget(
        np.array(p),
        np.array([[-c, -s, 0.0], [-s, c, 0.0], [0.0, 0.0, -1.0]]),
        np.array([*v, 0.0, 0.0, theta.rate]),
        np.array([*a, 0.0, 0.0, theta.acceleration]),
    )
