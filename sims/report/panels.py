"""The same series of several runs, in aligned panels with the same axes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias, final

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from sims.report.axes import styles, vector
from sims.report.grid import HIGH, grid_of, head, name_curves, room
from sims.report.svg import styled, to_svg
from sims.report.thinning import thin_series
from wbc.errors import InputError

__all__ = ["Curves", "Panel", "side_by_side"]

Curves: TypeAlias = tuple[ArrayLike, Mapping[str, ArrayLike]]
"""Times (T,) [s], and label -> values (T,); NaN leaves a gap."""
_POINTS: Final = 1500  # vertices of one panel


@final
@dataclass(frozen=True, slots=True, eq=False)
class Panel:
    """One row of panels.

    Attributes:
        label: quantity and unit, such as "force [N]".
        ways: way -> its curves.
    """

    label: str
    ways: Mapping[str, Curves]


@styled
def side_by_side(title: str, panels: Sequence[Panel]) -> str:
    """A row for each quantity, a column for each way; rows share their scale.

    Args:
        title: what is compared.
        panels: from the top; all of the same ways.

    Raises:
        InputError: no panels, or of different ways.
    """
    ways = list(panels[0].ways) if panels else []
    if not ways or any(list(panel.ways) != ways for panel in panels):
        raise InputError(f"the panels of '{title}' must be of the same ways, and some.")
    names = [_names(panel) for panel in panels]
    spaces = [0.2 + room(each) * (len(each) > 1) for each in names]
    spaces[0] = head(ways)
    figure, grid = grid_of(title, [(HIGH, space) for space in spaces], ways)
    begin, end = _span(panels)
    for row, panel, labels in zip(grid, panels, names, strict=True):
        for axes, curves in zip(row, panel.ways.values(), strict=True):
            _draw(axes, curves, labels)
            axes.set_xlim(begin, end if end > begin else None)
        if len(labels) > 1:
            name_curves(row[0], labels)
        row[0].set_ylabel(panel.label)
    return to_svg(figure, title)


def _names(panel: Panel) -> list[str]:
    return list(dict.fromkeys(k for _, curves in panel.ways.values() for k in curves))


def _span(panels: Sequence[Panel]) -> tuple[float, float]:
    """First and last time of any curve [s]."""
    times = [np.asarray(t) for panel in panels for t, _ in panel.ways.values()]
    every = np.concatenate([t for t in times if t.size])
    return float(every.min()), float(every.max())


def _draw(axes: Axes, curves: Curves, labels: Sequence[str]) -> None:
    times, series = vector(curves[0], "t"), curves[1]
    for label, look in zip(labels, styles(len(labels)), strict=True):
        if label in series:
            y = vector(series[label], label, len(times))
            kept = thin_series(y, _POINTS // len(labels))
            axes.plot(times[kept], y[kept], **look)
