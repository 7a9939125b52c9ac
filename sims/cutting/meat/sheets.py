"""The shape of the meat: three sheets, and the two muscles between them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import ArrayLike

from wbc import InputError
from wbc.arrays import Array, IntArray, frozen

__all__ = ["Muscle", "Sheets"]

THINNEST: Final = 2e-3
"""Least thickness of a muscle at its seam [m]; less is a seam outside the meat."""
LAYERS: Final = 2
"""Of vertices from outer face to seam: flexes have their own grid, more only cost."""
KUHN: Final = (
    (0, 1, 3, 7),
    (0, 1, 7, 5),
    (0, 5, 7, 4),
    (0, 3, 2, 7),
    (0, 2, 6, 7),
    (0, 6, 4, 7),
)
"""Six tetrahedra of a cube whose corner 4a + 2b + c is at (a, b, c)."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Muscle:
    """A volume of tetrahedra.

    Attributes:
        vertices: (k, 3) in the world [m].
        elements: (e, 4) indices of vertices, positively oriented.
        depth: (k,) share of the way from the outer face to the seam.
    """

    vertices: Array
    elements: IntArray
    depth: Array

    @property
    def volume(self) -> float:
        """[m^3]"""
        corners = self.vertices[self.elements]
        return float(np.linalg.det(corners[:, 1:] - corners[:, :1]).sum() / 6.0)

    @property
    def box(self) -> tuple[Array, Array]:
        """Lowest and highest coordinates (3,), (3,) [m]."""
        return self.vertices.min(axis=0), self.vertices.max(axis=0)


@final
@dataclass(frozen=True, slots=True, eq=False)
class Sheets:
    """Fixed outer face, seam, and pulled outer face, point by point along y.

    The first index of a sheet runs along x, the second from the table upwards; points
    of equal indices have equal x and z, and y grows from sheet to sheet.

    Attributes:
        fixed: (nu, nw, 3) outer face of the muscle that is held [m].
        seam: (nu, nw, 3) where the muscles meet [m].
        pulled: (nu, nw, 3) outer face of the muscle that is pulled [m].

    Raises:
        InputError: shapes that differ, values that are not finite, columns out of
            order, or a seam outside the meat.
    """

    fixed: Array
    seam: Array
    pulled: Array

    def __post_init__(self) -> None:
        shape = np.shape(self.seam)
        if len(shape) != 3 or shape[2] != 3 or min(shape[:2]) < 2:
            raise InputError(
                f"a sheet must be (nu, nw, 3), at least (2, 2, 3): {shape}."
            )
        for name in ("fixed", "seam", "pulled"):
            sheet = frozen(getattr(self, name), shape, f"sheet '{name}'")
            object.__setattr__(self, name, sheet)
            if not np.allclose(sheet[..., ::2], self.seam[..., ::2], rtol=0, atol=1e-9):
                raise InputError(f"sheet '{name}' has other x and z than the seam.")
        along, up = (
            np.diff(self.seam[..., 0], axis=0),
            np.diff(self.seam[..., 2], axis=1),
        )
        if (along <= 0).any() or (up <= 0).any():
            raise InputError(
                "x must grow with a sheet's first index, z with its second."
            )
        self._check_seam()

    def _check_seam(self) -> None:
        for name, depth in (
            ("fixed", self.seam[..., 1] - self.fixed[..., 1]),
            ("pulled", self.pulled[..., 1] - self.seam[..., 1]),
        ):
            if depth.min() < THINNEST:
                u, w = np.unravel_index(int(depth.argmin()), depth.shape)
                x, y, z = self.seam[u, w]
                raise InputError(
                    f"the cutting surface leaves the meat on its {name} side at "
                    f"({x:.3f}, {y:.3f}, {z:.3f}) m, by {THINNEST - depth.min():.4f} m "
                    f"(each muscle must be at least {THINNEST} m thick there): move "
                    "or bend the surface."
                )

    def muscles(self) -> tuple[Muscle, Muscle]:
        """The muscle that is held and the one that is pulled."""
        return _between(self.fixed, self.seam), _between(self.pulled, self.seam)

    def on_seam(self, u: ArrayLike, w: ArrayLike) -> Array:
        """Points (k, 3) of the seam, at shares u (k,) along it and w (k,) upwards."""
        return _bilinear(self.seam, np.asarray(u, float), np.asarray(w, float))

    def behind(self, u: ArrayLike, w: ArrayLike) -> tuple[Array, Array]:
        """Thickness (k,), (k,) of the two muscles along y, at the same shares [m]."""
        u, w = np.asarray(u, float), np.asarray(w, float)
        held, pulled = (
            _bilinear(b - a, u, w)[:, 1]
            for a, b in ((self.fixed, self.seam), (self.seam, self.pulled))
        )
        return held, pulled

    @property
    def table(self) -> float:
        """Height of the lowest point [m]."""
        return float(self.seam[..., 2].min())

    @property
    def top(self) -> float:
        """Height of the highest point [m]."""
        return float(self.seam[..., 2].max())


def _between(outer: Array, seam: Array) -> Muscle:
    share = np.linspace(0.0, 1.0, LAYERS)[:, None]
    # (nu, LAYERS, nw, 3)
    lattice = outer[:, None] + share[..., None] * (seam - outer)[:, None]
    count = lattice.shape[:3]
    index = np.arange(np.prod(count)).reshape(count)
    corners = np.stack(
        [
            index[
                i : count[0] - 1 + i, j : count[1] - 1 + j, k : count[2] - 1 + k
            ].ravel()
            for i in (0, 1)
            for j in (0, 1)
            for k in (0, 1)
        ],
        axis=1,
    )
    elements = corners[:, KUHN].reshape(-1, 4)
    vertices = lattice.reshape(-1, 3)
    edges = vertices[elements[:, 1:]] - vertices[elements[:, :1]]
    flipped = np.linalg.det(edges) < 0
    elements[flipped] = elements[flipped][:, [0, 1, 3, 2]]
    depth = np.broadcast_to(share, count).ravel()
    return Muscle(vertices, elements, depth)


def _bilinear(sheet: Array, u: Array, w: Array) -> Array:
    nu, nw = sheet.shape[:2]
    i = np.clip((u * (nu - 1)).astype(int), 0, nu - 2)
    j = np.clip((w * (nw - 1)).astype(int), 0, nw - 2)
    s, t = (u * (nu - 1) - i)[:, None], (w * (nw - 1) - j)[:, None]
    low = (1 - s) * sheet[i, j] + s * sheet[i + 1, j]
    high = (1 - s) * sheet[i, j + 1] + s * sheet[i + 1, j + 1]
    return np.asarray((1 - t) * low + t * high)
