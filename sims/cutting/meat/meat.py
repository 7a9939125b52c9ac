"""A piece of meat: its shape, what it is made of, and its place in a scene."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, final

import mujoco
import numpy as np
from numpy.typing import ArrayLike

from sims.cutting.meat.animal import Animal
from sims.cutting.meat.flex import CELLS, add_muscle, node_body
from sims.cutting.meat.links import Links
from sims.cutting.meat.meshfile import read_surface
from sims.cutting.meat.scan import Seam, sheets_of
from sims.cutting.meat.sheets import Sheets
from sims.cutting.meat.texture import fibres
from wbc import InputError, UnknownName
from wbc.arrays import Array, frozen, positive, rotation

__all__ = ["Meat", "Toughness"]

DENSITY: Final = 1060.0
"""[kg/m^3]"""
LINKS: Final = (33, 9)
"""Links along the seam and up: 297."""
PLACE: Final = (0.52, 0.12)
"""Where the seam's middle lies (x, y) [m]: within reach of both arms."""
TABLE: Final = 0.27
"""Height of the table [m]."""
HELD: Final = "held"
PULLED: Final = "pulled"
LOOKS: Final = {HELD: 0, PULLED: 1}
"""Seeds of the images."""


@final
@dataclass(frozen=True, slots=True)
class Toughness:
    """What it takes to cut (facts of P0's field: Purslow, Atkins, CJME 2022).

    Attributes:
        seam: fracture toughness of the aponeurosis under a sharp blade [J/m^2].
        muscle: of the muscle beside it [J/m^2].
        friction: of the blade's sides [-].
        pressure: of the tissue on the blade's sides [Pa].

    Raises:
        InputError: a negative number.
    """

    seam: float = 300.0
    muscle: float = 1500.0
    friction: float = 0.3
    pressure: float = 2000.0

    def __post_init__(self) -> None:
        for name in ("seam", "muscle", "friction", "pressure"):
            positive(getattr(self, name), name, zero=True)


@final
@dataclass(frozen=True, slots=True, eq=False)
class Meat:
    """Two muscles, one held at its outer face, joined along a seam.

    Attributes:
        sheets: the shape.
        links: the aponeurosis.
        young: modulus of the muscles [Pa].
        poisson: Poisson's ratio.
        damping: Rayleigh damping of the muscles [s].
        toughness: what it takes to cut.

    Raises:
        InputError: a modulus that is not positive, or an impossible Poisson's ratio.
    """

    sheets: Sheets
    links: Links
    young: float
    poisson: float = 0.3
    damping: float = 0.01
    toughness: Toughness = field(default_factory=Toughness)

    def __post_init__(self) -> None:
        positive(self.young, "young")
        positive(self.damping, "damping", zero=True)
        if not 0.0 <= self.poisson < 0.5:
            raise InputError(f"poisson must be in 0 .. 0.5, got {self.poisson}.")

    @classmethod
    def generate(
        cls,
        seed: int = 0,
        *,
        links: tuple[int, int] = LINKS,
        place: tuple[float, float] = PLACE,
        table: float = TABLE,
        toughness: Toughness | None = None,
    ) -> Meat:
        """The shoulder of the animal that a seed stands for.

        Args:
            seed: decides shape, stiffness, link strength and fibre offsets.
            links: number of links along the seam and up.
            place: (x, y) of the seam's middle [m].
            table: height of the table [m].
            toughness: what it takes to cut.

        Raises:
            InputError: fewer than 2 by 2 links.
        """
        animal = Animal.draw(seed)
        sheets = animal.sheets(frozen(place, (2,), "place"), table)
        return cls._of(sheets, animal, links, toughness)

    @classmethod
    def from_mesh(
        cls,
        path: str | Path,
        seam: Seam | None = None,
        *,
        scale: float = 1.0,
        seed: int = 0,
        links: tuple[int, int] = LINKS,
        place: tuple[float, float] = PLACE,
        table: float = TABLE,
        toughness: Toughness | None = None,
    ) -> Meat:
        """Meat of a scanned shape, x along the seam, y across it, z upwards.

        Args:
            path: closed surface in an .stl or .obj file.
            seam: cutting surface y = s(x, z) in the coordinates of the file times
                scale [m]; an upright plane through the middle by default.
            scale: metres per unit of the file, 0.001 for millimetres.
            seed: decides stiffness, link strength and fibre offsets.
            links: number of links along the seam and up.
            place: (x, y) of the seam's middle on the table [m].
            table: height of the table [m].
            toughness: what it takes to cut.

        Raises:
            InputError: a file that cannot be read; a surface that is open, crosses
                itself or is in pieces; or a cutting surface outside the meat.
        """
        surface, animal = read_surface(path, scale), Animal.draw(seed)
        middle = surface.vertices.mean(axis=0)[1]
        found = sheets_of(surface, seam or (lambda x, z: np.full(x.shape, middle)))
        at = frozen(place, (2,), "place")
        centre = found.seam[found.seam.shape[0] // 2, found.seam.shape[1] // 2]
        mid_x = 0.5 * (found.seam[0, 0, 0] + found.seam[-1, 0, 0])
        move = [at[0] - mid_x, at[1] - centre[1], table - found.table]
        sheets = Sheets(found.fixed + move, found.seam + move, found.pulled + move)
        return cls._of(sheets, animal, links, toughness)

    @classmethod
    def _of(
        cls,
        sheets: Sheets,
        animal: Animal,
        grid: tuple[int, int],
        toughness: Toughness | None,
    ) -> Meat:
        links = Links.across(sheets, animal, grid)
        return cls(sheets, links, animal.young, toughness=toughness or Toughness())

    def add_to(self, spec: mujoco.MjSpec) -> None:
        """Add the muscles to a scene, and choose the integrator that suits them.

        That is "discrete", implicit in the stiffness and damping of the muscles. Under
        "Euler" a step takes half the time, with the same results, for a modulus of up
        to 6e4 Pa at a damping of 0.01 s, which generated meat does not reach; stiffer
        meat shakes itself apart.

        Keyframes of the scene go: they know nothing of the muscles' coordinates.
        """
        for name, muscle in zip((HELD, PULLED), self.sheets.muscles(), strict=True):
            add_muscle(
                spec,
                name,
                muscle,
                young=self.young,
                poisson=self.poisson,
                damping=self.damping,
                mass=DENSITY * muscle.volume,
                look=fibres(LOOKS[name]),
                held=name == HELD,
            )
        for key in list(spec.keys):
            spec.delete(key)
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_DISCRETE
        spec.option.solver = mujoco.mjtSolver.mjSOL_NEWTON

    @property
    def grip(self) -> Array:
        """Where the pulled muscle is to be held (3,): middle of its outer face [m]."""
        low, high = self.sheets.muscles()[1].box
        return np.array([0.5 * (low[0] + high[0]), high[1], 0.5 * (low[2] + high[2])])

    def attach(
        self, spec: mujoco.MjSpec, body: str, p: ArrayLike, R: ArrayLike
    ) -> None:
        """Fasten the pulled muscle's outer face to a tool: nine nodes, rigidly.

        Args:
            spec: the scene, with the meat in it.
            body: name of the tool's body.
            p: (3,) where that body will be when the simulation starts [m].
            R: (3, 3) its orientation then.

        Raises:
            UnknownName: there is no such body.
            InputError: p and R are no pose.
        """
        tool = spec.body(body)
        if tool is None:
            raise UnknownName("body", body, [b.name for b in spec.bodies])
        p, R = frozen(p, (3,), "p"), rotation(R, "R")
        nx, ny, nz = CELLS
        for ix in range(1, nx):
            for iz in range(nz + 1):
                name = node_body(PULLED, ix, ny, iz)
                node = spec.body(name)
                node.add_site(name=f"{name}_held", group=4)
                tool.add_site(name=f"{name}_tool", pos=R.T @ (node.pos - p), group=4)
                hold = spec.add_equality(
                    type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_SITE
                )
                hold.name1, hold.name2 = f"{name}_tool", f"{name}_held"
                hold.solref = [0.005, 1.0]
