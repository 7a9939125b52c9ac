"""Figures of a report, as SVG text: many samples in, few bytes out, always the same.

Units are part of the labels that callers pass, such as "lateral error [mm]".
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from sims.report.axes import (
    PALETTE,
    Bounds,
    Span,
    draw_bounds,
    legend,
    new_figure,
    shade,
    styles,
    vector,
)
from sims.report.svg import styled, to_svg
from sims.report.thinning import thin_curve, thin_series
from wbc.errors import InputError

__all__ = ["PALETTE", "Bounds", "Span", "lines3d", "time_series", "xy"]

_POINTS = 3600  # vertices of one figure; about 24 bytes each


@styled
def time_series(
    title: str,
    t: ArrayLike,
    series: Mapping[str, ArrayLike],
    ylabel: str,
    bounds: Bounds | None = None,
    spans: Sequence[Span] | None = None,
) -> str:
    """Curves over time, every peak kept.

    Args:
        title: what the figure shows.
        t: times (T,) [s], ascending.
        series: label -> values (T,); NaN leaves a gap.
        ylabel: quantity and unit of the values.
        bounds: limits drawn dashed, with or without labels. One far outside the
            data is named in the legend instead.
        spans: intervals (name, begin [s], end [s]) to shade.
    """
    times = vector(t, "t")
    entries = len(series) + len(bounds or ())
    height = 2.5 + 0.2 * -(-entries // 4)  # [in], four legend entries a line
    figure, axes = new_figure(title, "time [s]", ylabel, height)
    budget = _POINTS // max(len(series), 1)
    looks = styles(len(series))
    for (label, values), look in zip(series.items(), looks, strict=True):
        y = vector(values, label, len(times))
        kept = thin_series(y, budget)
        axes.plot(times[kept], y[kept], label=label, **look)
    draw_bounds(axes, bounds, list(series.values()))
    if len(times):
        axes.set_xlim(times[0], times[-1] if times[-1] > times[0] else None)
    shade(axes, spans or ())
    legend(axes)
    return to_svg(figure, title)


@styled
def xy(
    title: str,
    curves: Mapping[str, tuple[ArrayLike, ArrayLike]],
    xlabel: str,
    ylabel: str,
    equal: bool = True,
) -> str:
    """Plane curves {label: (x (N,), y (N,))}; `equal` scales both axes alike."""
    figure, axes = new_figure(title, xlabel, ylabel, height=3.6)
    budget = _POINTS // max(len(curves), 1)
    looks = styles(len(curves))
    for (label, (x, y)), look in zip(curves.items(), looks, strict=True):
        abscissa = vector(x, label)
        points = np.column_stack([abscissa, vector(y, label, len(abscissa))])
        kept = thin_curve(points, budget)
        axes.plot(*points[kept].T, label=label, **look)
    if equal:
        axes.set_aspect("equal", adjustable="datalim")
    legend(axes)
    return to_svg(figure, title)


@styled
def lines3d(
    title: str, curves: Mapping[str, ArrayLike], labels: Sequence[str] | None = None
) -> str:
    """Space curves {label: points (N, 3) [m]}, axes scaled alike."""
    figure = Figure(figsize=(6.4, 4.6), layout="constrained")
    axes: Any = figure.add_subplot(projection="3d")
    axes.set_title(title)
    for axis, text in zip("xyz", labels or ("x [m]", "y [m]", "z [m]"), strict=True):
        getattr(axes, f"set_{axis}label")(text)
    budget = _POINTS // max(len(curves), 1)
    looks = styles(len(curves))
    for (label, values), look in zip(curves.items(), looks, strict=True):
        points = np.asarray(values, dtype=np.float64)
        if points.ndim != 2 or points.shape[1] != 3:
            raise InputError(f"'{label}' has shape {points.shape}; it must be (N, 3).")
        kept = thin_curve(points, budget)
        axes.plot(*points[kept].T, label=label, **look)
    axes.set_aspect("equal")
    axes.set_box_aspect(axes.get_box_aspect(), zoom=0.82)  # labels stay inside
    spans = {axis: float(np.ptp(getattr(axes, f"get_{axis}lim")())) for axis in "xyz"}
    longest = max(spans.values())
    for axis, span in spans.items():
        axes.locator_params(axis=axis, nbins=max(2, round(6.0 * span / longest)))
        # Pads are measured along the other two axes, so thin boxes need larger ones.
        thin = longest / (0.5 * (sum(spans.values()) - span))
        getattr(axes, f"{axis}axis").labelpad = 8.0 * thin - 4.0
    legend(axes)
    return to_svg(figure, title)
