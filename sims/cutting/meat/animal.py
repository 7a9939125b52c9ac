"""What differs from animal to animal, drawn from a seed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from sims.cutting.meat.sheets import Sheets
from wbc import InputError
from wbc.arrays import Array

__all__ = ["Animal", "Field"]

WAVES: Final = 3
"""Harmonics of a random field along the seam and up."""
GRID: Final = (17, 7)
"""Points of a sheet along x and up."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Field:
    """A smooth random function of the place on the seam, within -1 and 1.

    The same whatever the number of links, so that a finer model is one of the same
    animal.

    Attributes:
        weights: (WAVES, WAVES) of cosines, absolute values adding up to 1.
        phases: (WAVES, WAVES) [rad].
    """

    weights: Array
    phases: Array

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Field:
        """A random field."""
        weights = rng.normal(size=(WAVES, WAVES))
        phases = rng.uniform(0.0, 2.0 * np.pi, (WAVES, WAVES))
        return cls(weights / np.abs(weights).sum(), phases)

    def __call__(self, u: Array, w: Array) -> Array:
        """Values (k,) at shares u (k,) of the length, w (k,) of the height."""
        waves = np.arange(1, WAVES + 1)
        arguments = np.pi * (
            u[:, None, None] * waves[:, None] + w[:, None, None] * waves
        )
        return np.asarray((self.weights * np.cos(arguments + self.phases)).sum((1, 2)))


@final
@dataclass(frozen=True, slots=True, eq=False)
class Animal:
    """One animal's shoulder, in the coordinates xi, zeta in -1 .. 1 of its seam.

    Attributes:
        length: along x [m].
        height: of the seam's middle [m].
        widths: of the held and of the pulled muscle in the middle [m].
        bend: (3,) of s = bend . (xi, xi^2, xi^3) + ... [m].
        tilt: (3,) of ... + tilt . (zeta, xi zeta, zeta^2) [m].
        hump: (2,) of the height: 1 + hump . (xi, xi^2).
        young: modulus of the muscles [Pa].
        link_stiffness: of the aponeurosis, per area of seam [N/m^3].
        strength: stress at which the aponeurosis begins to tear [Pa].
        patches: four fields: stiffness, strength, and fibre offsets along x and z.
    """

    length: float
    height: float
    widths: tuple[float, float]
    bend: Array
    tilt: Array
    hump: Array
    young: float
    link_stiffness: float
    strength: float
    patches: tuple[Field, Field, Field, Field]

    @classmethod
    def draw(cls, seed: int) -> Animal:
        """The animal of a seed.

        Moduli are of the order of 10 to 30 kPa and above that relaxed muscle shows in
        tension; strengths are those of perimysium times the factor 3 that Swatland
        (2006) found for aponeurosis. The seam's stiffness lets it open by about 5 mm
        under 100 N.

        Raises:
            InputError: a seed that is not a whole number from 0 on.
        """
        if int(seed) != seed or seed < 0:
            raise InputError(f"seed must be a whole number from 0 on, got {seed}.")
        rng = np.random.default_rng(seed)
        return cls(
            length=rng.uniform(0.26, 0.29),
            height=rng.uniform(0.089, 0.093),
            widths=(rng.uniform(0.095, 0.12), rng.uniform(0.095, 0.12)),
            bend=rng.uniform(-1.0, 1.0, 3) * [0.012, 0.018, 0.004],
            tilt=rng.uniform(-1.0, 1.0, 3) * [0.004, 0.002, 0.001],
            hump=rng.uniform(-1.0, 1.0, 2) * 0.02,
            young=rng.uniform(3e4, 5.5e4),
            link_stiffness=rng.uniform(0.65e6, 1.0e6),
            strength=rng.uniform(6.5e4, 9e4),
            patches=(
                Field.draw(rng), Field.draw(rng), Field.draw(rng), Field.draw(rng),
            ),
        )  # fmt: skip

    def sheets(self, middle: Array, table: float) -> Sheets:
        """The shape, its seam's middle above (x, y) = middle (2,) [m] on the table."""
        xi = np.linspace(-1.0, 1.0, GRID[0])[:, None]
        zeta = np.linspace(-1.0, 1.0, GRID[1])[None, :]
        x = middle[0] + 0.5 * self.length * xi + 0.0 * zeta
        height = self.height * (1.0 + self.hump[0] * xi + self.hump[1] * xi**2)
        z = table + 0.5 * height * (1.0 + zeta)
        seam = middle[1] + sum(c * xi**k for k, c in enumerate(self.bend, 1))
        seam = seam + (
            self.tilt[0] * zeta + self.tilt[1] * xi * zeta + self.tilt[2] * zeta**2
        )
        round_off = _superellipse(xi, 2.5, 0.45) * _superellipse(zeta, 4.0, 0.75)
        y = seam, seam - self.widths[0] * round_off, seam + self.widths[1] * round_off
        seam_, fixed, pulled = (np.stack([x, yi, z], axis=-1) for yi in y)
        return Sheets(fixed, seam_, pulled)


def _superellipse(s: Array, power: float, least: float) -> Array:
    """From `least` at |s| = 1 to 1 at 0, flat in the middle."""
    return np.asarray(least + (1 - least) * (1 - np.abs(s) ** power) ** (1 / power))
