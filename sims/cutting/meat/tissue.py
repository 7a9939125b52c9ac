"""The meat's process: links that pull, tear and are cut, and what the knife feels."""

from __future__ import annotations

from typing import Final, final

import mujoco
import numpy as np

from sims.cutting.meat.flex import MaterialPoints
from sims.cutting.meat.links import damage
from sims.cutting.meat.meat import HELD, PULLED, Meat
from sims.cutting.meat.rule import cut
from wbc.arrays import Array, BoolArray

__all__ = ["Tissue"]

WIDTH: Final = 2e-3
"""Distance at which the knife cuts a link, d of P0 eq. 6 [m]."""


@final
class Tissue:
    """Links between the muscles of a scene, advanced once a step.

    Call `apply` after the kinematics of a step are known (`mj_step1`) and before it is
    finished (`mj_step2`). It sets `qfrc_applied` of the muscles.

    Args:
        meat: what was added to the scene.
        model: the scene.
        data: its state.
    """

    def __init__(self, meat: Meat, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self.meat, self._data = meat, data
        self._sides = tuple(
            MaterialPoints(model, name, points)
            for name, points in zip((HELD, PULLED), meat.links.ends, strict=True)
        )
        self.reset()

    def reset(self) -> None:
        """Make the meat whole again."""
        n = self.meat.links.count
        self._alive, self._cut = np.ones(n, dtype=bool), np.zeros(n, dtype=bool)
        self._damage = np.zeros(n)

    def apply(self, data: mujoco.MjData, before: Array, tip: Array) -> None:
        """Advance damage and cuts, and apply all forces of this step.

        Args:
            data: the state, kinematics up to date.
            before: (3,) the knife's tip one step ago [m].
            tip: (3,) the knife's tip now [m].
        """
        links = self.meat.links
        (x1, v1), (x2, v2) = (side.read(data) for side in self._sides)
        self._alive[(hit := cut(before, tip, (x1, x2), WIDTH))] = False
        self._cut[hit] = True
        pull = x2 - x1 - links.rest
        stretch = np.sqrt(np.einsum("ij,ij->i", pull, pull))
        np.maximum(self._damage, damage(stretch, links.onset), out=self._damage)
        self._alive &= self._damage < 1.0
        left = self._alive * (1.0 - self._damage)
        force = (left * links.stiffness)[:, None] * pull
        force += (left * links.damping)[:, None] * (v2 - v1)
        self._sides[0].push(data, force)
        self._sides[1].push(data, -force)

    def ends(self) -> tuple[Array, Array]:
        """Ends (N, 3), (N, 3) of all links now, cut ones as well [m]."""
        return self._sides[0].read(self._data)[0], self._sides[1].read(self._data)[0]

    def interface_points(self) -> tuple[Array, BoolArray]:
        """Middles (N, 3) of the links [m], and which of them still hold."""
        a1, a2 = self.ends()
        return 0.5 * (a1 + a2), self._alive.copy()

    def opening(self) -> float:
        """How far the muscles have moved apart along y, averaged over the seam [m]."""
        a1, a2 = self.ends()
        return float((a2 - a1 - self.meat.links.rest)[:, 1].mean())

    @property
    def alive(self) -> BoolArray:
        """(N,) which links still hold."""
        return self._alive.copy()

    @property
    def links_cut_fraction(self) -> float:
        """Share of the links that no longer hold, cut or torn."""
        return float(1.0 - self._alive.mean())

    @property
    def separated(self) -> bool:
        """Whether no link holds."""
        return not self._alive.any()
