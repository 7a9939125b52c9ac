"""Attempts side by side, one column a resolver."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from sims.contact.scene import HOLE, TIP
from sims.demo import Outcome
from sims.report.panels import Curves, Panel, side_by_side
from wbc.arrays import Array

__all__ = ["compared"]

MILLI: Final = 1e3
PHASES: Final = ("search", "insertion", "stay")


def compared(outcomes: Mapping[str, Outcome]) -> list[tuple[str, str]]:
    """(caption, svg) of way -> outcome, for the first attempt and the first crank."""
    pegs = {way: _peg(outcome.series) for way, outcome in outcomes.items()}
    forces = {way: (t, {"force": force}) for way, (t, force, _) in pegs.items()}
    depths = {way: (t, {"depth": depth}) for way, (t, _, depth) in pegs.items()}
    panels = [Panel("force on the\nblock [N]", forces), Panel("depth [mm]", depths)]
    drawn = [("The first peg.", side_by_side("Peg 1", panels))]
    cranks = {way: _crank(outcome.series) for way, outcome in outcomes.items()}
    panels = [Panel("force on the\ncrank [N]", cranks)]
    return [*drawn, ("The first crank.", side_by_side("Crank 1", panels))]


def _peg(series: Mapping[str, Array]) -> tuple[Array, Array, Array]:
    """Time, force and depth (T,) over all phases."""
    phases = [f"peg 1 {p}" for p in PHASES if f"peg 1 {p}/t" in series]
    t, wrench, tip = (
        np.concatenate([series[f"{phase}/{name}"] for phase in phases])
        for name in ("t", "wrench/wrist", f"p/{TIP}")
    )
    return t, np.linalg.norm(wrench[:, :3], axis=1), (HOLE[2] - tip[:, 2]) * MILLI


def _crank(series: Mapping[str, Array]) -> Curves:
    force = np.linalg.norm(series["crank 1/wrench/wrist"][:, :3], axis=1)
    return series["crank 1/t"], {"force": force}
