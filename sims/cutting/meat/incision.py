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
        in_muscle: whether that is a muscle, beside the seam.
        held: indices of the material points of the held muscle that take the reaction.
        pulled: of the pulled muscle.
    """

    tearing: float
    depth: float
    in_muscle: bool
    held: IntArray
    pulled: IntArray

    def limit(self, motion: Array, edge: Array, toughness: Toughness) -> float:
        """Force that a knife with edge (3,) needs for a motion (3,) [N]."""
        sides = 2.0 * CHORD * self.depth
        friction = toughness.friction * toughness.pressure * sides
        return resistance(motion, edge, self.tearing, friction)

    def mean(self, values: tuple[Array, Array]) -> Array:
        """Mean (3,) over these points of values (N, 3), (N, 3); 0 without points."""
        total = np.zeros(3)
        if points := self.held.size + self.pulled.size:
            add_up(values[0], self.held, 1.0 / points, total)
            add_up(values[1], self.pulled, 1.0 / points, total)
        return total

    def share(self, forces: tuple[Array, Array], total: Array) -> None:
        """Add a force (3,) to those of the material points (N, 3), in equal parts."""
        if points := self.held.size + self.pulled.size:
            give_out(total / points, self.held, forces[0])
            give_out(total / points, self.pulled, forces[1])


@compiled
def add_up(values: Array, indices: IntArray, weight: float, total: Array) -> None:
    """Add weighted rows of values (N, 3) to a total (3,)."""
    for i in indices:
        for j in range(3):
            total[j] += weight * values[i, j]


@compiled
def give_out(value: Array, indices: IntArray, rows: Array) -> None:
    """Add a value (3,) to some rows (N, 3)."""
    for i in indices:
        for j in range(3):
            rows[i, j] += value[j]


@final
class Incision:
    """Sees what the knife meets: the links of the seam, or a muscle."""

    def __init__(self, meat: Meat, width: float) -> None:
        links, sheets = meat.links, meat.sheets
        self._toughness, self._area, self._width = meat.toughness, links.area, width
        self._pitch = float(np.ptp(sheets.seam[..., 0])) / links.grid[0]
        self._top = sheets.top + CLEARANCE
        # as far to the sides, so that a knife which leaves the seam meets no gap
        # between the last links and the muscle
        self._reach = self._pitch + width
        self._faces = tuple(
            Face(links.grid, thickness, sign)
            for thickness, sign in zip(links.behind, (-1, 1), strict=True)
        )

    def ahead(
        self,
        ends: tuple[Array, Array],
        alive: BoolArray,
        energy: Array,
        tip: Array,
        motion: Array,
    ) -> Reaction:
        """What the knife meets next.

        A link needs its toughness times its area, less the elastic energy (N,) that its
        breaking sets free; the edge spends that over one pitch of the links.

        Args:
            ends: (N, 3), (N, 3) of the links [m].
            alive: (N,) which of them hold.
            energy: (N,) stored in them [J].
            tip: (3,) of the knife [m].
            motion: (3,) of the tip in this step [m].
        """
        if tip[2] > self._top:
            return Reaction(0.0, 0.0, False, NOTHING, NOTHING)
        met = links_ahead(*ends, alive, tip, motion, self._reach)
        work = self._toughness.seam * self._area[met] - energy[met]
        tearing = float(np.maximum(work, 0.0).sum()) / self._pitch
        depth = float(self._area[met].sum()) / self._pitch
        for side, (face, points) in enumerate(zip(self._faces, ends, strict=True)):
            wound = face.wound(points, tip)
            if wound is not None and wound.inside > self._width:
                return self._flesh(wound, side)
        return Reaction(tearing, depth, False, met, met)

    def _flesh(self, wound: Wound, side: int) -> Reaction:
        tearing = self._toughness.muscle * wound.depth
        points = [NOTHING, NOTHING]
        # the blade stands in the muscle from the tip to the top
        points[side] = np.arange(wound.nearest, wound.nearest + wound.above + 1)
        return Reaction(tearing, wound.depth, True, *points)


def links_ahead(
    a1: Array,
    a2: Array,
    alive: BoolArray,
    tip: Array,
    motion: Array,
    reach: float,
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
    return found[: _find_ahead(a1, a2, alive, tip, motion, reach, found)]


@compiled
def _find_ahead(
    a1: Array,
    a2: Array,
    alive: BoolArray,
    tip: Array,
    motion: Array,
    reach: float,
    found: IntArray,
) -> int:
    """Write the indices to `found` (N,); how many there are."""
    count = 0
    way = np.hypot(motion[0], motion[1])
    if way == 0.0:
        return 0
    tx, ty = motion[0] / way, motion[1] / way
    for i in range(alive.size):
        if not alive[i] or min(a1[i, 2], a2[i, 2]) < tip[2]:
            continue
        x1, y1 = a1[i, 0] - tip[0], a1[i, 1] - tip[1]
        x2, y2 = a2[i, 0] - tip[0], a2[i, 1] - tip[1]
        along = 0.5 * ((x1 + x2) * tx + (y1 + y2) * ty)
        if not 0.0 < along <= reach:
            continue
        beside1, beside2 = y1 * tx - x1 * ty, y2 * tx - x2 * ty
        if min(beside1, beside2) <= reach and max(beside1, beside2) >= -reach:
            found[count] = i
            count += 1
    return count
