"""One number of every resolver in every family of problems, on a logarithmic scale."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from sims.report.axes import PALETTE, legend, new_figure
from sims.report.svg import styled, to_svg

__all__ = ["marks"]

SHAPES = "os^DvP*X"
SPREAD = 0.6
"""Width that the marks of a group share, of the distance between two groups."""


@styled
def marks(
    title: str,
    groups: Sequence[str],
    series: Mapping[str, Sequence[float]],
    ylabel: str,
    *,
    floor: float,
    bar: float | None = None,
) -> str:
    """Marks side by side, one colour and shape a series, one place on x a group.

    Args:
        title: what the figure shows.
        groups: (G,) names along x.
        series: label -> (G,) values; NaN leaves a place empty.
        ylabel: quantity and unit.
        floor: what is smaller stands on this line: round-off.
        bar: a bound, drawn dashed.
    """
    figure, axes = new_figure(title, "", ylabel, height=3.6)
    offsets = np.linspace(-SPREAD / 2, SPREAD / 2, max(len(series), 2))
    for i, (label, values) in enumerate(series.items()):
        axes.plot(
            np.arange(len(groups)) + offsets[i],
            np.maximum(np.asarray(values, dtype=np.float64), floor),
            SHAPES[i % len(SHAPES)],
            color=PALETTE[i % len(PALETTE)],
            markersize=6,
            label=label,
        )
    axes.set_yscale("log")
    axes.set_ylim(floor / 3.0, None)
    axes.set_xticks(range(len(groups)), groups)
    if bar is not None:
        axes.axhline(bar, label=f"bound {bar:g}", color="#5F6368", ls="--", lw=1.0)
    legend(axes)
    return to_svg(figure, title)
