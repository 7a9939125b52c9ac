"""What each finger exerts on the cylinder, as the engine finds it."""

from __future__ import annotations

from typing import Final, final

import mujoco
import numpy as np

from sims.contacts import ContactForces
from sims.grasping.gripper import JOINTS
from wbc.arrays import Array

__all__ = ["EVERY", "Touch"]

EVERY: Final = 20
"""Ticks between two samples: more often than the replay shows them."""


@final
class Touch:
    """Samples the contact forces of both fingers.

    Args:
        model: of the cell.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._contacts = ContactForces(model)
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
        self._contacts.look(data)
        self._t.append(float(data.time))
        self._samples.append(np.array([self._push(f) for f in self._fingers]))

    def _push(self, finger: int) -> Array:
        """Place and force (2, 3) of a finger's contacts together."""
        world = self._contacts.world
        total, place, weight = np.zeros(3), np.zeros(3), 0.0
        for i in range(world.ncon):
            bodies, on_second, normal = self._contacts.of(i)
            if finger not in bodies:
                continue
            total += on_second if bodies[0] == finger else -on_second
            place += normal * world.contact[i].pos
            weight += normal
        place = place / weight if weight > 0.0 else world.xpos[finger]
        return np.array([place, total])
