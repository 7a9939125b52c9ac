"""What lies in front of the knife's edge: links of the seam, or the flesh beside it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from sims.cutting.meat.face import Face, Wound
from sims.cutting.meat.knife import CHORD, resistance
from sims.cutting.meat.meat import Meat, Toughness
from wbc.arrays import Array, BoolArray, IntArray
from wbc.compiled import compiled

__all__ = ["Incision", "Reaction"]

GRADUAL: Final = 1e-3
"""Way into a muscle over which its resistance grows to all of it [m]."""
CLEARANCE: Final = 0.03
"""Height above the unloaded meat from which on a knife is surely out of it [m]."""
NOTHING: Final = np.zeros(0, dtype=np.int_)


@final
@dataclass(frozen=True, slots=True, eq=False)
class Reaction:
    """What the edge is about to cut.

    Attributes:
        tearing: toughness times engaged length of the edge [N].
        depth: of tissue that the blade is in [m].
        held: indices of the material points of the held muscle that take the reaction.
        pulled: of the pulled muscle.
    """

    tearing: float
    depth: float
    held: IntArray
    pulled: IntArray

    def force(self, velocity: Array, edge: Array, toughness: Toughness) -> Array:
        """Force (3,) on a knife that moves at velocity (3,) with edge (3,) [N]."""
        sides = 2.0 * CHORD * self.depth
        friction = toughness.friction * toughness.pressure * sides
        return resistance(velocity, edge, self.tearing, friction)

    def share(self, forces: tuple[Array, Array], total: Array) -> None:
        """Add a force (3,) to those of the material points (N, 3), in equal parts."""
        points = self.held.size + self.pulled.size
        if points:
            forces[0][self.held] += total / points
            forces[1][self.pulled] += total / points


@final
class Incision:
    """Follows the knife through the meat.

    Attributes:
        muscle_length: way in the xy plane that the tip has gone inside a muscle [m].
    """

    def __init__(self, meat: Meat, width: float) -> None:
        links, sheets = meat.links, meat.sheets
        self._toughness, self._area, self._width = meat.toughness, links.area, width
        self._pitch = float(np.ptp(sheets.seam[..., 0])) / links.grid[0]
        self._top = sheets.top + CLEARANCE
        self._reach = self._pitch + width, width
        self._faces = tuple(
            Face(links.grid, thickness, sign)
            for thickness, sign in zip(links.behind, (-1, 1), strict=True)
        )
        self.muscle_length = 0.0

    def advance(
        self,
        ends: tuple[Array, Array],
        alive: BoolArray,
        energy: Array,
        tip: Array,
        motion: Array,
    ) -> Reaction:
        """See what the knife meets next, and count what it did to the muscles.

        A link needs its toughness times its area, less the elastic energy (N,) that its
        breaking sets free; the edge spends that over one pitch of the links.

        Args:
            ends: (N, 3), (N, 3) of the links [m].
            alive: (N,) which of them hold.
            energy: (N,) stored in them [J].
            tip: (3,) of the knife [m].
            motion: (3,) of the tip in this step [m].
        """
        way = float(np.hypot(motion[0], motion[1]))
        if tip[2] > self._top:
            return Reaction(0.0, 0.0, NOTHING, NOTHING)
        met = ahead(*ends, alive, tip, motion, self._reach)
        work = self._toughness.seam * self._area[met] - energy[met]
        tearing = float(np.maximum(work, 0.0).sum()) / self._pitch
        depth = float(self._area[met].sum()) / self._pitch
        for side, (face, points) in enumerate(zip(self._faces, ends, strict=True)):
            wound = face.wound(points, tip)
            if wound is not None and wound.inside > self._width:
                self.muscle_length += way
                return self._flesh(wound, side)
        return Reaction(tearing, depth, met, met)

    def _flesh(self, wound: Wound, side: int) -> Reaction:
        share = min((wound.inside - self._width) / GRADUAL, 1.0)
        tearing = share * self._toughness.muscle * wound.depth
        points = [NOTHING, NOTHING]
        points[side] = np.array([wound.nearest])
        return Reaction(tearing, wound.depth, *points)


@compiled
def ahead(
    a1: Array,
    a2: Array,
    alive: BoolArray,
    tip: Array,
    motion: Array,
    reach: tuple[float, float],
) -> IntArray:
    """Indices of the links that a tip is about to cut.

    Args:
        a1: (N, 3) one end of the links [m].
        a2: (N, 3) the other end [m].
        alive: (N,) which of them hold.
        tip: (3,) of the knife [m].
        motion: (3,) of the tip; only its direction in the xy plane counts.
        reach: how far to look along the motion, and to either side of it [m].
    """
    found = np.empty(alive.size, dtype=np.int_)
    count = 0
    way = np.hypot(motion[0], motion[1])
    if way == 0.0:
        return found[:0]
    tx, ty = motion[0] / way, motion[1] / way
    for i in range(alive.size):
        if not alive[i] or min(a1[i, 2], a2[i, 2]) < tip[2]:
            continue
        x1, y1 = a1[i, 0] - tip[0], a1[i, 1] - tip[1]
        x2, y2 = a2[i, 0] - tip[0], a2[i, 1] - tip[1]
        along = 0.5 * ((x1 + x2) * tx + (y1 + y2) * ty)
        if not 0.0 < along <= reach[0]:
            continue
        beside1, beside2 = y1 * tx - x1 * ty, y2 * tx - x2 * ty
        if min(beside1, beside2) <= reach[1] and max(beside1, beside2) >= -reach[1]:
            found[count] = i
            count += 1
    return found[:count]
