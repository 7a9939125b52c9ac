"""Figures of the contact report."""

from __future__ import annotations

import numpy as np

from sims.contact.results import Attempt, Crank, force_of
from sims.contact.scene import HOLE, TIP
from sims.report.figures import time_series, xy
from wbc.arrays import Array

__all__ = ["figures"]

MILLI = 1e3
SHOWN = 4
"""Attempts whose curves are drawn; the metrics are those of all."""


def figures(attempts: list[Attempt], cranks: list[Crank]) -> list[tuple[str, str]]:
    """(caption, svg) pairs: the peg, then the crank."""
    shown = attempts[:SHOWN]
    return [_ways(shown), _forces(shown), _depths(shown), *_crank(cranks[0])]


def _ways(attempts: list[Attempt]) -> tuple[str, str]:
    curves = {}
    for index, attempt in enumerate(attempts):
        way = np.concatenate([log.p[TIP] for log in attempt.logs]) - HOLE
        curves[f"attempt {index + 1}"] = (way[:, 0] * MILLI, way[:, 1] * MILLI)
    svg = xy("Search: the peg seen from above", curves, "x [mm]", "y [mm]")
    return "From where the hole is believed to be, in a spiral, to where it is.", svg


def _forces(attempts: list[Attempt]) -> tuple[str, str]:
    def force(attempt: Attempt) -> Array:
        return np.concatenate([force_of(log) for log in attempt.logs])

    t, curves = _padded([force(a) for a in attempts], attempts)
    svg = time_series("Peg: force on the block", t, curves, "force [N]")
    return "Touch, search at constant force, insertion.", svg


def _depths(attempts: list[Attempt]) -> tuple[str, str]:
    def depth(attempt: Attempt) -> Array:
        z = np.concatenate([log.p[TIP][:, 2] for log in attempt.logs])
        return (HOLE[2] - z) * MILLI

    t, curves = _padded([depth(a) for a in attempts], attempts)
    svg = time_series("Peg: depth of its end", t, curves, "depth [mm]")
    return "On the surface while it searches, then 20 mm down.", svg


def _padded(
    values: list[Array], attempts: list[Attempt]
) -> tuple[Array, dict[str, Array]]:
    """Curves of different lengths over one time; the shorter ones end earlier."""
    longest = max(map(len, values))
    curves = {
        f"attempt {index + 1}": np.append(v, np.full(longest - len(v), np.nan))
        for index, v in enumerate(values)
    }
    t = attempts[0].logs[0].t
    dt = t[1] - t[0] if t.size > 1 else 0.0
    return dt * np.arange(longest), curves


def _crank(crank: Crank) -> list[tuple[str, str]]:
    names = ("along the lever", "with the turn", "along the axis")
    forces = dict(zip(names, crank.forces.T, strict=True))
    t = crank.log.t
    pushed = time_series("Crank: force on the handle", t, forces, "force [N]")
    turned = time_series(
        "Crank: angle", t, {"crank": crank.angle / (2.0 * np.pi)}, "turns [1]"
    )
    return [
        ("Only the friction of the crank is felt: the lever leads.", pushed),
        ("More than one turn.", turned),
    ]
