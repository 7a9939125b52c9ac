"""An explanation as text: one table of all tasks, one line for a bound in force."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import zip_longest
from typing import TYPE_CHECKING

import numpy as np

from wbc.explain.response import NEGLIGIBLE

if TYPE_CHECKING:
    from wbc.explain.data import ActiveBound, Blocker, TaskExplanation

__all__ = ["paid", "table"]

SHOWN = 3
"""Rows and blockers of a task that the table has room for."""


def table(tasks: tuple[TaskExplanation, ...]) -> Iterator[str]:
    """One line a task, more where several rows miss or several rows block."""
    cells = [("level", "task", "met", "error", "gets", "blocked by (relief)")]
    for task in tasks:
        error = "" if task.error is None else _with(task.error, task.error_unit)
        first = (str(task.level), task.name, "yes" if task.met else "NO", error)
        rest = zip_longest(
            _first(_missing(task)),
            _first([_relief(blocker) for blocker in task.blockers]),
            fillvalue="",
        )
        lines = [(*first, *texts) for texts in rest] or [(*first, "", "")]
        cells.append(lines[0])
        cells += [("", "", "", "", *line[4:]) for line in lines[1:]]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    for line in cells:
        padded = (text.ljust(width) for text, width in zip(line, widths, strict=True))
        yield "  ".join(padded).rstrip()


def _first(texts: list[str]) -> list[str]:
    more = len(texts) - SHOWN
    return texts if more <= 1 else [*texts[:SHOWN], f"and {more} more"]


def _missing(task: TaskExplanation) -> list[str]:
    """What it gets instead of what, the worst row first; not those of round-off."""
    if task.met:
        return []
    size = np.abs(task.missing)
    worst = np.argsort(-size, kind="stable")
    got = task.wanted - task.missing
    got[np.abs(got) < NEGLIGIBLE * size] = 0.0
    return [
        f"{task.rows[i]} {_with(got[i], '')} instead of "
        f"{_with(task.wanted[i], task.units[i])}"
        for i in worst
        if size[i] > NEGLIGIBLE * size[worst[0]]
    ]


def _relief(blocker: Blocker) -> str:
    """The row, and how much less is missing per unit of its bound."""
    return f"{blocker} ({_per(f'{blocker.relief:.3g}', blocker.unit)})"


def paid(bound: ActiveBound, levels: int) -> str:
    """A bound and what each of its payers, of so many levels, pays per unit of it."""
    names = [f"level {k}" if k <= levels else "least norm" for k, _ in bound.payers]
    prices = [_per(f"{price:.3g}", bound.unit) for _, price in bound.payers]
    shares = ", ".join(f"{n} pays {p}" for n, p in zip(names, prices, strict=True))
    row = f"{bound.level} {bound.task}/{bound.row} at {bound.side}"
    return f"{row}: {shares or 'nobody, it only touches'}"


def _with(number: float, unit: str) -> str:
    return f"{number + 0.0:.3g} {unit}".rstrip()


def _per(text: str, unit: str) -> str:
    return f"{text} per {unit or 'unit'}"
