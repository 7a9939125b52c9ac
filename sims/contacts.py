"""Contact forces as the engine finds them, without disturbing what is simulated."""

from __future__ import annotations

from typing import final

import mujoco
import numpy as np

from wbc.arrays import Array

__all__ = ["ContactForces"]


@final
class ContactForces:
    """Contacts of a copy of the world.

    Between two steps the world itself has positions of one instant and forces of
    another, and what is simulated must not feel the look.

    Args:
        model: of the world.

    Attributes:
        world: the copy.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model, self.world = model, mujoco.MjData(model)

    def look(self, data: mujoco.MjData) -> None:
        """Copy the world as it stands, and compute its forces."""
        mujoco.mj_copyData(self.world, self._model, data)
        mujoco.mj_forward(self._model, self.world)

    def of(self, i: int) -> tuple[tuple[int, int], Array, float]:
        """A contact's two bodies, its force on the second (3,) and along the normal."""
        contact, wrench = self.world.contact[i], np.zeros(6)
        mujoco.mj_contactForce(self._model, self.world, i, wrench)
        first, second = (int(self._model.geom_bodyid[g]) for g in contact.geom)
        on_second = contact.frame.reshape(3, 3).T @ wrench[:3]
        return (first, second), on_second, float(wrench[0])
