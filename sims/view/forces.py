"""Forces as arrows: what wrists feel, and what the engine's contacts exert."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final, final

import mujoco
import numpy as np

from sims.view.marks import FORCE, Colour, Mark, arrow
from sims.wrist import WristSensor
from wbc.arrays import Array

__all__ = ["Contacts", "felt", "force_arrow"]

CONTACT: Final[Colour] = (0.90, 0.55, 0.0, 1.0)
SCALE: Final = 0.005
"""Length of an arrow for each newton [m/N]."""
LONGEST: Final = 0.35
"""[m]"""
LEAST: Final = 0.5
"""Smaller forces are not drawn [N]."""


def force_arrow(p: Array, force: Array, colour: Colour) -> list[Mark]:
    """A force (3,) [N] from p (3,) on, with its size; nothing for next to none."""
    size = float(np.linalg.norm(force))
    if not size >= LEAST:
        return []
    tip = p + min(SCALE, LONGEST / size) * force
    return [arrow(p, tip, colour, f"{size:.0f} N")]


def felt(
    data: mujoco.MjData, wrists: Sequence[WristSensor], wrenches: Mapping[str, Array]
) -> list[Mark]:
    """What sensors feel: the robot's force on its surroundings, from the sensor on."""
    marks: list[Mark] = []
    for wrist in wrists:
        if wrist.name in wrenches:
            p = data.site(wrist.site).xpos.copy()
            marks += force_arrow(p, wrenches[wrist.name][:3], FORCE)
    return marks


@final
class Contacts:
    """True contact forces, for arrows; nothing that is simulated feels the look.

    The engine has the forces only at the end of a time step, so they are computed on a
    copy of its state.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model, self._copy = model, mujoco.MjData(model)

    def marks(self, data: mujoco.MjData) -> list[Mark]:
        """An arrow for each two bodies that touch: what the second one feels.

        It is the sum over all their contacts, in the middle of these by their forces.
        """
        if not data.ncon:
            return []
        mujoco.mj_copyData(self._copy, self._model, data)
        mujoco.mj_forward(self._model, self._copy)
        sums: dict[tuple[int, int], Array] = {}
        for i in range(self._copy.ncon):
            pair, moment = self._contact(i)
            sums[pair] = sums.get(pair, 0.0) + moment
        return [
            mark
            for total in sums.values()
            if total[6] > LEAST
            for mark in force_arrow(total[3:6] / total[6], total[:3], CONTACT)
        ]

    def _contact(self, i: int) -> tuple[tuple[int, int], Array]:
        """Its bodies; its force (3,), place times size of the force (3,), that size."""
        contact, wrench = self._copy.contact[i], np.zeros(6)
        mujoco.mj_contactForce(self._model, self._copy, i, wrench)
        force = contact.frame.reshape(3, 3).T @ wrench[:3]
        size = np.linalg.norm(force)
        first, second = (int(self._model.geom_bodyid[g]) for g in contact.geom)
        return (first, second), np.array([*force, *(size * contact.pos), size])
