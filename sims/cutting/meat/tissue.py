"""The meat's process: links that pull, tear and are cut, and what the knife feels."""

from __future__ import annotations

from typing import Final, final

import mujoco
import numpy as np

from sims.cutting.meat.flex import MaterialPoints
from sims.cutting.meat.incision import Incision
from sims.cutting.meat.knife import Indentation, Knife
from sims.cutting.meat.links import pull
from sims.cutting.meat.meat import HELD, PULLED, Meat
from sims.cutting.meat.rule import cut
from wbc.arrays import Array, BoolArray, positive

__all__ = ["Tissue"]

WIDTH: Final = 2e-3
"""Distance at which the knife cuts, d of P0 eq. 6 [m]."""


@final
class Tissue:
    """Links between the muscles of a scene, and a knife among them, step by step.

    Call `apply` after the kinematics of a step are known (`mj_step1`) and before it is
    finished (`mj_step2`). It sets `qfrc_applied` of the muscles and, if there is a
    knife, `xfrc_applied` of its body.

    Args:
        meat: what was added to the scene.
        model: the scene.
        data: its state.
        knife: name of the site at the knife's tip, z along the blade, which feels what
            it cuts; without one, cutting is free.
        width: distance at which the knife cuts a link, and beyond which it is in a
            muscle [m].

    Raises:
        InputError: a width that is not positive.
        UnknownName: there is no such site.
    """

    def __init__(
        self,
        meat: Meat,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        *,
        knife: str | None = None,
        width: float = WIDTH,
    ) -> None:
        self.meat, self._data = meat, data
        self._width = positive(width, "width")
        self._sides = tuple(
            MaterialPoints(model, name, points)
            for name, points in zip((HELD, PULLED), meat.links.ends, strict=True)
        )
        self._knife = None if knife is None else Knife(model, knife)
        self._incision = Incision(meat, self._width)
        links = meat.links
        self._rest = links.rest
        self._step = float(model.opt.timestep)
        self._law = self._rest, (links.stiffness, links.damping, links.onset)
        self._forces = np.zeros((links.count, 3)), np.zeros((links.count, 3))
        self._energy = np.zeros(links.count)
        self.reset()
        self._rehearse()

    def reset(self) -> None:
        """Make the meat whole again."""
        n = self.meat.links.count
        self._alive, self._cut = np.ones(n, dtype=bool), np.zeros(n, dtype=bool)
        self._damage = np.zeros(n)
        self._muscle_cut_length = 0.0
        self._indentation = Indentation()
        self._knife_force = np.zeros(3)

    def _rehearse(self) -> None:
        """Meet the seam once in thought: kernels compile before the clock runs."""
        ends, ahead = self.meat.links.ends, np.array([1e-3, 0.0, 0.0])
        tip = ends[0].mean(axis=0)
        met = self._incision.ahead(ends, self._alive, self._energy, tip, ahead)
        met.mean(ends)
        met.share(self._forces, np.zeros(3))

    def apply(self, data: mujoco.MjData, before: Array, tip: Array) -> None:
        """Advance damage and cuts, and apply all forces of this step.

        Args:
            data: the state, kinematics up to date.
            before: (3,) the knife's tip one step ago [m].
            tip: (3,) the knife's tip now [m].
        """
        (x1, v1), (x2, v2) = (side.read(data) for side in self._sides)
        hit = cut(before, tip, x1, x2, self._width)
        self._cut[hit] |= self._alive[hit]
        self._alive[hit] = False
        forces, energy = self._forces, self._energy
        law = self._law
        pull((x1, x2), (v1, v2), *law, self._damage, self._alive, forces, energy)
        motion = tip - before
        reaction = self._incision.ahead((x1, x2), self._alive, energy, tip, motion)
        if self._knife is not None:
            edge = self._knife.edge(data)
            against = motion - self._step * reaction.mean((v1, v2))
            limit = reaction.limit(against, edge, self.meat.toughness)
            felt = self._indentation.force(against, limit)
            self._knife.feel(data, felt, tip - 0.5 * reaction.depth * edge)
            reaction.share(forces, -felt)
            self._knife_force = felt
        if reaction.in_muscle:
            self._muscle_cut_length += float(np.hypot(motion[0], motion[1]))
        for side, total in zip(self._sides, forces, strict=True):
            side.push(data, total)

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
        return float((a2 - a1 - self._rest)[:, 1].mean())

    @property
    def alive(self) -> BoolArray:
        """(N,) which links still hold."""
        return self._alive.copy()

    @property
    def links_cut_fraction(self) -> float:
        """Share of the links that no longer hold, cut or torn."""
        return float(1.0 - self._alive.mean())

    @property
    def links_torn_fraction(self) -> float:
        """Share of the links that were torn by the pull, not cut by the knife."""
        return float((~self._alive & ~self._cut).mean())

    @property
    def separated(self) -> bool:
        """Whether no link holds."""
        return not self._alive.any()

    @property
    def muscle_cut_length(self) -> float:
        """Way of the knife in the xy plane inside a muscle, beside the seam [m]."""
        return self._muscle_cut_length

    @property
    def knife_force(self) -> Array:
        """Force (3,) of the meat on the knife in the last step [N]."""
        return self._knife_force.copy()
