"""A study of random stacks in one picture: sound, optimal, quick."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

from sims.compare.study import Study
from sims.report.axes import PALETTE
from sims.report.svg import styled
from sims.writing import write

__all__ = ["write_picture"]

SIZE, DOTS = (9.6, 3.4), 140
"""Of the picture [in], and per inch."""
FLOOR = 1e-16
"""What is smaller stands on this line: round-off."""
FREE, ACTIVE = (PALETTE[0], "o", "no limit active"), (PALETTE[1], "s", "limits active")


@styled
def write_picture(study: Study, path: Path) -> None:
    """Write a PNG: a row a resolver, worst leak, worst gap, median time.

    Raises:
        NotWritten: there is no room for the file, or no right to write it.
    """
    figure = Figure(figsize=SIZE, dpi=DOTS, layout="constrained")
    panels = figure.subplots(1, 3, sharey=True)
    titles = (
        ("Sound?", "worst leak into a higher level [1]", "leak"),
        ("Optimal?", "worst gap of a level to its optimum [1]", "gap"),
        ("Quick?", "median time of a cold start [us]", "microseconds"),
    )
    for axes, (title, label, indicator) in zip(panels, titles, strict=True):
        _panel(axes, study, indicator)
        axes.set(title=title, xlabel=label)
    panels[2].xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    panels[2].xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    panels[2].xaxis.set_minor_formatter(NullFormatter())
    panels[0].set_yticks(range(len(study.resolvers)), study.resolvers)
    panels[0].invert_yaxis()
    handles, names = panels[1].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=2, frameon=False)
    canvas: Any = FigureCanvasAgg(figure)
    drawn = io.BytesIO()
    canvas.print_png(drawn)
    write(path, drawn.getvalue())


def _panel(axes: Axes, study: Study, indicator: str) -> None:
    axes.set_xscale("log")
    axes.grid(visible=True, color="#E3E6E8", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    for limits, (colour, shape, name) in ((False, FREE), (True, ACTIVE)):
        found = [study.of(resolver, limits=limits) for resolver in study.resolvers]
        if not all(found):
            continue
        values = [[getattr(f, indicator) for f in some] for some in found]
        shown = _middle(values) if indicator == "microseconds" else _worst(values)
        offset = 0.12 * (1 if limits else -1)
        axes.plot(
            np.maximum(shown, FLOOR),
            np.arange(len(shown)) + offset,
            shape,
            color=colour,
            markersize=6,
            label=name,
        )


def _worst(values: Sequence[Sequence[float]]) -> list[float]:
    return [float(np.nanmax(some)) for some in values]


def _middle(values: Sequence[Sequence[float]]) -> list[float]:
    return [float(np.nanmedian(some)) for some in values]
