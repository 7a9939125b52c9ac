"""A closed surface of triangles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from sims.cutting.meat.crossing import crossing
from wbc import InputError
from wbc.arrays import Array, IntArray, frozen

__all__ = ["Surface"]

MOST: Final = 60_000
"""Triangles of which self-crossing can be searched in seconds."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """A closed surface in one piece that does not cross itself, normals outwards.

    Attributes:
        vertices: (k, 3) [m].
        faces: (f, 3) indices of vertices.

    Raises:
        InputError: open, folded over, in pieces, self-crossing, not finite, or of too
            many triangles.
    """

    vertices: Array
    faces: IntArray

    def __post_init__(self) -> None:
        vertices = frozen(self.vertices, np.shape(self.vertices), "vertices")
        faces = np.array(self.faces)
        if len(faces) > MOST:
            raise InputError(
                f"the mesh has {len(faces)} triangles: simplify it to at most {MOST}."
            )
        flat = (faces == np.roll(faces, 1, axis=1)).any(axis=1)
        faces = faces[~flat]
        _check_closed(vertices, faces)
        _check_one_piece(len(vertices), faces)
        corners = vertices[faces]
        pair = crossing(corners)
        if pair is not None:
            x, y, z = corners[pair[0]].mean(axis=0)
            raise InputError(
                f"the mesh crosses itself near ({x:.4g}, {y:.4g}, {z:.4g}) m "
                f"(triangles {pair[0]} and {pair[1]}): repair it."
            )
        if _volume(corners) < 0.0:
            faces = faces[:, ::-1]
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)

    @property
    def corners(self) -> Array:
        """(f, 3, 3) of the triangles [m]."""
        return np.asarray(self.vertices[self.faces])

    @property
    def volume(self) -> float:
        """[m^3]"""
        return _volume(self.corners)


def _volume(corners: Array) -> float:
    return float(np.linalg.det(corners).sum() / 6.0)


def _check_closed(vertices: Array, faces: IntArray) -> None:
    """Every edge belongs to two triangles, which run along it in opposite ways."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    ways, runs = np.unique(edges, axis=0, return_counts=True)
    both, count = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    for bad, what in (
        (both[count == 1], "is open: {} edges belong to one triangle only"),
        (both[count > 2], "is no surface: {} edges belong to more than two triangles"),
        (ways[runs > 1], "is wound both ways: {} edges have neighbours that disagree"),
    ):
        if len(bad):
            x, y, z = vertices[bad[0]].mean(axis=0)
            raise InputError(
                f"the mesh {what.format(len(bad))}, such as that at ({x:.4g}, "
                f"{y:.4g}, {z:.4g}) m. It must be closed: repair it."
            )


def _check_one_piece(vertices: int, faces: IntArray) -> None:
    rows, columns = faces.ravel(), np.roll(faces, 1, axis=1).ravel()
    graph = coo_array((np.ones(rows.size), (rows, columns)), (vertices, vertices))
    _, label = connected_components(graph, directed=False)
    pieces = np.unique(label[faces[:, 0]]).size
    if pieces > 1:
        raise InputError(f"the mesh is in {pieces} pieces: keep one.")
