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
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from string import Template
from typing import Any, Final, final

import mujoco
import numpy as np
from numpy.typing import ArrayLike

from sims.report.motion import Motion, frames, play_back, track
from sims.report.overlays import (
    Arrow,
    Marker,
    Trace,
    arrows_of,
    marker_of,
    trace_of,
)
from sims.report.shapes import Store, geoms, soft_bodies
from wbc.arrays import Array, frozen
from wbc.errors import InputError, WbcError

__all__ = ["Arrow", "Marker", "Replay", "Trace"]

_FIELD_OF_VIEW: Final = 40.0  # [deg], vertical
_SCRIPTS: Final = ("scene.js", "shapes.js", "overlays.js", "room.js", "player.js")


@final
class Replay:
    """A recording, ready to be written as a page.

    Args:
        model: what moved; only read.
        times: (T,) [s], ascending.
        qpos: (T, nq), MuJoCo's order of positions.
        traces: lines to draw.
        markers: balls to draw.
        arrows: forces to draw, and other vectors.
        chapters: (name, begin [s]) of parts, in order; the page shows where it is.
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
        arrows: Sequence[Arrow] = (),
        chapters: Sequence[tuple[str, float]] = (),
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
        self._motion = play_back(model, stamps[kept], states[kept], poses)
        self._store = Store()
        self._scene = self._describe(model, camera)
        start, store = float(stamps[0]), self._store
        self._scene |= {
            "traces": [trace_of(t, count, kept, start, store) for t in traces],
            "markers": [marker_of(m, count, kept, store) for m in markers],
            "chapters": [{"name": n, "begin": begin - start} for n, begin in chapters],
            "arrows": arrows_of(arrows, count, kept, _radius(self._motion), store),
        }
        self._data = self._store.text()

    @property
    def frame_times(self) -> Array:
        """Times (F,) [s] of the stored frames, from 0."""
        return self._motion.times

    def html(self) -> str:
        """A complete document, fit for a file or for the `srcdoc` of an iframe."""
        template = Template(_own("replay.html"))
        return template.substitute(
            viewer=_viewer_script(),
            scene=json.dumps(self._scene, allow_nan=False).replace("<", "\\u003c"),
            data=self._data,
            player="\n".join(map(_own, _SCRIPTS)),
            legend=self._legend(),
        )

    def _describe(
        self, model: mujoco.MjModel, camera: mujoco.MjvCamera | None
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
            "undrawn": undrawn + undrawn_soft,
            "view": _view(motion, camera),
            "room": {"low": motion.low.tolist(), "high": motion.high.tolist()},
        }

    def _legend(self) -> str:
        scene = self._scene
        entries = [
            f'<li><i style="background:{one["colour"]}"></i>{html.escape(one["name"])}'
            for one in [*scene["traces"], *scene["markers"]]
            if one.get("listed", True)
        ]
        entries += [
            f'<li><b style="color:{one["colour"]}">&#x2794;</b>'
            f'{html.escape(one["name"])} <output class="size"></output> '
            f"<small>1 cm = {one['perCm']:g} {html.escape(one['unit'])}</small>"
            for one in scene["arrows"]
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


def _radius(motion: Motion) -> float:
    """Of the room that everything visible takes [m]."""
    return max(0.5 * float(np.linalg.norm(motion.high - motion.low)), 0.05)


def _view(motion: Motion, camera: mujoco.MjvCamera | None) -> dict[str, Any]:
    """Camera and target [m]; without a camera, all that moves or stands is in view."""
    target = 0.5 * (motion.low + motion.high)
    radius = _radius(motion)
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


def _own(name: str) -> str:
    """Text of a file of the player."""
    return files("sims.report").joinpath("player", name).read_text(encoding="utf-8")


def _viewer_script() -> str:
    """Meshcat's viewer, read without importing the package and its web server."""
    package = find_spec("meshcat")
    if package is None or package.origin is None:
        raise WbcError("the replay needs the package 'meshcat'; install it.")
    path = Path(package.origin).parent / "viewer" / "dist" / "main.min.js"
    return path.read_text(encoding="utf-8").replace("</script", "<\\/script")
