"""The replay of a cut: meat, guide line, the way of the knife, and forces."""

from __future__ import annotations

from typing import Final

import numpy as np

from sims.cutting.layout import CUTTER, PULLER
from sims.cutting.loop import Run
from sims.cutting.pictures import camera
from sims.cutting.record import EVERY
from sims.report.axes import PALETTE
from sims.report.replay import Arrow, Replay, Trace
from wbc.arrays import Array

__all__ = ["GUIDE_WIDTH", "interface_lines", "replay"]

THIN: Final = 20
"""Ticks between two points of the knife's way."""
GUIDE_WIDTH: Final = 3e-3
"""Of the guide line [m]."""


def replay(run: Run) -> str:
    """The whole cut in three dimensions: guide line, way of the knife, and forces."""
    record = run.record
    way = record.tip[::THIN]
    felt = {name: w for log in run.logs for name, w in log.wrenches.items()}
    return Replay(
        run.cell.model,
        record.coarse_t,
        record.qpos,
        traces=[
            *_planned(run),
            Trace(
                "guide line in the meat", interface_lines(run), "#000000", GUIDE_WIDTH
            ),
            Trace("knife", way, PALETTE[5], 0.0015, record.t[::THIN]),
        ],
        arrows=[
            Arrow("knife on meat", record.tip[::EVERY], felt[CUTTER][::EVERY, :3]),
            Arrow(
                "puller on meat",
                record.grip[::EVERY],
                felt[PULLER][::EVERY, :3],
                colour=PALETTE[2],
            ),
        ],
        camera=camera(),
    ).html()


def _planned(run: Run) -> list[Trace]:
    """The trajectory of every passage, as fitted at its start."""
    record, depths = run.record, run.job.passages.plan.depths
    x = np.linspace(record.low, record.high, 40)
    return [
        Trace(
            f"passage {k + 1}",
            np.column_stack([x, line(x), np.full(x.size, depths[k])]),
            PALETTE[k % 7],
            0.0015,
        )
        for k, line in enumerate(record.lines)
    ]


def interface_lines(run: Run) -> Array:
    """The interface at the depth of the passage at hand or next (C, nu, 3) [m]."""
    record, depths = run.record, np.array(run.job.passages.plan.depths)
    rest = record.interface[0, :, :, 2].mean(axis=0)
    rows = np.abs(rest - depths[:, None]).argmin(axis=1)
    passage = record.stroke[::EVERY][: len(record.interface)].copy()
    begun = np.maximum.accumulate(passage)
    waiting = passage < 0
    passage[waiting] = np.minimum(begun[waiting] + 1, len(depths) - 1)
    lines: Array = record.interface[np.arange(passage.size), :, rows[passage]]
    return lines
