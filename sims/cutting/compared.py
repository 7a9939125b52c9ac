"""Cuts side by side: what P0's figures 7 to 9 show, one column an experiment."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from sims.cutting.record import EVERY
from sims.demo import Outcome
from sims.report.panels import Curves, Panel, side_by_side
from wbc.arrays import Array

__all__ = ["compared"]

MILLI: Final = 1e3


def compared(outcomes: Mapping[str, Outcome]) -> list[tuple[str, str]]:
    """(caption, svg) of way -> outcome."""
    series = {way: outcome.series for way, outcome in outcomes.items()}
    panels = [
        Panel(
            "knife less guide\nline, y [mm]", {w: _error(s) for w, s in series.items()}
        ),
        Panel("pulling force\nalong y [N]", {w: _pull(s) for w, s in series.items()}),
        Panel("knife on meat\n[N]", {w: _knife(s) for w, s in series.items()}),
        Panel("opening\n[mm]", {w: _opening(s) for w, s in series.items()}),
    ]
    caption = (
        "Error of the guide line, forces of both arms and opening of the valley, with "
        "the same axes (P0, Figs. 7 to 9)."
    )
    return [(caption, side_by_side("The cut", panels))]


def _error(s: Mapping[str, Array]) -> Curves:
    tip, guide = s["tip"][::EVERY, 1][: len(s["guide"])], s["guide"][:, 1]
    return s["coarse_t"], {"error": MILLI * (tip - guide)}


def _pull(s: Mapping[str, Array]) -> Curves:
    return s["t"], {"measured": s["pull"], "wanted": s["due"]}


def _knife(s: Mapping[str, Array]) -> Curves:
    return s["t"], {"size": np.linalg.norm(s["knife"], axis=1)}


def _opening(s: Mapping[str, Array]) -> Curves:
    return s["coarse_t"], {"opening": MILLI * s["opening"]}
