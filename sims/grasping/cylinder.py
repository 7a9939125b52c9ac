"""Cylinders that stand in the cell: sizes, poses, and a seeded choice of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from wbc import InputError
from wbc.arrays import Array, positive, rotation

__all__ = ["Cylinder", "seeded_cylinders"]

INSERTION: Final = 0.018
"""How far the fingers reach below the rim [m]."""
RECESS: Final = 0.026
"""Depth of the hollow in a solid cylinder's top, behind its rim [m]."""
FINGER: Final = 0.024
"""Room that the inner finger needs between rim and centre, opened [m]."""
WIDEST: Final = 0.016
"""Thickest wall that the opened fingers pass with room on both sides [m]."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Cylinder:
    """An upright or tilted cylinder with a rim to be grasped at.

    Its frame O lies in the centre of the base, z along the axis.

    Attributes:
        name: how reports call it.
        radius: outer radius [m].
        height: [m]
        wall: thickness of the wall at the rim [m].
        mass: [kg]
        solid: filled up to 26 mm below the rim; a tube, open on both ends, if not.
        p: (3,) p_WO [m].
        R: (3, 3) R_WO.

    Raises:
        InputError: a size that is no cylinder, or that the gripper cannot take.
    """

    name: str
    radius: float
    height: float
    wall: float
    mass: float
    solid: bool
    p: Array
    R: Array

    def __post_init__(self) -> None:
        for size in ("radius", "height", "wall", "mass"):
            positive(getattr(self, size), f"{size} of '{self.name}'")
        rotation(self.R, f"orientation of '{self.name}'")
        if self.wall > WIDEST:
            raise InputError(
                f"wall of '{self.name}' is {self.wall * 1e3:.1f} mm; the gripper opens "
                f"for {WIDEST * 1e3:.0f} mm at most."
            )
        if self.rim < FINGER:
            raise InputError(
                f"'{self.name}' has its rim at radius {self.rim * 1e3:.1f} mm; the "
                f"inner finger needs {FINGER * 1e3:.0f} mm."
            )
        if self.height <= RECESS:
            raise InputError(
                f"'{self.name}' is {self.height * 1e3:.1f} mm high; the fingers reach "
                f"{INSERTION * 1e3:.0f} mm below the rim and need "
                f"{RECESS * 1e3:.0f} mm."
            )

    @property
    def rim(self) -> float:
        """Radius of the middle of the wall [m]: where the tcp belongs."""
        return self.radius - 0.5 * self.wall

    @property
    def axis(self) -> Array:
        """Direction (3,) of the axis, from base to top."""
        return self.R[:, 2]

    @property
    def tilt(self) -> float:
        """Angle of the axis from upright [rad]."""
        return float(np.arccos(np.clip(self.axis[2], -1.0, 1.0)))

    @property
    def top(self) -> Array:
        """Centre (3,) of the top [m]."""
        return self.p + self.height * self.axis


def tilted(tilt: float, towards: float, spin: float) -> Array:
    """R_WO (3, 3) of a cylinder that leans by an angle towards a heading [rad]."""
    c, s = np.cos(tilt), np.sin(tilt)
    lean = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    return turn_z(towards) @ lean @ turn_z(spin - towards)


def turn_z(angle: float) -> Array:
    """Rotation (3, 3) about z [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def seeded_cylinders(seed: int, count: int, base: float) -> list[Cylinder]:
    """Tubes and solid cylinders in turn, every third one tilted.

    Args:
        seed: of sizes and poses.
        count: how many.
        base: height of the surface that an upright one stands on [m].
    """
    rng = np.random.default_rng(seed)
    chosen = []
    for i in range(count):
        solid, leans = bool(i % 2), i % 3 == 2
        tilt = np.radians(rng.uniform(8.0, 20.0)) if leans else 0.0
        R = tilted(tilt, rng.uniform(-np.pi, np.pi), rng.uniform(-np.pi, np.pi))
        p = np.array([rng.uniform(0.62, 0.82), rng.uniform(-0.32, 0.02), base])
        name = f"{i + 1}: {'solid' if solid else 'tube'}{', tilted' if leans else ''}"
        chosen.append(
            Cylinder(
                name,
                radius=float(rng.uniform(0.032, 0.055)),
                height=float(rng.uniform(0.06, 0.12)),
                wall=float(rng.uniform(0.004, 0.009)),
                mass=float(rng.uniform(0.3, 0.7) if solid else rng.uniform(0.15, 0.4)),
                solid=solid,
                p=p,
                R=R,
            )
        )
    return chosen
