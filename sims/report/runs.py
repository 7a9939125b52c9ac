"""Figures of whole runs, whatever the cell: levels, errors and loads over one time.

Several ways to do the same run stand side by side, in panels with the same axes.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
from matplotlib.axes import Axes

from sims.course import Course
from sims.report.axes import draw_bounds, styles
from sims.report.grid import HIGH, grid_of, head, keys_above, name_curves, room
from sims.report.lanes import aligned, draw_lanes, lane_keys, lanes_height
from sims.report.svg import styled, to_svg
from sims.report.thinning import thin_series
from wbc.arrays import Array

__all__ = ["CAPTION", "compared_figures", "drawable", "level_figures", "run_figure"]

CAPTION: Final = (
    "One lane a task, the most important on top; the number is its level. Shaded where "
    "the task gave way: the share of the acceleration or torque it wanted that it did "
    "not get, beyond round-off, sampled every ten ticks. A limit that was ever active "
    "has a line of its own below its task, blue where it was, at any tick. The last "
    "level takes what is left over, so it misses most. Runs in which a limit was "
    "active come first."
)
_POINTS: Final = 2400  # vertices of a panel, over all columns
_LEAST: Final = 1e-7
"""Errors below this are drawn as this: round-off of no interest."""


def level_figures(courses: Mapping[str, Course]) -> list[tuple[str, str]]:
    """(caption, svg) of every run, those first in which a limit was active."""
    shown = {name: {name: c} for name, c in courses.items() if drawable(c)}
    return _drawn(shown, "Levels, errors and loads of")


def compared_figures(
    courses: Mapping[str, Mapping[str, Course]],
) -> list[tuple[str, str]]:
    """The same of every run that was done in two ways or more, side by side.

    Args:
        courses: way -> run -> its course.
    """
    shown: dict[str, dict[str, Course]] = {}
    for way, runs in courses.items():
        for name, course in runs.items():
            if drawable(course):
                shown.setdefault(name, {})[way] = course
    several = {name: ways for name, ways in shown.items() if len(ways) > 1}
    return _drawn(several, "Side by side, with the same axes: levels, errors, loads of")


def _drawn(
    shown: Mapping[str, Mapping[str, Course]], caption: str
) -> list[tuple[str, str]]:
    limited = {k: any(c.active for c in ways.values()) for k, ways in shown.items()}
    return [
        (f"{caption} '{name}'.", run_figure(name, shown[name]))
        for name in sorted(shown, key=lambda name: not limited[name])
    ]


def drawable(course: Course) -> bool:
    """Whether there is a stretch of time to draw."""
    return bool(course.shortfall) and course.t.size > 1


@styled
def run_figure(title: str, runs: Mapping[str, Course]) -> str:
    """Levels, task errors and use of limits over time, a column for each of the runs.

    Panels in a row share their scales, so that columns can be compared at a glance.

    Args:
        title: what the runs are.
        runs: way -> its course, one that is `drawable`.
    """
    plan, ways = aligned(runs.values()), list(runs)
    names = list(dict.fromkeys(n for course in runs.values() for n in course.errors))
    rows = [(lanes_height(plan), head(ways)), (HIGH, 0.2 + room(names)), (HIGH, 0.45)]
    figure, grid = grid_of(title, rows, ways)
    loads = [load for c in runs.values() for load in (c.torque, c.speed)]
    longest = max(float(course.t[-1] - course.t[0]) for course in runs.values())
    for column, course in enumerate(runs.values()):
        lanes, error, load = (row[column] for row in grid)
        draw_lanes(lanes, course, plan, named=column == 0)
        _draw_errors(error, course, names, len(runs))
        _draw_load(load, course, loads)
        for axes in (lanes, error, load):
            axes.set_xlim(course.t[0], course.t[0] + longest)
    _finish([row[0] for row in grid], names)
    return to_svg(figure, title)


def _finish(first: list[Axes], names: list[str]) -> None:
    """Legends and labels, in the first column."""
    lanes, error, load = first
    keys_above(lanes, lane_keys(), columns=5)
    name_curves(error, names)
    units = ", ".join(name[name.rindex("[") + 1 : -1] for name in names) or "1"
    parts = dict.fromkeys(units.split(", "))
    error.set_ylabel(f"task error\n[{', '.join(parts)}]")
    keys = load.get_legend_handles_labels()[0]
    keys_above(load, keys, columns=3)
    load.set_ylim(0.0, None)
    load.set_ylabel("largest share\nof limit [1]")


def _draw_errors(axes: Axes, course: Course, names: list[str], ways: int) -> None:
    axes.set_yscale("log")
    budget = _POINTS // (ways * max(len(names), 1))
    for name, look in zip(names, styles(len(names)), strict=True):
        if name in course.errors:
            values = np.maximum(course.errors[name], _LEAST)
            kept = thin_series(values, budget)
            axes.plot(course.t[kept], values[kept], **look)


def _draw_load(axes: Axes, course: Course, loads: list[Array]) -> None:
    """The bound is drawn or named by what all columns need."""
    own = {"torque": course.torque, "speed": course.speed}
    for (name, values), look in zip(own.items(), styles(2), strict=True):
        kept = thin_series(values, _POINTS // (2 * len(loads)))
        axes.plot(course.t[kept], values[kept], label=name, **look)
    draw_bounds(axes, {"limit": 1.0}, list(loads))
