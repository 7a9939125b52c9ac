"""What strictness cost along a run: the mean over samples, one line a level."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from sims.report.datatable import Table
from wbc import LevelCost, StrictnessCost

__all__ = ["Regrets"]

HEAD = ["stack and level", "unit", "asked", "alone", "got", "taken by levels above"]


class Regrets:
    """Collects the costs of the stacks that were seen, told apart by their levels."""

    def __init__(self) -> None:
        self._seen: dict[tuple[str, ...], list[StrictnessCost]] = defaultdict(list)

    def add(self, cost: StrictnessCost) -> None:
        """Keep one sample."""
        self._seen[tuple(level.name for level in cost.levels)].append(cost)

    def table(self, resolver: str) -> Table:
        """Means over the samples of every stack, from its top level down."""
        rows = [HEAD]
        for number, (names, costs) in enumerate(self._seen.items(), 1):
            for k, name in enumerate(names):
                levels = [cost.levels[k] for cost in costs]
                rows.append([f"{number}.{k + 1} {name}", *_cells(levels, names)])
        return f"what strictness cost, mean of the samples under {resolver}", rows


def _cells(levels: list[LevelCost], names: tuple[str, ...]) -> list[str]:
    asked, alone, got, short = (
        float(np.mean([getattr(level, name) for level in levels]))
        for name in ("asked", "alone", "got", "shortfall")
    )
    taken = np.mean([level.taken for level in levels], axis=0)
    said = [
        f"{names[j]}: {amount:.3g}" for j, amount in enumerate(taken) if amount > 0.0
    ]
    said += [f"resolver: {short:+.3g}"] if short else []
    numbers = [f"{x:.3g}" for x in (asked, alone, got)]
    return [levels[0].unit, *numbers, "; ".join(said) or "-"]
