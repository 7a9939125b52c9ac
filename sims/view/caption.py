"""A run in words: time, every task with its level and error, which limits bind."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from sims.run import Decision
from wbc import Controller, Solution, TaskReport
from wbc.arrays import Array

__all__ = ["Caption", "caption"]

NAMED: Final = 3
"""So many active rows of a task are named, the others counted."""
LARGE: Final = 100.0
"""Numbers from here on are shown without a fraction."""
UNITS: Final = {
    "m": (1e3, "mm"),
    "rad": (1e3, "mrad"),
    "m/s": (1e3, "mm/s"),
    "rad/s": (1e3, "mrad/s"),
}
"""Unit -> what is shown instead, and how many of it make one."""


class Caption(NamedTuple):
    """Two columns of lines: what, and how it is."""

    left: str
    right: str


def caption(title: str, t: float, decisions: Sequence[Decision]) -> Caption:
    """Words about one instant.

    Args:
        title: of the run.
        t: time [s].
        decisions: of every controller, at the last tick.
    """
    rows = [(title, f"{t:.2f} s")]
    for controller, _, solution in decisions:
        if len(decisions) > 1:
            rows.append((controller.robot.name, ""))
        rows += _tasks(controller, solution)
    left, right = ("\n".join(map(_plain, column)) for column in zip(*rows, strict=True))
    return Caption(left, right)


def _tasks(controller: Controller, solution: Solution) -> list[tuple[str, str]]:
    """A line for every task; one in all where the tick fell back."""
    if not solution.ok:
        return [("fell back", solution.message)]
    tasks = {task.name: task for task in controller.hierarchy.tasks()}
    rows = []
    for report in solution.reports():
        units = tasks[report.name].row_units(len(report.error))
        rows.append((f"{report.level} {report.name}", _state(report, units)))
    if controller.changing:
        rows.append(("changing", f"{100.0 * solution.share:.0f} %"))
    return rows


def _state(report: TaskReport, units: tuple[str, ...]) -> str:
    """The error's size in every unit, and the bounds that are reached."""
    parts = []
    for unit in dict.fromkeys(units):
        mine = report.error[[u == unit for u in units]]
        mine = mine[np.isfinite(mine)]
        if mine.size:
            parts.append(_size(mine, unit))
    if report.active:
        more = len(report.active) - NAMED
        names = [*report.active[:NAMED], *([f"+{more}"] if more > 0 else [])]
        parts.append(f"at bound: {', '.join(names)}")
    return "  ".join(parts) or "free"


def _size(error: Array, unit: str) -> str:
    factor, name = UNITS.get(unit, (1.0, unit))
    size = factor * float(np.linalg.norm(error))
    return f"{size:.{0 if size >= LARGE else 2}f} {name}"


def _plain(text: str) -> str:
    """What the engine's font has letters for."""
    return text.encode("ascii", "replace").decode()
