"""Axes, curves' styles, limits and shaded intervals, alike in every figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle, islice
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from wbc.arrays import Array
from wbc.errors import InputError

__all__ = [
    "PALETTE",
    "Bounds",
    "Span",
    "draw_bounds",
    "legend",
    "new_figure",
    "shade",
    "styles",
    "vector",
]

Span = tuple[str, float, float]
Bounds = Mapping[str, float] | Sequence[float]

# Okabe and Ito's colours, told apart by colour-blind readers and in grey; their
# yellow is left out because it vanishes on white paper.
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
_NAME: dict[str, Any] = {
    "textcoords": "offset points",
    "ha": "center",
    "fontsize": 7.5,
    "color": "#3C4043",
}
_ABOVE = {**_NAME, "xytext": (0, 3), "va": "bottom"}
_INSIDE = {**_NAME, "xytext": (0, -3), "va": "top", "rotation": 90}
_DASHES = ("-", "--", ":", "-.")
_OFF_SCALE = 4.0  # a limit this many times beyond the data is named, not drawn


def new_figure(
    title: str, xlabel: str, ylabel: str, height: float = 2.9
) -> tuple[Figure, Axes]:
    """An empty figure of this height [in] and its one pair of axes."""
    figure = Figure(figsize=(6.4, height), layout="constrained")
    axes = figure.add_subplot()
    axes.set(title=title, xlabel=xlabel, ylabel=ylabel)
    axes.grid(visible=True, color="#E3E6E8", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    return figure, axes


def styles(count: int) -> list[dict[str, Any]]:
    """Colour first, then dashes: no two of 28 curves look the same."""
    pairs = [(colour, dash) for dash in _DASHES for colour in PALETTE]
    return [
        {"color": colour, "linestyle": dash, "linewidth": 1.3}
        for colour, dash in islice(cycle(pairs), count)
    ]


def vector(values: ArrayLike, what: str, length: int | None = None) -> Array:
    """Numbers (T,), T as told.

    Raises:
        InputError: another shape.
    """
    vector = np.asarray(values, dtype=np.float64)
    if vector.ndim != 1 or (length is not None and len(vector) != length):
        wanted = "one axis" if length is None else f"{length} values"
        raise InputError(f"'{what}' has shape {vector.shape}; it must have {wanted}.")
    return vector


def draw_bounds(axes: Axes, bounds: Bounds | None, series: list[ArrayLike]) -> None:
    """Draw limits dashed; name those far beyond all values in the legend instead."""
    if not bounds:
        return
    named = bounds.items() if isinstance(bounds, Mapping) else [("", b) for b in bounds]
    arrays = [np.asarray(values, dtype=np.float64) for values in series]
    values = np.concatenate([*arrays, np.empty(0)])
    values = values[np.isfinite(values)]
    reach = _OFF_SCALE * float(np.abs(values).max()) if values.size else np.inf
    for name, bound in named:
        if abs(bound) > reach > 0.0:
            text = f"{name or 'bound'}: {bound:.4g} (off scale)"
            axes.plot([], [], color="#5F6368", linestyle="--", label=text)
        else:
            line: dict[str, Any] = {"color": "#5F6368", "linestyle": "--", "lw": 1.0}
            axes.axhline(bound, label=name or "_bound", **line)


def shade(axes: Axes, spans: Sequence[Span]) -> None:
    """Tint intervals in turn and write their names along the upper edge."""
    begin, end = axes.get_xlim()
    if spans:
        axes.set_title(axes.get_title(), pad=15.0)
    for index, (name, start, stop) in enumerate(spans):
        tint = ("#56B4E9", "#E69F00")[index % 2]
        axes.axvspan(start, stop, color=tint, alpha=0.13, linewidth=0.0)
        middle = 0.5 * (max(start, begin) + min(stop, end))
        narrow = (stop - start) / (end - begin) < 0.012 * len(name)
        where = _INSIDE if narrow else _ABOVE
        axes.annotate(name, (middle, 1.0), xycoords=("data", "axes fraction"), **where)
    axes.set_xlim(begin, end)


def legend(axes: Axes) -> None:
    """Name the curves below the axes, unless there is only one."""
    handles, names = axes.get_legend_handles_labels()
    if len(names) > 1:
        size = {"fontsize": 8, "ncols": min(4, len(names)), "frameon": False}
        axes.figure.legend(handles, names, loc="outside lower center", **size)
