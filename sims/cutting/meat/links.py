"""The aponeurosis: spring-damper links between the muscles, with damage."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from sims.cutting.meat.animal import Animal
from sims.cutting.meat.sheets import Sheets
from wbc import InputError
from wbc.arrays import Array, BoolArray
from wbc.compiled import compiled

__all__ = ["Links", "damage", "pull"]

DAMPING_TIME: Final = 3e-3
"""Damping over stiffness of a link [s]."""
PATCHINESS: Final = 0.25
"""Largest deviation of stiffness and strength from place to place."""
FIBRE: Final = 2e-3
"""Largest offset between the two ends of a link at rest [m]."""
DUCTILITY: Final = 2.0
"""Stretch at which a link has torn, over that at which it begins to."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Links:
    """N links on a grid of nu by nw places of the seam, index u * nw + w.

    A link's force is its stiffness times (a2 - a1 - rest), plus damping.

    Attributes:
        grid: (nu, nw).
        ends: (N, 3), (N, 3) material points of the held and the pulled muscle, in the
            unloaded meat [m]; rest = ends[1] - ends[0].
        area: (N,) of the seam that each one stands for [m^2].
        stiffness: (N,) [N/m].
        damping: (N,) [N s/m].
        onset: (N,) stretch at which it begins to tear [m].
        behind: (N,), (N,) thickness of the two muscles there, along y [m].
    """

    grid: tuple[int, int]
    ends: tuple[Array, Array]
    area: Array
    stiffness: Array
    damping: Array
    onset: Array
    behind: tuple[Array, Array]

    @classmethod
    def across(cls, sheets: Sheets, animal: Animal, grid: tuple[int, int]) -> Links:
        """Links over the whole seam.

        Raises:
            InputError: a grid that is not two whole numbers from 2 on.
        """
        if len(grid) != 2 or min(grid) < 2 or any(int(n) != n for n in grid):
            raise InputError(f"links must be two whole numbers from 2 on, got {grid}.")
        u, w = (a.ravel() for a in np.meshgrid(*map(_middles, grid), indexing="ij"))
        points = sheets.on_seam(u, w)
        stiffer, stronger, *shifts = (field(u, w) for field in animal.patches)
        area = _areas(sheets, grid)
        density = animal.link_stiffness * (1.0 + PATCHINESS * stiffer)
        strength = animal.strength * (1.0 + PATCHINESS * stronger)
        # The ends stay on the seam: fibres lean along it, they do not stand off.
        span = (np.ptp(sheets.seam[..., 0]), np.ptp(sheets.seam[..., 2]))
        leaning = [
            np.clip(place + FIBRE * shift / length, 0.0, 1.0)
            for place, shift, length in zip((u, w), shifts, span, strict=True)
        ]
        stiffness = density * area
        return cls(
            grid,
            (points, sheets.on_seam(*leaning)),
            area,
            stiffness,
            DAMPING_TIME * stiffness,
            strength / density,
            sheets.behind(u, w),
        )

    @property
    def count(self) -> int:
        """N"""
        return self.area.size

    @property
    def rest(self) -> Array:
        """(N, 3) from the held to the pulled end in the unloaded meat [m]."""
        return self.ends[1] - self.ends[0]


@compiled
def damage(stretch: float, onset: float) -> float:
    """How much of its stiffness a link has lost at a stretch [m]: 0 to 1.

    Bilinear cohesive law: the force rises to the onset and then falls on a line to 0.
    Unloading goes straight back to rest: the link recoils with what is left of it.
    """
    s = max(stretch / onset, 1.0)
    return min(DUCTILITY * (s - 1.0) / (s * (DUCTILITY - 1.0)), 1.0)


@compiled
def pull(
    x: tuple[Array, Array],
    v: tuple[Array, Array],
    rest: Array,
    properties: tuple[Array, Array, Array],
    suffered: Array,
    alive: BoolArray,
    forces: tuple[Array, Array],
    energy: Array,
) -> None:
    """Forces of the links on the two muscles, after the damage of this instant.

    Args:
        x: (N, 3), (N, 3) where the ends are [m].
        v: (N, 3), (N, 3) their velocities [m/s].
        rest: (N, 3) from end to end at rest [m].
        properties: (N,) stiffness [N/m], damping [N s/m] and onset [m].
        suffered: (N,) damage so far; grows.
        alive: (N,) which links hold; those that tear now no longer do.
        forces: (N, 3), (N, 3) on the held and on the pulled end [N]; written.
        energy: (N,) stored in each link [J]; written.
    """
    (x1, x2), (v1, v2), (on_held, on_pulled) = x, v, forces
    stiffness, damping, onset = properties
    for i in range(alive.size):
        r0 = x2[i, 0] - x1[i, 0] - rest[i, 0]
        r1 = x2[i, 1] - x1[i, 1] - rest[i, 1]
        r2 = x2[i, 2] - x1[i, 2] - rest[i, 2]
        stretch2 = r0 * r0 + r1 * r1 + r2 * r2
        suffered[i] = max(suffered[i], damage(np.sqrt(stretch2), onset[i]))
        alive[i] = alive[i] and suffered[i] < 1.0
        left = 1.0 - suffered[i] if alive[i] else 0.0
        k, c = left * stiffness[i], left * damping[i]
        on_held[i, 0] = k * r0 + c * (v2[i, 0] - v1[i, 0])
        on_held[i, 1] = k * r1 + c * (v2[i, 1] - v1[i, 1])
        on_held[i, 2] = k * r2 + c * (v2[i, 2] - v1[i, 2])
        for j in range(3):
            on_pulled[i, j] = -on_held[i, j]
        energy[i] = 0.5 * k * stretch2


def _middles(count: int) -> Array:
    return (np.arange(count) + 0.5) / count


def _areas(sheets: Sheets, grid: tuple[int, int]) -> Array:
    corners = np.meshgrid(*(np.linspace(0.0, 1.0, n + 1) for n in grid), indexing="ij")
    p = sheets.on_seam(*(c.ravel() for c in corners)).reshape(grid[0] + 1, -1, 3)
    across, other = p[1:, 1:] - p[:-1, :-1], p[1:, :-1] - p[:-1, 1:]
    return np.asarray(0.5 * np.linalg.norm(np.cross(across, other), axis=-1).ravel())
