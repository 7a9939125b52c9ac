"""What a replay draws: the visible shapes of a MuJoCo model, as plain data."""

from __future__ import annotations

import base64
from typing import Any, Final

import mujoco
import numpy as np
from numpy.typing import NDArray

__all__ = ["Store", "geoms", "soft_bodies", "visible_geoms"]

_FIRST_HIDDEN_GROUP: Final = 3  # MuJoCo's own viewer shows groups 0, 1, 2
_UNSET = (0.5, 0.5, 0.5, 1.0)  # colour of a geom that names none
_KINDS: Final = {
    int(mujoco.mjtGeom.mjGEOM_PLANE): "plane",
    int(mujoco.mjtGeom.mjGEOM_SPHERE): "sphere",
    int(mujoco.mjtGeom.mjGEOM_CAPSULE): "capsule",
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID): "ellipsoid",
    int(mujoco.mjtGeom.mjGEOM_CYLINDER): "cylinder",
    int(mujoco.mjtGeom.mjGEOM_BOX): "box",
    int(mujoco.mjtGeom.mjGEOM_MESH): "mesh",
}


class Store:
    """Arrays packed one after another; scenes refer to them by place."""

    def __init__(self) -> None:
        self._bytes = bytearray()

    def add(self, values: NDArray[Any], kind: str) -> dict[str, Any]:
        """Where `values` are now, as little-endian `kind`: f4, u4 or u2."""
        packed = np.ascontiguousarray(values, dtype=f"<{kind}")
        place = {"kind": kind, "offset": len(self._bytes), "count": packed.size}
        self._bytes += packed.tobytes()
        self._bytes += bytes(-len(self._bytes) % 4)  # arrays start on 4-byte borders
        return place

    def text(self) -> str:
        """Everything stored so far, in base64."""
        return base64.b64encode(self._bytes).decode("ascii")


def visible_geoms(model: mujoco.MjModel) -> list[int]:
    """Indices of the geoms of a shown group that are not fully transparent."""
    return [
        index
        for index in range(model.ngeom)
        if model.geom_group[index] < _FIRST_HIDDEN_GROUP and _rgba(model, index)[3] > 0
    ]


def geoms(
    model: mujoco.MjModel, store: Store
) -> tuple[list[dict[str, Any]], list[str]]:
    """Shapes in their bodies' frames, and the names of those that cannot be drawn."""
    shapes: list[dict[str, Any]] = []
    undrawn: list[str] = []
    meshes: dict[int, dict[str, Any]] = {}
    for index in visible_geoms(model):
        kind = _KINDS.get(int(model.geom_type[index]))
        if kind is None:
            name = _name(model, mujoco.mjtObj.mjOBJ_GEOM, index)
            undrawn.append(f"geom '{name}'")
            continue
        shape = {
            "body": int(model.geom_bodyid[index]),
            "kind": kind,
            "size": model.geom_size[index].tolist(),
            "position": model.geom_pos[index].tolist(),
            "quaternion": np.roll(model.geom_quat[index], -1).tolist(),
            "rgba": _rgba(model, index),
        }
        if kind == "mesh":
            mesh = int(model.geom_dataid[index])
            if mesh not in meshes:
                meshes[mesh] = _mesh(model, mesh, store)
            shape |= meshes[mesh]
        shapes.append(shape)
    return shapes, undrawn


def soft_bodies(
    model: mujoco.MjModel, vertices: NDArray[Any], store: Store
) -> tuple[list[dict[str, Any]], list[str]]:
    """Deformable surfaces that follow `vertices` (F, V, 3) [m] of the F frames.

    Coordinates are stored as 16-bit steps of the range that they cover: below 0.02 mm
    for a range of 1 m. Also returns the names of what cannot be drawn.
    """
    surfaces: list[dict[str, Any]] = []
    undrawn = [
        f"skin '{_name(model, mujoco.mjtObj.mjOBJ_SKIN, i)}'"
        for i in range(model.nskin)
    ]
    for index in range(model.nflex):
        faces = _surface(model, index)
        name = _name(model, mujoco.mjtObj.mjOBJ_FLEX, index)
        if model.flex_group[index] >= _FIRST_HIDDEN_GROUP:
            continue
        if faces is None:
            undrawn.append(f"flex '{name}'")
            continue
        first = model.flex_vertadr[index]
        part = vertices[:, first : first + model.flex_vertnum[index]]
        low = part.min(axis=(0, 1))
        step = np.maximum(part.max(axis=(0, 1)) - low, 1e-9) / 65535.0
        surfaces.append(
            {
                "name": f"flex {name}",
                "rgba": _flex_rgba(model, index),
                "faces": store.add(faces, "u4"),
                "vertices": store.add(np.rint((part - low) / step), "u2"),
                "low": low.tolist(),
                "step": step.tolist(),
            }
        )
    return surfaces, undrawn


def _name(model: mujoco.MjModel, kind: mujoco.mjtObj, index: int) -> str:
    return mujoco.mj_id2name(model, kind, index) or str(index)


def _mesh(model: mujoco.MjModel, mesh: int, store: Store) -> dict[str, Any]:
    vertex, face = model.mesh_vertadr[mesh], model.mesh_faceadr[mesh]
    vertices = model.mesh_vert[vertex : vertex + model.mesh_vertnum[mesh]]
    faces = model.mesh_face[face : face + model.mesh_facenum[mesh]]
    return {"vertices": store.add(vertices, "f4"), "faces": store.add(faces, "u4")}


def _surface(model: mujoco.MjModel, flex: int) -> NDArray[np.int32] | None:
    """Triangles (K, 3) of a sheet, or of the boundary of a solid; none for a cable."""
    if model.flex_dim[flex] == 2:
        begin, count = model.flex_elemdataadr[flex], model.flex_elemnum[flex]
        return np.reshape(model.flex_elem[begin : begin + 3 * count], (-1, 3))
    if model.flex_dim[flex] == 3:
        begin, count = model.flex_shelldataadr[flex], model.flex_shellnum[flex]
        return np.reshape(model.flex_shell[begin : begin + 3 * count], (-1, 3))
    return None


def _rgba(model: mujoco.MjModel, geom: int) -> Any:
    """Colour as MuJoCo draws it; a texture counts by its mean colour."""
    return _painted(model, model.geom_rgba[geom], int(model.geom_matid[geom]))


def _flex_rgba(model: mujoco.MjModel, flex: int) -> Any:
    """The same for a deformable body, by its first element's material."""
    each = model.flex_matid.size == model.nflexelem  # one a body before MuJoCo 4
    where = int(model.flex_elemadr[flex]) if each else flex
    return _painted(model, model.flex_rgba[flex], int(model.flex_matid[where]))


def _painted(model: mujoco.MjModel, own: NDArray[np.float32], material: int) -> Any:
    if material < 0:
        return own.tolist()
    rgba = model.mat_rgba[material] if tuple(own) == _UNSET else own
    return (rgba * _mean_texture(model, material)).tolist()


def _mean_texture(model: mujoco.MjModel, material: int) -> NDArray[np.float64]:
    textures = np.atleast_1d(model.mat_texid[material])
    used = textures[textures >= 0]
    mean = np.ones(4)
    if used.size:
        texture = int(used[0])
        channels, begin = int(model.tex_nchannel[texture]), int(model.tex_adr[texture])
        size = int(model.tex_height[texture]) * int(model.tex_width[texture]) * channels
        pixels = model.tex_data[begin : begin + size].reshape(-1, channels)
        mean[: min(channels, 3)] = pixels.mean(axis=0)[:3] / 255.0
    return mean
