"""A peg finds a hole known to 3 mm: a spiral at constant force, then insertion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, final

import numpy as np

from sims.cell import Cell
from sims.constraints.case import limits
from sims.contact.scene import HOLE, TIP
from sims.contact.spiral import Spiral
from sims.run import Decision
from tasks import Damping, ForceLaw, FramePose, HybridForceMotion
from wbc import Hierarchy
from wbc.arrays import Array

__all__ = [
    "ABOVE",
    "DEPTH",
    "DOWN",
    "ERROR",
    "Insertion",
    "Search",
    "Stay",
    "believed_holes",
]

DOWN: Final = np.diag([1.0, -1.0, -1.0])
"""Axes of the tip with the peg pointing down."""
ERROR: Final = 3e-3
"""To which the hole's place is known [m]."""
ABOVE: Final = 2.5e-3
"""Height of the start over the block [m]."""
PRESS: Final = 10.0
"""Force of search and insertion [N]."""
APPROACH: Final = 4e-3
"""Speed at which the surface is looked for [m/s]."""
SETTLE: Final = 0.3
"""At rest after the touch, to learn the height of the surface [s]."""
PITCH: Final = 1.0e-3
"""Between two turns of the spiral [m]: less than the chamfer catches."""
SPEED: Final = 8e-3
"""Along the spiral [m/s]."""
WIDEST: Final = 4e-3
"""Radius at which the search gives up [m]."""
DROP: Final = 2e-4
"""By which the peg sinks where it begins to enter [m]."""
MISSED: Final = 4e-3
"""So far below where the surface should be, the peg went straight into the hole [m]."""
DEPTH: Final = 0.020
"""To which it is to go [m]."""
STIFFNESS: Final = 3600.0
"""Of the motion rows [1/s^2]."""
YIELD, CREEP = 60.0, 150.0
"""Damping of the force rows across and along the hole [1/s]: the second one keeps a peg
that meets no resistance at some 10 mm/s."""


def believed_holes(seed: int, count: int) -> list[Array]:
    """Where the robot believes the hole to be: (3,) each, anywhere within the error."""
    rng = np.random.default_rng([seed, 2])
    radius = ERROR * np.sqrt(rng.uniform(0.0, 1.0, count))
    angle = rng.uniform(-np.pi, np.pi, count)
    away = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(count)])
    return list(HOLE + radius[:, None] * away)


@final
class Search:
    """Press on the block, wind outwards, and stop where the peg begins to sink.

    Args:
        hole: (3,) where it is believed to be [m].

    Attributes:
        hierarchy: the stack.
        duration: longest [s].
        surface: height of the block, once felt [m]; NaN before.
        sunk: whether the peg began to enter.
    """

    duration = 12.0

    def __init__(self, hole: Array) -> None:
        self._hole, self._t = hole, 0.0
        self._spiral = Spiral(PITCH, SPEED)
        self._task = HybridForceMotion(
            TIP,
            hole,
            [0.0, 0.0, PRESS, 0.0, 0.0, 0.0],
            (0, 0, 1, 0, 0, 0),
            orientation=DOWN,
            axes=DOWN,
            law=_law(),
            stiffness=STIFFNESS,
            approach=APPROACH,
            name="press and wind",
        )
        self.hierarchy: Hierarchy = limits() >> self._task >> Damping()
        self._touched = self.surface = np.nan
        self.sunk = False

    def script(self, t: float) -> None:
        """Move the target to time t [s]."""
        dt, self._t = t - self._t, t
        if np.isnan(self._touched):
            if self._task.touching:
                self._touched = t
            elif t > 0.0 and self._task.position[2] < self._hole[2] - MISSED:
                self.surface, self.sunk = float(self._hole[2]), True
        elif t < self._touched + SETTLE:
            self.surface = float(self._task.position[2])
        elif not self.sunk:
            offset, velocity = self._spiral.advance(dt)
            self._task.set_target(self._hole + offset, None, velocity)
            self.sunk = bool(self._task.position[2] < self.surface - DROP)

    def watch(self, cell: Cell, decisions: Sequence[Decision]) -> bool:
        """False once the peg began to sink, or the spiral has become too wide."""
        del cell, decisions
        return not self.sunk and self._spiral.radius < WIDEST

    @property
    def report(self) -> str:
        """What became of the search, in a sentence."""
        if self.sunk:
            return "the peg found the hole."
        if np.isnan(self._touched):
            return "the peg felt no surface. Is the block where it should be?"
        return (
            f"no hole within {WIDEST * 1e3:.0f} mm of where it was believed to be: the "
            "search has stopped on the surface. Look again for the hole's place."
        )


@final
class Insertion:
    """Let the hole lead: no force across, a constant one along, upright all the way.

    Args:
        surface: height of the block [m].

    Attributes:
        hierarchy: the stack.
        duration: longest [s].
    """

    duration = 8.0

    def __init__(self, surface: float) -> None:
        self._end = surface - DEPTH
        self._task = HybridForceMotion(
            TIP,
            HOLE,
            [0.0, 0.0, PRESS, 0.0, 0.0, 0.0],
            (1, 1, 1, 0, 0, 0),
            orientation=DOWN,
            axes=DOWN,
            law=_law(),
            stiffness=STIFFNESS,
            force_damping=(YIELD, YIELD, CREEP),
            approach=APPROACH,
            name="insert",
        )
        self.hierarchy: Hierarchy = limits() >> self._task >> Damping()

    def script(self, t: float) -> None:
        """Nothing moves but the peg."""

    @property
    def end(self) -> Array:
        """Where the tip was at last (3,) [m]."""
        return self._task.position

    def watch(self, cell: Cell, decisions: Sequence[Decision]) -> bool:
        """False once the peg is deep enough."""
        del cell, decisions
        return bool(self._task.position[2] > self._end)


@final
class Stay:
    """Hold the peg where it is.

    Args:
        p: (3,) place of its end [m].

    Attributes:
        hierarchy: the stack.
        duration: of the phase [s].
    """

    duration = 0.3

    def __init__(self, p: Array) -> None:
        pose = FramePose(TIP, p, DOWN, stiffness=STIFFNESS, name="stay")
        self.hierarchy: Hierarchy = limits() >> pose >> Damping()

    def script(self, t: float) -> None:
        """Nothing moves."""

    def watch(self, cell: Cell, decisions: Sequence[Decision]) -> bool:
        """The phase goes on to its end."""
        del cell, decisions
        return True


def _law() -> ForceLaw:
    return ForceLaw(0.3, 10.0, 40.0)
