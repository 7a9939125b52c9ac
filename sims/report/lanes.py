"""Lanes over time: one a task in order of priority, and one a limit that was active."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final, final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from sims.course import Course
from sims.report.thinning import columns
from wbc.arrays import Array

__all__ = ["Lane", "aligned", "draw_lanes", "lane_keys", "lanes_height", "lanes_of"]

# From pale to dark, so that print in grey and colour-blind readers keep the order;
# blue stands for limits alone.
_MET: Final = "#DFE5EA"
_MISSES: Final = (
    (0.001, "#F3CE86", "misses 0.1 to 1 %"),
    (0.01, "#DE8F1F", "1 to 10 %"),
    (0.1, "#8F3B00", "10 to 100 %"),
)
_ACTIVE: Final = "#0072B2"
_COLUMNS: Final = 400
_TASK, _ROW, _GAP = 1.0, 0.62, 0.22  # heights, in lanes
_INCH: Final = 0.19  # of a lane
_LONGEST: Final = 24  # characters of a label


@final
@dataclass(frozen=True, slots=True, eq=False)
class Lane:
    """One task at one level.

    Attributes:
        t, share: (S,) sample times [s] and the share of its wish that was missed.
        rows: limit -> (T,) whether it was active.
    """

    t: Array
    share: Array
    rows: dict[str, Array]


def lanes_of(course: Course) -> dict[tuple[int, str], Lane]:
    """Lanes of a run, from the top level down."""
    ordered = sorted(course.shortfall.items(), key=lambda pair: pair[0][0])
    return {
        (level, task): Lane(
            course.sampled, share, _named_after(f"level {level}: {task}: ", course)
        )
        for (level, task), share in ordered
    }


def _named_after(prefix: str, course: Course) -> dict[str, Array]:
    """Bounds of one task, by what is left of their names."""
    return {
        name.removeprefix(prefix): active
        for name, active in course.active.items()
        if name.startswith(prefix)
    }


def aligned(runs: Iterable[Course]) -> dict[tuple[int, str], tuple[str, ...]]:
    """Lanes that any of the runs has, each with the limits active in any, in order."""
    found: dict[tuple[int, str], dict[str, None]] = {}
    for course in runs:
        for key, lane in lanes_of(course).items():
            found.setdefault(key, {}).update(dict.fromkeys(lane.rows))
    ordered = sorted(found.items(), key=lambda pair: pair[0][0])
    return {key: tuple(sorted(rows)) for key, rows in ordered}


def lanes_height(plan: Mapping[tuple[int, str], tuple[str, ...]]) -> float:
    """Height of the axes that the lanes take [in]."""
    return _INCH * sum(_TASK + _ROW * len(rows) + _GAP for rows in plan.values())


def draw_lanes(
    axes: Axes,
    course: Course,
    plan: Mapping[tuple[int, str], tuple[str, ...]],
    named: bool,
) -> None:
    """Draw a run's lanes in the places of the plan, and their names where wanted."""
    lanes, y, ticks = lanes_of(course), 0.0, []
    extent = (float(course.t[0]), float(course.t[-1]))
    for (level, task), rows in plan.items():
        lane = lanes.get((level, task))
        ticks.append((y + 0.5 * _TASK, f"{level}  {_short(task)}"))
        if lane is not None:
            _draw_shares(axes, lane, extent, y)
        y += _TASK
        for row in rows:
            ticks.append((y + 0.5 * _ROW, _short(row)))
            if lane is not None and row in lane.rows:
                strip = columns(course.t, lane.rows[row][None], _COLUMNS)[0] > 0.0
                _draw_bars(axes, strip, extent, (y, y + 0.8 * _ROW), _ACTIVE)
            y += _ROW
        y += _GAP
    axes.set_ylim(y - _GAP, 0.0)
    if named:
        places, names = zip(*ticks, strict=True)
        axes.set_yticks(places, names, fontsize=7.5)
    axes.tick_params(axis="y", length=0.0)
    axes.grid(visible=False, axis="y")
    axes.spines["left"].set_visible(False)


def lane_keys() -> list[Any]:
    """What the colours mean, for a legend."""
    shades = [Patch(color=colour, label=text) for _, colour, text in _MISSES]
    return [
        Patch(color=_MET, label="met"),
        *shades,
        Patch(color=_ACTIVE, label="limit active"),
    ]


def _draw_shares(axes: Axes, lane: Lane, extent: tuple[float, float], y: float) -> None:
    strip = columns(lane.t, np.asarray(lane.share)[None], _COLUMNS)[0]
    place = (y, y + 0.86 * _TASK)
    _draw_bars(axes, np.isfinite(strip), extent, place, _MET)
    limits = [least for least, _, _ in _MISSES] + [np.inf]
    for (least, colour, _), most in zip(_MISSES, limits[1:], strict=True):
        _draw_bars(axes, (strip >= least) & (strip < most), extent, place, colour)


def _draw_bars(
    axes: Axes,
    strip: Array,
    extent: tuple[float, float],
    place: tuple[float, float],
    colour: str,
) -> None:
    """One shape of a bar for each stretch where `strip` (C,) holds."""
    edges = np.linspace(*extent, strip.size + 1)
    steps = np.diff(np.concatenate([[0], strip.astype(int), [0]]))
    begins, ends = edges[steps > 0], edges[steps < 0]
    if not begins.size:
        return
    low, high = place
    corners = [(b, low, e, high) for b, e in zip(begins, ends, strict=True)]
    boxes = [[(b, lo), (e, lo), (e, hi), (b, hi), (b, lo)] for b, lo, e, hi in corners]
    path = Path.make_compound_path(*(Path(box, closed=True) for box in boxes))
    axes.add_patch(PathPatch(path, facecolor=colour, linewidth=0.0))


def _short(name: str) -> str:
    return name if len(name) <= _LONGEST else f"{name[: _LONGEST - 1]}…"
