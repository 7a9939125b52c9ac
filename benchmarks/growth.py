"""Section (c): how our tick grows with axes, tasks and levels."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.jobs import Job
from benchmarks.pipes import Worker
from benchmarks.tables import late, median, micro, table
from benchmarks.ticks import DROPPED, Entry, arm_job, race

__all__ = ["growth_table"]

RESOLVERS = ("hqp", "nullspace")
Point = tuple[float, Job]


def growth_table(ours: Worker, quick: bool, folder: Path) -> str:
    """Median tick for 1 to 4 arms, 1 to 8 tasks on one level, 1 to 8 levels."""
    ticks = 40 if quick else 900 + DROPPED
    arms = (1, 2) if quick else (1, 2, 3, 4)
    counts = (1, 4) if quick else (1, 2, 4, 8)
    lines = {
        "axes": [(7.0 * k, arm_job(f"{7 * k} axes", k, folder)) for k in arms],
        "tasks": [(float(k), _planes(k, False, folder)) for k in counts],
        "levels": [(float(k), _planes(k, True, folder)) for k in counts],
    }
    rows = []
    for what, points in lines.items():
        for resolver in RESOLVERS:
            rows += _line(ours, what, points, resolver, ticks)
    head = ("case", "median us", "p99", "us per unit")
    return table(
        "Growth: axes (an arm and a pose each 7), tasks of one row on one level, "
        "and on a level each (14 axes, limits above, posture below)",
        head,
        rows,
    )


def _planes(count: int, split: bool, folder: Path) -> Job:
    kind = "levels" if split else "tasks"
    return arm_job(f"{count} {kind}", 2, folder, planes=count, split=split, tips=())


def _line(
    ours: Worker, what: str, points: list[Point], resolver: str, ticks: int
) -> list[list[str]]:
    """The points of one line, and its slope by least squares."""
    rows, medians = [], []
    for size, job in points:
        entry = Entry(ours, resolver)
        race(job, [entry], ticks)
        medians.append(median(entry.ticks))
        times = [micro(medians[-1]), micro(late(entry.ticks))]
        rows.append([f"wbc {resolver}: {size:.0f} {what}", *times, entry.failure])
    slope = np.polyfit([size for size, _ in points], medians, 1)[0]
    rows[-1][-1] = rows[-1][-1] or f"{slope:.2f}"
    return rows
