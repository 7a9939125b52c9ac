"""What lies in front of the knife's edge: links of the seam, or the flesh beside it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from sims.cutting.meat.face import Face, Wound
from sims.cutting.meat.knife import CHORD, resistance
from sims.cutting.meat.meat import Meat, Toughness
from wbc.arrays import Array, BoolArray, IntArray

__all__ = ["Incision", "Reaction"]

GRADUAL: Final = 1e-3
"""Way into a muscle over which its resistance grows to all of it [m]."""
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
        if tip[2] > ends[0][:, 2].max() + self._pitch:
            return Reaction(0.0, 0.0, NOTHING, NOTHING)
        met = self._ahead(ends, alive, tip, motion[:2] / way) if way > 0 else NOTHING
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

    def _ahead(
        self, ends: tuple[Array, Array], alive: BoolArray, tip: Array, t: Array
    ) -> IntArray:
        """Links that a tip moving along t (2,) will cut within the next pitch."""
        found = np.flatnonzero(alive & (np.minimum(*(a[:, 2] for a in ends)) >= tip[2]))
        offsets = [a[found, :2] - tip[:2] for a in ends]
        along = 0.5 * (offsets[0] + offsets[1]) @ t
        beside = [o @ [-t[1], t[0]] for o in offsets]
        near = (along > 0.0) & (along <= self._pitch + self._width)
        near &= np.minimum(*beside) <= self._width
        near &= np.maximum(*beside) >= -self._width
        return found[near]
