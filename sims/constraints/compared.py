"""The run with contact side by side, one column a resolver."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from sims.constraints.hybrid import FORCE
from sims.demo import Outcome
from sims.report.panels import Curves, Panel, side_by_side
from wbc.arrays import Array

__all__ = ["compared"]


def compared(outcomes: Mapping[str, Outcome]) -> list[tuple[str, str]]:
    """(caption, svg) of way -> outcome."""
    series = {way: outcome.series for way, outcome in outcomes.items()}
    forces = {way: _force(s) for way, s in series.items()}
    svg = side_by_side("Hybrid: normal force", [Panel("force [N]", forces)])
    return [("Contact force of the hybrid run, with the same axes.", svg)]


def _force(series: Mapping[str, Array]) -> Curves:
    true = series["hybrid/touch"]
    return series["hybrid/t"], {"true": true, "wanted": np.full(true.size, FORCE)}
