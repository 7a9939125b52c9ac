"""What a replay draws beside the model: lines, balls, and arrows for forces."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, final

import numpy as np
from matplotlib.colors import to_hex
from numpy.typing import ArrayLike, NDArray

from sims.report.axes import PALETTE
from sims.report.motion import track
from sims.report.shapes import Store
from sims.report.thinning import thin_curve
from wbc.arrays import frozen
from wbc.errors import InputError

__all__ = ["Arrow", "Marker", "Trace", "arrows_of", "marker_of", "trace_of"]

_TRACE_POINTS: Final = 500
_LONGEST: Final = 0.3  # of the room's radius: the largest arrow at least half of it
_DWARF: Final = 5.0  # times smaller than the largest of its unit
_NOISE: Final = 1e-3  # a vector that is never longer, in its unit, is none


@final
@dataclass(frozen=True, slots=True, eq=False)
class Trace:
    """A line in space, such as a seam or the path of a tool.

    Attributes:
        name: what the legend calls it.
        points: (K, 3) [m], in the world; or (T, K, 3), one line for each sample.
        colour: any colour that matplotlib knows.
        width: diameter of the line [m].
        times: (K,) [s] in the recording's time, if the line grows as it is drawn.
        listed: whether the legend has it; one of many alike is enough.
    """

    name: str
    points: ArrayLike
    colour: str = PALETTE[1]
    width: float = 0.004
    times: ArrayLike | None = None
    listed: bool = True


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
@dataclass(frozen=True, slots=True, eq=False)
class Arrow:
    """A vector in space that changes over time, such as a contact force.

    Arrows of one unit share a scale unless they differ much; the legend tells it.

    Attributes:
        name: what the legend calls it: who pushes whom.
        points: (T, 3) [m] where it begins, one for each sample.
        vectors: (T, 3) in its unit.
        unit: of the vectors.
        colour: any colour that matplotlib knows.
        ends: whether it ends at the points instead, as a push from outside.
    """

    name: str
    points: ArrayLike
    vectors: ArrayLike
    unit: str = "N"
    colour: str = PALETTE[3]
    ends: bool = False


def trace_of(
    trace: Trace, count: int, kept: NDArray[np.intp], start: float, store: Store
) -> dict[str, Any]:
    """A line as the page wants it, in the frames kept of `count` samples.

    Args:
        trace: the line.
        count: samples of the recording.
        kept: indices of those that are frames of the page.
        start: time of the first one [s].
        store: takes the points.

    Raises:
        InputError: no points, or shapes that do not fit.
    """
    line = {
        "name": trace.name,
        "colour": to_hex(trace.colour),
        "width": trace.width,
        "listed": trace.listed,
    }
    shape, what = np.shape(trace.points), f"points of trace '{trace.name}'"
    if 0 in shape:
        raise InputError(f"trace '{trace.name}' has no points.")
    if len(shape) == 3:
        moving = frozen(trace.points, (count, shape[1], 3), what)
        return line | {"moving": store.add(moving[kept], "f4")}
    points = frozen(trace.points, (shape[0], 3), what)
    moved = np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-6
    distinct = np.flatnonzero(np.append(True, moved))
    shown = distinct[thin_curve(points[distinct], _TRACE_POINTS)]
    line["points"] = store.add(points[shown], "f4")
    if trace.times is not None:
        stamps = frozen(trace.times, shape[:1], f"times of trace '{trace.name}'")
        line["times"] = store.add(stamps[shown] - start, "f4")
    return line


def marker_of(
    marker: Marker, count: int, kept: NDArray[np.intp], store: Store
) -> dict[str, Any]:
    """A ball as the page wants it, in the frames kept of `count` samples.

    Raises:
        InputError: shapes that do not fit.
    """
    what = f"points of marker '{marker.name}'"
    if np.ndim(marker.points) == 1:
        points = frozen(marker.points, (3,), what)[None]
    else:
        points = frozen(marker.points, (count, 3), what)[kept]
    return {
        "name": marker.name,
        "colour": to_hex(marker.colour),
        "radius": marker.radius,
        "position": track(points, store),
    }


def arrows_of(
    arrows: Sequence[Arrow],
    count: int,
    kept: NDArray[np.intp],
    radius: float,
    store: Store,
) -> list[dict[str, Any]]:
    """Arrows as the page wants them, in the frames kept of `count` samples.

    `radius` [m] of the room says how long they may become.

    Raises:
        InputError: shapes that do not fit.
    """
    drawn, sizes = [], []
    for arrow in arrows:
        what = f"of arrow '{arrow.name}'"
        points = frozen(arrow.points, (count, 3), f"points {what}")[kept]
        vectors = frozen(arrow.vectors, (count, 3), f"vectors {what}")[kept]
        sizes.append(float(np.linalg.norm(vectors, axis=1).max()))
        drawn.append(
            {
                "name": arrow.name,
                "colour": to_hex(arrow.colour),
                "unit": arrow.unit,
                "ends": arrow.ends,
                "points": store.add(points, "f4"),
                "vectors": store.add(vectors, "f4"),
            }
        )
    for entry, size in zip(drawn, _together(arrows, sizes), strict=True):
        entry["perCm"] = _per_cm(size, radius)
    return drawn


def _together(arrows: Sequence[Arrow], sizes: Sequence[float]) -> list[float]:
    """Arrows of one unit share a scale, but not with those that would be dwarfs.

    Round-off has no scale of its own: an arrow that is never longer stays invisible.
    """
    largest: dict[str, float] = {}
    for arrow, size in zip(arrows, sizes, strict=True):
        largest[arrow.unit] = max(largest.get(arrow.unit, 0.0), size)
    shared = [
        size if size > _NOISE and _DWARF * size < most else most
        for size, most in zip(sizes, (largest[a.unit] for a in arrows), strict=True)
    ]
    return [size if size > _NOISE else 0.0 for size in shared]


def _per_cm(size: float, radius: float) -> float:
    """What a centimetre stands for: the least of 1, 2, 5 times 10^k that is enough."""
    least = size / (100.0 * _LONGEST * radius)
    if least == 0.0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(least))
    return next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= least)
