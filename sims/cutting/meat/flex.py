"""A muscle as a trilinear flex of MuJoCo, and material points that move with it."""

from __future__ import annotations

import itertools
from typing import Final, final

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from sims.cutting.meat.sheets import Muscle
from wbc.arrays import Array, IntArray
from wbc.compiled import compiled

__all__ = ["CELLS", "MaterialPoints", "add_muscle", "node_body"]

PREFIX: Final = "meat_"
"""Of every name of the meat in a scene; the engine wants one."""
CELLS: Final = (4, 2, 2)
"""Cells of the grid of nodes along x, y, z: within 2 % of a fine mesh statically."""
SUPPORT: Final = 4000.0
"""Vertical stiffness of the table under each lowest node [N/m]."""
RADIUS: Final = 5e-4
"""Thickness of the skin, which only shows [m]."""
IMAGE: Final = 0.3
"""Length of muscle that an image of its fibres covers [m]."""


def add_muscle(
    spec: mujoco.MjSpec,
    name: str,
    muscle: Muscle,
    *,
    young: float,
    poisson: float,
    damping: float,
    mass: float,
    look: NDArray[np.uint8],
    held: bool,
) -> None:
    """Add a flex that slides on the table; one that is held, by its lowest-y face.

    The table is no contact: the muscle's weight is taken by `gravcomp`, and springs
    keep the lowest nodes at their height, both ways and without friction. `look` is an
    image (rows, columns, 3) of fibres.
    """
    nx, _, nz = CELLS
    pin = f'<pin gridrange="0 0 0 {nx} 0 {nz}"/>' if held else ""
    child = mujoco.MjSpec.from_string(
        f'<mujoco><asset><texture name="{name}" type="2d" builtin="flat" width="1" '
        f'height="1"/><material name="{name}" texture="{name}" specular=".35" '
        f'shininess=".4"/></asset><worldbody><flexcomp name="{name}" type="direct" '
        f'dim="3" dof="trilinear" cellcount="{_text(CELLS)}" mass="{mass}" '
        f'radius="{RADIUS}" material="{name}" texcoord="{_text(_texcoord(muscle))}" '
        f'point="{_text(muscle.vertices.ravel())}" '
        f'element="{_text(muscle.elements.ravel())}"><elasticity young="{young}" '
        f'poisson="{poisson}" damping="{damping}"/><contact selfcollide="none" '
        f'contype="0" conaffinity="0"/>{pin}</flexcomp></worldbody></mujoco>'
    )
    _paint(child.textures[0], look)
    for body in child.bodies[1:]:
        body.gravcomp = 1.0
        if body.name.endswith("_0"):
            body.joints[2].stiffness = [SUPPORT, 0.0, 0.0]
    spec.attach(child, prefix=PREFIX, frame=spec.worldbody.add_frame())


def _texcoord(muscle: Muscle) -> Array:
    """Fibres along x, the seam at the last rows of the image; rows change with height.

    Rows stay off the image's edges, where the renderer would mix the first and last.
    """
    x, _, z = muscle.vertices.T
    height = (z - z.min()) / np.ptp(z)
    outer, seam = 0.02 + 0.4 * height, 0.95 + 0.03 * height
    row = outer + muscle.depth * (seam - outer)
    return np.stack([x / IMAGE, row], axis=1).ravel()


def _paint(texture: mujoco.MjsTexture, look: NDArray[np.uint8]) -> None:
    texture.builtin = mujoco.mjtBuiltin.mjBUILTIN_NONE
    texture.height, texture.width, texture.nchannel = look.shape
    texture.data = look.tobytes()


def node_body(name: str, ix: int, iy: int, iz: int) -> str:
    """Name of the body of a free node of a muscle's grid."""
    return f"{PREFIX}{name}_{ix}_{iy}_{iz}"


def _text(values: ArrayLike) -> str:
    return " ".join(str(x) for x in np.asarray(values).tolist())


@final
class MaterialPoints:
    """Points of a muscle: where they are, how fast, and what pushes them.

    Args:
        model: the scene.
        name: of the muscle.
        points: (N, 3) in the undeformed muscle [m].
    """

    def __init__(self, model: mujoco.MjModel, name: str, points: Array) -> None:
        flex = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_FLEX, f"{PREFIX}{name}")
        first, count = model.flex_nodeadr[flex], model.flex_nodenum[flex]
        bodies = model.flex_nodebodyid[first : first + count]
        nodes = model.body_pos[bodies] + model.flex_node[first : first + count]
        free = model.body_dofnum[bodies] == 3
        start = int(model.body_dofadr[bodies[free]][0])
        self.block = slice(start, start + 3 * int(free.sum()))
        start = int(model.jnt_qposadr[model.body_jntadr[bodies[free]]][0])
        self._qpos = slice(start, start + 3 * int(free.sum()))
        corner, weight = _weights(points, nodes.min(axis=0), nodes.max(axis=0))
        self.rest = np.einsum("pc,pcx->px", weight, nodes[corner])
        number = np.cumsum(free) - 1  # of a node among the free ones
        self._corner = np.where(free[corner], number[corner], 0)
        self._weight = np.where(free[corner], weight, 0.0)

    def read(self, data: mujoco.MjData) -> tuple[Array, Array]:
        """Positions and velocities (N, 3), (N, 3) at this instant [m, m/s]."""
        x, v = np.empty(self.rest.shape), np.empty(self.rest.shape)
        q, qd = data.qpos[self._qpos], data.qvel[self.block]
        _follow(self._corner, self._weight, self.rest, q, qd, x, v)
        return x, v

    def push(self, data: mujoco.MjData, forces: Array) -> None:
        """Let forces (N, 3) [N] act, and no others, until the next call."""
        _pass_on(self._corner, self._weight, forces, data.qfrc_applied[self.block])


@compiled
def _follow(
    corner: IntArray,
    weight: Array,
    rest: Array,
    q: Array,
    qd: Array,
    x: Array,
    v: Array,
) -> None:
    """Positions and velocities of points, from those of the free nodes.

    Args:
        corner: (N, 8) free nodes around each point.
        weight: (N, 8) their trilinear weights.
        rest: (N, 3) the points while the nodes are at rest [m].
        q: (3 K,) how far the nodes have moved [m].
        qd: (3 K,) how fast they do [m/s].
        x: (N, 3) is written.
        v: (N, 3) is written.
    """
    for i in range(x.shape[0]):
        for j in range(3):
            place, speed = rest[i, j], 0.0
            for k in range(8):
                c = np.uintp(3 * corner[i, k] + j)
                place += weight[i, k] * q[c]
                speed += weight[i, k] * qd[c]
            x[i, j], v[i, j] = place, speed


@compiled
def _pass_on(corner: IntArray, weight: Array, forces: Array, total: Array) -> None:
    """Forces (3 K,) on the free nodes, from those on points (N, 3)."""
    total[:] = 0.0
    for i in range(forces.shape[0]):
        for k in range(8):
            for j in range(3):
                c = np.uintp(3 * corner[i, k] + j)
                total[c] += weight[i, k] * forces[i, j]


def _weights(points: Array, low: Array, high: Array) -> tuple[IntArray, Array]:
    """Nodes around points (N, 8), z fastest in their grid, and trilinear weights."""
    cells = np.array(CELLS)
    place = np.clip((points - low) / (high - low), 0.0, 1.0) * cells
    cell = np.minimum(place.astype(int), cells - 1)
    share = place - cell
    corners = np.array(list(itertools.product((0, 1), repeat=3)))
    weights = np.where(corners, share[:, None], 1.0 - share[:, None]).prod(axis=2)
    nodes = np.moveaxis(cell[:, None] + corners, 2, 0)
    return np.ravel_multi_index(tuple(nodes), tuple(cells + 1)), weights
