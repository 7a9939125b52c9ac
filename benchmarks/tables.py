"""Numbers to text: medians, percentiles, and tables that README can quote."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

__all__ = ["late", "median", "micro", "ratio", "table"]


def median(nanoseconds: Sequence[float]) -> float:
    """Median [us]; NaN of nothing."""
    return float(np.median(nanoseconds)) / 1e3 if len(nanoseconds) else float("nan")


def late(nanoseconds: Sequence[float]) -> float:
    """99th percentile [us]; NaN of nothing."""
    if not len(nanoseconds):
        return float("nan")
    return float(np.percentile(nanoseconds, 99)) / 1e3


def micro(microseconds: float) -> str:
    """Three figures are all that a shared machine is good for."""
    if np.isnan(microseconds):
        return "-"
    return f"{microseconds:.1f}" if microseconds < 100 else f"{microseconds:.0f}"


def ratio(mine: float, other: float) -> str:
    """Mine over the other's."""
    return "-" if np.isnan(mine / other) else f"{mine / other:.2f}"


def table(title: str, head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A titled Markdown table with aligned columns; the first one to the left."""
    widths = [max(len(row[k]) for row in (head, *rows)) for k in range(len(head))]
    lines = [
        "| " + " | ".join(_cell(row[k], w, k) for k, w in enumerate(widths)) + " |"
        for row in (head, *rows)
    ]
    rule = "|" + "|".join(
        (":" if k == 0 else "-") + "-" * w + ("-" if k == 0 else ":")
        for k, w in enumerate(widths)
    )
    return "\n".join([f"### {title}", "", lines[0], rule + "|", *lines[1:], ""])


def _cell(text: str, width: int, column: int) -> str:
    return text.ljust(width) if column == 0 else text.rjust(width)
