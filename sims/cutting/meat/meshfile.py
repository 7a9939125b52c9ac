"""Reading a surface from an STL or OBJ file."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np

from sims.cutting.meat.surface import Surface
from wbc import InputError
from wbc.arrays import Array, IntArray, positive

__all__ = ["read_surface"]

HEADER: Final = 84
"""Bytes before the facets of a binary STL."""
FACET: Final = np.dtype(
    [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")]
)
WELD: Final = 1e-6
"""STL corners closer than this share of the surface's size are one vertex."""


def read_surface(path: str | Path, scale: float = 1.0) -> Surface:
    """Read a surface.

    Args:
        path: an .stl (binary or text) or .obj file.
        scale: metres per unit of the file, 0.001 for millimetres.

    Raises:
        InputError: no such file, another kind of file, not readable, or a surface
            that is open, self-crossing or in pieces.
    """
    path = Path(path)
    readers = {".stl": _stl, ".obj": _obj}
    if path.suffix.lower() not in readers:
        raise InputError(f"'{path}' is not an .stl or .obj file.")
    if not path.is_file():
        raise InputError(f"there is no mesh file '{path}'.")
    try:
        vertices, faces = readers[path.suffix.lower()](path.read_bytes())
    except (ValueError, IndexError) as error:
        raise InputError(f"'{path}' cannot be read as a mesh: {error}") from error
    if not len(faces):
        raise InputError(f"'{path}' holds no triangles.")
    try:
        return Surface(vertices * positive(scale, "scale"), faces)
    except InputError as error:
        raise InputError(f"'{path}': {error}") from error


def _stl(content: bytes) -> tuple[Array, IntArray]:
    count = int.from_bytes(content[HEADER - 4 : HEADER], "little")
    if len(content) == HEADER + FACET.itemsize * count:
        facets = np.frombuffer(content, FACET, count, HEADER)
        corners = facets["corners"].astype(np.float64).reshape(-1, 3)
    else:
        words = content.decode("ascii").split()
        places = [i + 1 for i, word in enumerate(words) if word == "vertex"]
        corners = np.array([words[i : i + 3] for i in places], dtype=np.float64)
        corners = corners.reshape(-1, 3)
    if len(corners) % 3:
        raise ValueError("a facet does not have three corners")
    if not len(corners):
        return corners, np.zeros((0, 3), dtype=np.int_)
    grain = WELD * max(float(np.ptp(corners, axis=0).max()), 1e-300)
    _, first, index = np.unique(
        np.round((corners - corners.min(axis=0)) / grain),
        axis=0,
        return_index=True,
        return_inverse=True,
    )
    return corners[first], index.reshape(-1, 3)


def _obj(content: bytes) -> tuple[Array, IntArray]:
    vertices: list[list[float]] = []
    faces: list[list[int]] = []
    for line in content.decode("utf-8", "replace").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [_index(word, len(vertices)) for word in words[1:]]
            faces += [
                [corners[0], *corners[k : k + 2]] for k in range(1, len(corners) - 1)
            ]
    return (
        np.array(vertices, dtype=np.float64).reshape(-1, 3),
        np.array(faces, dtype=np.int_).reshape(-1, 3),
    )


def _index(word: str, count: int) -> int:
    """Of a corner such as 7, 7/2/3 or -1; OBJ counts from 1, or back from the end."""
    number = int(word.split("/")[0])
    index = number - 1 if number > 0 else count + number
    if not 0 <= index < count:
        raise ValueError(f"a face names vertex {number} of {count}")
    return index
