"""A crank whose axis and radius are known only roughly is turned by its hole."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from sims.cell import Cell
from sims.constraints.case import limits, rise
from sims.contact.circle import CircleFit
from sims.contact.peg import DOWN
from sims.contact.scene import AXIS, CRANK, LEVER, TIP
from sims.run import Decision
from tasks import Damping, ForceLaw, HybridForceMotion
from wbc import Hierarchy
from wbc.arrays import Array

__all__ = ["Belief", "Turning", "believed_cranks", "handle"]

SPREAD: Final = 5e-3
"""To which centre and radius are known [m]; the tilt of the axis is not known."""
TURNS: Final = 1.1
DURATION: Final = 10.0
"""Of the turning [s]."""
REST: Final = 0.3
"""Before and after it [s]."""
SUNK: Final = 0.016
"""Depth of the peg's end below the lever's upper face, at the start [m]."""
STIFFNESS: Final = 3600.0
"""Of the motion rows [1/s^2]."""
EVERY: Final = 10
"""Ticks between two points of the fit."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Belief:
    """What is known of the crank: centre (2,) and radius [m]; its axis is upright."""

    centre: Array
    radius: float


def believed_cranks(seed: int, count: int) -> list[Belief]:
    """Seeded beliefs, each number wrong by up to the spread."""
    rng = np.random.default_rng([seed, 3])
    errors = rng.uniform(-SPREAD, SPREAD, (count, 3))
    return [Belief(CRANK[:2] + e[:2], LEVER + float(e[2])) for e in errors]


def handle(angle: float = 0.0) -> Array:
    """Middle (3,) of the crank's hole in the lever's upper face [m], the truth."""
    z = AXIS / np.linalg.norm(AXIS)
    quarter = np.cross([0.0, 0.0, 1.0], z)
    turn = np.arcsin(np.linalg.norm(quarter))
    x = _turned(np.array([1.0, 0.0, 0.0]), quarter, turn)
    y = np.cross(z, x)
    place: Array = CRANK + LEVER * (np.cos(angle) * x + np.sin(angle) * y)
    return place


@final
class Turning:
    """Move along the circle, give way across it, learn the circle on the way.

    The radial row is one of force, with none wanted: the crank leads there. The
    tangential one is one of motion, along the circle that is known so far.

    Args:
        belief: what is known of the crank.
        start: (3,) where the tip is [m].

    Attributes:
        hierarchy: the stack.
        duration: of the run [s].
        circle: what has been learnt.
    """

    duration = DURATION + 2.0 * REST

    def __init__(self, belief: Belief, start: Array) -> None:
        self.circle = CircleFit(belief.centre, belief.radius, SPREAD)
        self._ticks, self._height = 0, float(start[2])
        arm = start[:2] - belief.centre
        self._first = float(np.arctan2(arm[1], arm[0]))
        self._task = HybridForceMotion(
            TIP,
            start,
            np.zeros(6),
            (1, 0, 0, 0, 0, 0),
            orientation=DOWN,
            axes=_axes(arm),
            law=ForceLaw(0.3, 10.0, 40.0),
            stiffness=STIFFNESS,
            name="turn the crank",
        )
        self.hierarchy: Hierarchy = limits() >> self._task >> Damping()

    def script(self, t: float) -> None:
        """Move target and axes to time t [s]."""
        if self._ticks:
            self._learn(self._task.position)
        self._ticks += 1
        s, ds, dds = (TURNS * 2.0 * np.pi * x for x in rise(t - REST, DURATION))
        centre, r = self.circle.centre, self.circle.radius
        angle = self._first + s
        out = np.array([np.cos(angle), np.sin(angle), 0.0])
        along = np.array([-out[1], out[0], 0.0])
        p = np.append(centre, self._height) + r * out
        acceleration = r * (dds * along - ds**2 * out)
        self._task.set_target(p, None, r * ds * along, acceleration)

    def watch(self, cell: Cell, decisions: Sequence[Decision]) -> bool:
        """The run goes on to its end."""
        del cell, decisions
        return True

    def _learn(self, tip: Array) -> None:
        if self._ticks % EVERY == 0:
            self.circle.add(tip[:2])
        self._task.set_axes(_axes(tip[:2] - self.circle.centre))


def _axes(arm: Array) -> Array:
    """R_WD (3, 3): x along an arm (2,) from the centre, z up."""
    x, y = arm / np.linalg.norm(arm)
    return np.array([[x, -y, 0.0], [y, x, 0.0], [0.0, 0.0, 1.0]])


def _turned(x: Array, axis: Array, angle: float) -> Array:
    """A vector (3,) turned about an axis (3,) of any length by an angle [rad]."""
    size = float(np.linalg.norm(axis))
    if size == 0.0:
        return x
    u, c, s = axis / size, np.cos(angle), np.sin(angle)
    turned: Array = c * x + s * np.cross(u, x) + (1.0 - c) * (u @ x) * u
    return turned
