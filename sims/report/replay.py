"""Replay of a recording in three dimensions: one HTML document, no server, no network.

The document holds meshcat's viewer and the scene. Meshcat's own exporter sends every
command through an asynchronous fetch, animations first, so that tracks can bind to
placeholders that the shapes replace later. Here one synchronous script builds all
shapes, and loads the animation last.
"""

from __future__ import annotations

import html
import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from string import Template
from typing import Any, Final, final

import mujoco
import numpy as np
from matplotlib.colors import to_hex
from numpy.typing import ArrayLike

from sims.report.axes import PALETTE
from sims.report.motion import Motion, frames, play_back, track
from sims.report.shapes import Store, geoms, soft_bodies
from sims.report.thinning import thin_curve
from wbc.arrays import Array, frozen
from wbc.errors import InputError, WbcError

__all__ = ["Marker", "Replay", "Trace"]

_FIELD_OF_VIEW: Final = 40.0  # [deg], vertical
_TRACE_POINTS: Final = 500


@final
@dataclass(frozen=True, slots=True, eq=False)
class Trace:
    """A line in space, such as a seam or the path of a tool.

    Attributes:
        name: what the legend calls it.
        points: (K, 3) [m], in the world.
        colour: any colour that matplotlib knows.
        width: diameter of the line [m].
        times: (K,) [s] in the recording's time, if the line grows as it is drawn.
    """

    name: str
    points: ArrayLike
    colour: str = PALETTE[1]
    width: float = 0.004
    times: ArrayLike | None = None


@final
@dataclass(frozen=True, slots=True, eq=False)
class Marker:
    """A ball in space, such as a target.

    Attributes:
        name: what the legend calls it.
        points: (3,) [m] fixed in the world, or (T, 3) [m], one for each sample.
        colour: any colour that matplotlib knows.
        radius: of the ball [m].
    """

    name: str
    points: ArrayLike
    colour: str = PALETTE[2]
    radius: float = 0.012


@final
class Replay:
    """A recording, ready to be written as a page.

    Args:
        model: what moved; only read.
        times: (T,) [s], ascending.
        qpos: (T, nq), MuJoCo's order of positions.
        traces: lines to draw.
        markers: balls to draw.
        camera: where to look from; by default everything is in view.
        mocap: (T, nmocap, 7) position [m] and quaternion w x y z of mocap bodies.
        rate: frames that the page stores for each second of the recording [1/s].

    Raises:
        InputError: shapes that do not fit, values that are not finite, times that do
            not ascend.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        times: ArrayLike,
        qpos: ArrayLike,
        *,
        traces: Sequence[Trace] = (),
        markers: Sequence[Marker] = (),
        camera: mujoco.MjvCamera | None = None,
        mocap: ArrayLike | None = None,
        rate: float = 30.0,
    ) -> None:
        stamps = np.asarray(times, dtype=np.float64)
        count = len(stamps)
        if count < 2 or not (np.diff(stamps) > 0.0).all():
            raise InputError("a replay needs two samples or more, at ascending times.")
        if not rate > 0.0:
            raise InputError(f"the rate of a replay must be positive, got {rate}.")
        stamps = frozen(stamps, (count,), "times")
        states = frozen(qpos, (count, model.nq), "qpos")
        kept = frames(stamps, rate)
        poses = None
        if mocap is not None:
            poses = frozen(mocap, (count, model.nmocap, 7), "mocap")[kept]
        self._start = float(stamps[0])
        self._motion = play_back(model, stamps[kept], states[kept], poses)
        self._store = Store()
        self._scene = self._describe(model, traces, camera)
        self._scene["markers"] = [self._marker(m, count, kept) for m in markers]
        self._data = self._store.text()

    @property
    def frame_times(self) -> Array:
        """Times (F,) [s] of the stored frames, from 0."""
        return self._motion.times

    def html(self) -> str:
        """A complete document, fit for a file or for the `srcdoc` of an iframe."""
        here = files("sims.report")
        template = Template(here.joinpath("replay.html").read_text(encoding="utf-8"))
        return template.substitute(
            viewer=_viewer_script(),
            scene=json.dumps(self._scene, allow_nan=False).replace("<", "\\u003c"),
            data=self._data,
            player=here.joinpath("replay.js").read_text(encoding="utf-8"),
            legend=self._legend(),
        )

    def _describe(
        self,
        model: mujoco.MjModel,
        traces: Sequence[Trace],
        camera: mujoco.MjvCamera | None,
    ) -> dict[str, Any]:
        store, motion = self._store, self._motion
        shapes, undrawn = geoms(model, store)
        shown = {shape["body"] for shape in shapes}
        bodies = [
            _body(model, i, motion, store, i in shown) for i in range(model.nbody)
        ]
        soft, undrawn_soft = soft_bodies(model, motion.vertices, store)
        return {
            "times": store.add(motion.times, "f4"),
            "bodies": bodies,
            "geoms": shapes,
            "soft": soft,
            "traces": [self._trace(trace) for trace in traces],
            "undrawn": undrawn + undrawn_soft,
            "view": _view(motion, camera),
            "room": {"low": motion.low.tolist(), "high": motion.high.tolist()},
        }

    def _trace(self, trace: Trace) -> dict[str, Any]:
        count = len(np.asarray(trace.points))
        points = frozen(trace.points, (count, 3), f"points of trace '{trace.name}'")
        if not count:
            raise InputError(f"trace '{trace.name}' has no points.")
        moved = np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-6
        distinct = np.flatnonzero(np.append(True, moved))
        kept = distinct[thin_curve(points[distinct], _TRACE_POINTS)]
        line = {
            "name": trace.name,
            "colour": to_hex(trace.colour),
            "width": trace.width,
            "points": self._store.add(points[kept], "f4"),
        }
        if trace.times is not None:
            stamps = frozen(trace.times, (count,), f"times of trace '{trace.name}'")
            line["times"] = self._store.add(stamps[kept] - self._start, "f4")
        return line

    def _marker(self, marker: Marker, count: int, kept: Any) -> dict[str, Any]:
        what = f"points of marker '{marker.name}'"
        if np.ndim(marker.points) == 1:
            points = frozen(marker.points, (3,), what)[None]
        else:
            points = frozen(marker.points, (count, 3), what)[kept]
        return {
            "name": marker.name,
            "colour": to_hex(marker.colour),
            "radius": marker.radius,
            "position": track(points, self._store),
        }

    def _legend(self) -> str:
        entries = [
            f'<li><i style="background:{one["colour"]}"></i>{html.escape(one["name"])}'
            for one in [*self._scene["traces"], *self._scene["markers"]]
        ]
        if self._scene["undrawn"]:
            names = html.escape(", ".join(self._scene["undrawn"]))
            entries.append(f"<li>not drawn: {names}")
        return "\n".join(entries)


def _body(
    model: mujoco.MjModel, index: int, motion: Motion, store: Store, shown: bool
) -> dict[str, Any]:
    last = None if shown else 1  # a body without shapes needs no keyframes
    return {
        "name": model.body(index).name or f"body {index}",
        "position": track(motion.positions[:last, index], store),
        "quaternion": track(motion.quaternions[:last, index], store),
    }


def _view(motion: Motion, camera: mujoco.MjvCamera | None) -> dict[str, Any]:
    """Camera and target [m]; without a camera, all that moves or stands is in view."""
    target = 0.5 * (motion.low + motion.high)
    radius = max(0.5 * float(np.linalg.norm(motion.high - motion.low)), 0.05)
    azimuth, elevation = math.radians(130.0), math.radians(-20.0)
    distance = 0.8 * radius / math.sin(math.radians(0.5 * _FIELD_OF_VIEW))
    if camera is not None:
        target, distance = np.array(camera.lookat), camera.distance
        azimuth = math.radians(camera.azimuth)
        elevation = math.radians(camera.elevation)
    flat = math.cos(elevation)
    forward = (flat * math.cos(azimuth), flat * math.sin(azimuth), math.sin(elevation))
    return {
        "target": target.tolist(),
        "position": (target - distance * np.array(forward)).tolist(),
        "angle": _FIELD_OF_VIEW,
    }


def _viewer_script() -> str:
    """Meshcat's viewer, read without importing the package and its web server."""
    package = find_spec("meshcat")
    if package is None or package.origin is None:
        raise WbcError("the replay needs the package 'meshcat'; install it.")
    path = Path(package.origin).parent / "viewer" / "dist" / "main.min.js"
    return path.read_text(encoding="utf-8").replace("</script", "<\\/script")
