"""Panels in rows that share their scale, and columns that share their time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from sims.report.axes import styles

__all__ = [
    "HIGH",
    "_KEYS_HEIGHT",
    "grid_of",
    "head",
    "keys_above",
    "name_curves",
    "room",
]

HIGH: Final = 1.25
"""Of a panel of curves [in]."""
_KEYS_HEIGHT: Final = 0.16  # of a line of a legend [in]
_LEFT, _RIGHT, _BETWEEN, _FOOT = 1.62, 0.12, 0.22, 0.5  # margins [in]
_KEYS: Final = 3  # entries of a legend in a line


def grid_of(
    title: str, rows: Sequence[tuple[float, float]], columns: Sequence[str]
) -> tuple[Figure, list[list[Axes]]]:
    """A figure of axes, row by row; several columns take the page's whole width.

    Args:
        title: of the figure.
        rows: (height, space above) of each [in]; the first one has room for the title
            and the names of columns if it has the space `head(columns)`.
        columns: their names, shown where there are several.
    """
    count = len(columns)
    width = 6.4 if count == 1 else 12.8
    top = height = sum(high + above for high, above in rows) + _FOOT
    figure = Figure(figsize=(width, height))
    figure.suptitle(title, fontsize=10.5, fontweight="bold", y=1.0, va="top")
    each = (width - _LEFT - _RIGHT - _BETWEEN * (count - 1)) / count
    grid: list[list[Axes]] = []
    for high, above in rows:
        top -= high + above
        places = [
            (
                (_LEFT + i * (each + _BETWEEN)) / width,
                top / height,
                each / width,
                high / height,
            )
            for i in range(count)
        ]
        grid.append(_row(figure, places))
    for axes in (axes for row in grid[:-1] for axes in row):
        axes.tick_params(axis="x", labelbottom=False)
    for axes in grid[-1]:
        axes.set_xlabel("time [s]")
    if count > 1:
        for axes, name in zip(grid[0], columns, strict=True):
            axes.set_title(name, fontsize=9.5, pad=4 + 72 * _KEYS_HEIGHT)
    return figure, grid


def head(columns: Sequence[str]) -> float:
    """Space for the title, a legend, and the names of several columns [in]."""
    return 0.2 + (2 if len(columns) == 1 else 3) * _KEYS_HEIGHT


def room(names: Sequence[str]) -> float:
    """Height of a legend with these names [in]."""
    return -(-len(names) // _KEYS) * _KEYS_HEIGHT


def name_curves(axes: Axes, names: Sequence[str]) -> None:
    """A legend above the axes, of curves in the order of `styles`."""
    looks = zip(names, styles(len(names)), strict=True)
    lines = [Line2D([], [], label=name, **look) for name, look in looks]
    if lines:
        keys_above(axes, lines, _KEYS)


def keys_above(axes: Axes, keys: list[Any], columns: int) -> None:
    """A legend of these keys above the axes."""
    axes.legend(
        handles=keys,
        ncols=columns,
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        fontsize=7.5,
        frameon=False,
        borderaxespad=0.1,
        handlelength=1.6,
        columnspacing=1.0,
        handletextpad=0.4,
    )


def _row(figure: Figure, places: Sequence[tuple[float, ...]]) -> list[Axes]:
    row: list[Axes] = []
    for place in places:
        axes: Axes = figure.add_axes(place, sharey=row[0] if row else None)  # type: ignore[arg-type] # four numbers
        axes.grid(visible=True, color="#E3E6E8", linewidth=0.6)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
        axes.tick_params(axis="y", labelleft=not row)
        row.append(axes)
    return row
