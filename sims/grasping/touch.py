"""What each finger exerts on the cylinder, as the engine finds it."""

from __future__ import annotations

from typing import Final, final

import mujoco
import numpy as np

from sims.grasping.gripper import JOINTS
from wbc.arrays import Array

__all__ = ["EVERY", "Touch"]

EVERY: Final = 20
"""Ticks between two samples: more often than the replay shows them."""


@final
class Touch:
    """Samples the contact forces of both fingers.

    The engine is asked about a copy of the world, because between two steps the world
    itself has positions of one instant and forces of another.

    Args:
        model: of the cell.

    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model, self._world = model, mujoco.MjData(model)
        self._fingers = [int(model.body(name).id) for name in JOINTS]
        self._ticks = 0
        self._t: list[float] = []
        self._samples: list[Array] = []

    @property
    def t(self) -> Array:
        """Times (S,) [s]."""
        return np.array(self._t)

    @property
    def points(self) -> Array:
        """Where the forces act (S, 2, 3) [m]: left finger, right finger.

        The mean of a finger's contacts, weighted by their normal forces; the finger's
        own place where it has none.
        """
        return np.array(self._samples)[:, :, 0]

    @property
    def forces(self) -> Array:
        """Forces of the fingers on the cylinder (S, 2, 3) [N]."""
        return np.array(self._samples)[:, :, 1]

    def see(self, data: mujoco.MjData) -> None:
        """Look at the world after a tick; most ticks are not sampled."""
        self._ticks += 1
        if self._ticks % EVERY != 1:
            return
        mujoco.mj_copyData(self._world, self._model, data)
        mujoco.mj_forward(self._model, self._world)
        self._t.append(float(data.time))
        self._samples.append(np.array([self._push(f) for f in self._fingers]))

    def _push(self, finger: int) -> Array:
        """Place and force (2, 3) of a finger's contacts together."""
        world, body_of = self._world, self._model.geom_bodyid
        total, place, weight = np.zeros(3), np.zeros(3), 0.0
        for index, contact in enumerate(world.contact):
            bodies = body_of[contact.geom]
            if finger not in bodies:
                continue
            wrench = np.zeros(6)
            mujoco.mj_contactForce(self._model, world, index, wrench)
            on_second = contact.frame.reshape(3, 3).T @ wrench[:3]
            total += on_second if bodies[0] == finger else -on_second
            place += wrench[0] * contact.pos
            weight += wrench[0]
        place = place / weight if weight > 0.0 else world.xpos[finger]
        return np.array([place, total])
