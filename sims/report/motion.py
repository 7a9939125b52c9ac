"""How the bodies of a recording moved: poses frame by frame, for a replay."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, final

import mujoco
import numpy as np
from numpy.typing import NDArray

from sims.report.shapes import Store, visible_geoms
from wbc.arrays import Array

__all__ = ["Motion", "frames", "play_back", "track"]

_STILL = 1e-7  # [m] or quaternion units: less than this in a whole run is no motion


@final
@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """Poses in F frames, and how much room all of them take.

    Attributes:
        times: (F,) [s], from 0.
        positions: of body frames (F, B, 3) [m].
        quaternions: of body frames (F, B, 4), order x y z w.
        vertices: of deformable bodies (F, V, 3) [m].
        low: least corner (3,) [m] of everything visible that is not a plane.
        high: greatest corner (3,) [m].
    """

    times: Array
    positions: Array
    quaternions: Array
    vertices: Array
    low: Array
    high: Array


def frames(times: Array, rate: float) -> NDArray[np.intp]:
    """Indices of samples, first and last included, `rate` [1/s] of them or just more.

    Fewer where the samples themselves are not so many.
    """
    count = math.ceil(float(times[-1] - times[0]) * rate - 1e-9)
    wanted = np.linspace(times[0], times[-1], max(count, 1) + 1)
    after = np.searchsorted(times, wanted - 1e-9).clip(0, len(times) - 1)
    return np.unique(after)


def play_back(
    model: mujoco.MjModel, times: Array, qpos: Array, mocap: Array | None
) -> Motion:
    """Body poses at `times` (F,) of positions (F, nq) and mocap poses (F, nmocap, 7).

    `model` is only read.
    """
    data = mujoco.MjData(model)
    shown = [g for g in visible_geoms(model) if model.geom_rbound[g] > 0.0]
    reach = model.geom_rbound[shown, None]
    poses: dict[str, list[Array]] = {"positions": [], "quaternions": [], "vertices": []}
    corners: list[Array] = []
    for index in range(len(times)):
        data.qpos[:] = qpos[index]
        if mocap is not None:
            data.mocap_pos[:], data.mocap_quat[:] = np.split(mocap[index], [3], axis=1)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_flex(model, data)
        poses["positions"].append(data.xpos.copy())
        poses["quaternions"].append(np.roll(data.xquat, -1, axis=1))
        poses["vertices"].append(data.flexvert_xpos.copy())
        centres = data.geom_xpos[shown]
        corners += [centres - reach, centres + reach, data.flexvert_xpos.copy()]
    cloud = np.vstack([*corners, np.zeros((0 if shown else 1, 3))])
    arrays = {name: np.array(values) for name, values in poses.items()}
    box = {"low": cloud.min(axis=0), "high": cloud.max(axis=0)}
    return Motion(times=times - times[0], **arrays, **box)


def track(values: Array, store: Store) -> dict[str, Any]:
    """Values (F, N) as a constant where nothing moves, else as stored keyframes."""
    first: list[float] = values[0].tolist()
    if np.ptp(values, axis=0).max() < _STILL:
        return {"first": first}
    return {"first": first, "keys": store.add(values, "f4")}
