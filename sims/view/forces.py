"""Forces as arrows: what wrists feel, and what the engine's contacts exert."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final, final

import mujoco
import numpy as np

from sims.contacts import ContactForces
from sims.view.marks import FORCE, THIN, Colour, Mark, arrow
from sims.wrist import WristSensor
from wbc.arrays import Array

__all__ = ["Contacts", "felt", "pulled", "pushed"]

CONTACT: Final[Colour] = (0.90, 0.55, 0.0, 1.0)
SCALE: Final = 0.005
"""Length of an arrow for each newton [m/N]."""
LONGEST: Final = 0.35
"""[m]"""
BROAD: Final = 2.0 * THIN
"""Radius of an arrow of what is felt [m]; what is wanted is thin and shows inside."""
LEAST: Final = 0.5
"""Smaller forces are not drawn [N]."""


def pushed(p: Array, force: Array, colour: Colour, radius: float) -> list[Mark]:
    """A force (3,) [N] that ends at p (3,): into what is pushed, from outside.

    Nothing for next to none.
    """
    way = _way(force)
    return [] if way is None else [arrow(p - way, p, colour, _size(force), radius)]


def pulled(p: Array, force: Array, colour: Colour, radius: float) -> list[Mark]:
    """A force (3,) [N] that begins at p (3,), as one that is passed on there."""
    way = _way(force)
    return [] if way is None else [arrow(p, p + way, colour, _size(force), radius)]


def _way(force: Array) -> Array | None:
    size = float(np.linalg.norm(force))
    return min(SCALE, LONGEST / size) * force if size >= LEAST else None


def _size(force: Array) -> str:
    return f"{np.linalg.norm(force):.0f} N"


def felt(
    data: mujoco.MjData, wrists: Sequence[WristSensor], wrenches: Mapping[str, Array]
) -> list[Mark]:
    """What sensors feel: the robot's force on its surroundings."""
    marks: list[Mark] = []
    for wrist in wrists:
        if wrist.name in wrenches:
            p = data.site(wrist.site).xpos.copy()
            marks += pulled(p, wrenches[wrist.name][:3], FORCE, BROAD)
    return marks


@final
class Contacts:
    """True contact forces, for arrows."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._rests, self._contacts = model.body_weldid == 0, ContactForces(model)

    def marks(self, data: mujoco.MjData) -> list[Mark]:
        """An arrow for each two bodies that touch: what the resting one feels.

        Where both move or both rest, it is the second one. It is the sum over all their
        contacts, in the middle of these by their forces.
        """
        if not data.ncon:
            return []
        self._contacts.look(data)
        sums: dict[tuple[int, int], Array] = {}
        for i in range(self._contacts.world.ncon):
            pair, moment = self._contact(i)
            sums[pair] = sums.get(pair, 0.0) + moment
        return [
            mark
            for total in sums.values()
            if total[6] > LEAST
            for mark in pushed(total[3:6] / total[6], total[:3], CONTACT, BROAD)
        ]

    def _contact(self, i: int) -> tuple[tuple[int, int], Array]:
        """Its bodies; its force (3,), place times size of the force (3,), that size."""
        (first, second), force, _ = self._contacts.of(i)
        size, p = np.linalg.norm(force), self._contacts.world.contact[i].pos
        if self._rests[first] and not self._rests[second]:
            force = -force
        return (first, second), np.array([*force, *(size * p), size])
