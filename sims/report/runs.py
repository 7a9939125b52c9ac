"""Figures of whole runs, whatever the cell: levels, errors and loads over one time.

Several ways to do the same run stand side by side, in panels with the same axes.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sims.log import Log
from sims.report.axes import draw_bounds, styles
from sims.report.lanes import aligned, draw_lanes, lane_keys, lanes_height
from sims.report.svg import styled, to_svg
from sims.report.thinning import thin_series
from wbc.arrays import Array

__all__ = ["CAPTION", "level_figures", "run_figure"]

CAPTION: Final = (
    "One lane a task, the most important on top; the number is its level. Shaded where "
    "the task gave way: the share of the acceleration or torque it wanted that it did "
    "not get, beyond round-off, sampled every ten ticks. A limit that was ever active "
    "has a line of its own below its task, blue where it was, at any tick. The last "
    "level takes what is left over, so it misses most."
)
_LEFT, _RIGHT, _BETWEEN = 1.62, 0.12, 0.22  # margins [in]
_HIGH: Final = 1.25  # of a panel of curves [in]
_POINTS: Final = 3600
_LEAST: Final = 1e-7
"""Errors below this are drawn as this: round-off of no interest."""
_KEYS: Final = 3  # entries of a legend in a line
_LINE: Final = 0.16  # height of a legend's line [in]
_SMALL: dict[str, Any] = {"fontsize": 7.5, "frameon": False, "borderaxespad": 0.1}


def level_figures(logs: Mapping[str, Log]) -> list[tuple[str, str]]:
    """(caption, svg) of every run that is long enough to draw."""
    return [
        (f"Levels, errors and loads of '{name}'.", run_figure(name, {name: log}))
        for name, log in logs.items()
        if log.levels.shortfall and log.t.size > 1
    ]


@styled
def run_figure(title: str, runs: Mapping[str, Log]) -> str:
    """Levels, task errors and use of limits over time, a column for each of the runs.

    Panels in a row share their scales, so that columns can be compared at a glance.

    Args:
        title: what the runs are.
        runs: way -> log of two ticks or more.
    """
    plan = aligned(runs.values())
    errors = {way: _errors(log) for way, log in runs.items()}
    names = list(dict.fromkeys(name for each in errors.values() for name in each))
    keys = -(-len(names) // _KEYS) * _LINE if names else 0.0
    rows = [(lanes_height(plan), _head(runs)), (_HIGH, 0.2 + keys), (_HIGH, 0.45)]
    figure, grid = _grid(rows, list(runs))
    for column, (way, log) in enumerate(runs.items()):
        lanes, error, load = (row[column] for row in grid)
        draw_lanes(lanes, log, plan, named=column == 0)
        _draw_curves(error, log.t, errors[way], names, len(runs))
        _draw_load(load, log, len(runs))
        for axes in (lanes, error, load):
            axes.set_xlim(log.t[0], log.t[-1])
            axes.tick_params(axis="x", labelbottom=axes is load)
        load.set_xlabel("time [s]")
    _finish(grid, names)
    figure.suptitle(title, fontsize=10.5, fontweight="bold", y=1.0, va="top")
    return to_svg(figure, title)


def _grid(
    rows: list[tuple[float, float]], ways: list[str]
) -> tuple[Figure, list[list[Axes]]]:
    """Axes row by row, each (height, space above) [in]; time axes end at one place."""
    width = 6.4 if len(ways) == 1 else 12.8
    height = sum(high + above for high, above in rows) + 0.5
    figure = Figure(figsize=(width, height))
    each = (width - _LEFT - _RIGHT - _BETWEEN * (len(ways) - 1)) / len(ways)
    grid: list[list[Axes]] = []
    top = height
    for high, above in rows:
        top -= high + above
        grid.append([])
        for column, way in enumerate(ways):
            left = _LEFT + column * (each + _BETWEEN)
            place = (left / width, top / height, each / width, high / height)
            shared = grid[-1][0] if column else None
            axes = figure.add_axes(place, sharey=shared)
            axes.grid(visible=True, color="#E3E6E8", linewidth=0.6)
            axes.set_axisbelow(True)
            axes.spines[["top", "right"]].set_visible(False)
            axes.tick_params(axis="y", labelleft=column == 0)
            if len(grid) == 1 and len(ways) > 1:
                axes.set_title(way, fontsize=9.5, pad=4 + 72 * _LINE)
            grid[-1].append(axes)
    return figure, grid


def _head(runs: Mapping[str, Log]) -> float:
    """Space for the title, a legend, and the names of several columns [in]."""
    return 0.2 + (2 if len(runs) == 1 else 3) * _LINE


def _finish(grid: list[list[Axes]], names: list[str]) -> None:
    """Legends and names of the axes, once a row."""
    lanes, error, load = (row[0] for row in grid)
    above: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0)}
    short = {"handlelength": 1.2, "columnspacing": 1.0, "handletextpad": 0.4}
    lanes.legend(handles=lane_keys(), ncols=5, **above, **_SMALL, **short)
    if names:
        units = ", ".join(name[name.rindex("[") + 1 : -1] for name in names)
        parts = dict.fromkeys(units.split(", "))
        error.set_ylabel(f"task error\n[{', '.join(parts)}]")
        error.legend(ncols=_KEYS, **above, **_SMALL)
    load.set_ylim(0.0, None)
    load.set_ylabel("largest share\nof limit [1]")
    load.legend(ncols=3, **above, **_SMALL)


def _errors(log: Log) -> dict[str, Array]:
    """Errors by task and unit, of tasks that have one."""
    return {
        f"{name} [{log.units.get(name) or '1'}]": error
        for name, error in log.errors.items()
        if np.isfinite(error).any()
    }


def _draw_curves(
    axes: Axes, t: Array, curves: Mapping[str, Array], names: list[str], ways: int
) -> None:
    axes.set_yscale("log")
    budget = _POINTS // (ways * max(len(names), 1))
    for name, look in zip(names, styles(len(names)), strict=True):
        values = np.maximum(curves.get(name, np.full(t.size, np.nan)), _LEAST)
        kept = thin_series(values, budget)
        axes.plot(t[kept], values[kept], label=name, **look)


def _draw_load(axes: Axes, log: Log, ways: int) -> None:
    robot = log.robot
    loads = {
        "torque": np.abs(log.torque / robot.tau_max).max(axis=1),
        "speed": np.abs(log.v / robot.v_max).max(axis=1),
    }
    for (name, values), look in zip(loads.items(), styles(2), strict=True):
        kept = thin_series(values, _POINTS // (4 * ways))
        axes.plot(log.t[kept], values[kept], label=name, **look)
    draw_bounds(axes, {"limit": 1.0}, list(loads.values()))
