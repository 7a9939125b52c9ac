"""What strictness cost: how much better each level could do, and who took the rest.

With |s_k|_j the least weighted slack that level k can have once levels 1..j stand
above it, at their optimum,

    |s_k| = |s_k|_0 + sum_j (|s_k|_j - |s_k|_(j-1)) + shortfall,

where |s_k|_0 is what it would miss even alone, no difference is negative, and the
shortfall is what the resolver lost. A level is charged in order of importance: what two
levels both stand in the way of is the upper one's.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from wbc.arrays import Array
from wbc.certificate import slack_of
from wbc.checks import known
from wbc.lexicographic import Lexicographic
from wbc.stack import Stack

__all__ = ["LevelCost", "StrictnessCost", "strictness_cost"]

ROUND_OFF = 1e-9
"""Of a slack, relative to what its level asks for."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class LevelCost:
    """One level: what it missed, and why.

    Attributes:
        level: from 1 at the top.
        name: its tasks.
        unit: of the numbers below; "weighted" where rows differ.
        asked: norm of its targets, and of the bounds that zero motion would break.
        alone: |slack| that it would have with no level above it.
        got: |slack| that it has.
        taken: (k - 1,) what each level above took, from the top.
        shortfall: what the resolver missed of the optimum; negative where it gave this
            level more, at the cost of one above.
    """

    level: int
    name: str
    unit: str
    asked: float
    alone: float
    got: float
    taken: tuple[float, ...]
    shortfall: float

    @property
    def best(self) -> float:
        """|slack| at the optimum under the levels above."""
        return self.alone + sum(self.taken)


@final
@dataclass(frozen=True, slots=True, eq=False)
class StrictnessCost:
    """The cost of every level's priority; `print` it for a table.

    Attributes:
        levels: from the top.
    """

    levels: tuple[LevelCost, ...]

    def level(self, name: str) -> LevelCost:
        """The level that a task stands in.

        Raises:
            UnknownName: no task of that name is in the hierarchy.
        """
        names = {task: cost for cost in self.levels for task in cost.name.split(" + ")}
        return names[known("task", name, names)]

    def __repr__(self) -> str:
        cells = [["level", "tasks", "asked", "alone", "got", "unit", "taken by"]]
        for cost in self.levels:
            numbers = [f"{x:.3g}" for x in (cost.asked, cost.alone, cost.got)]
            cells.append(
                [str(cost.level), cost.name, *numbers, cost.unit, _takers(self, cost)]
            )
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        lines = (
            "  ".join(t.ljust(w) for t, w in zip(line, widths, strict=True)).rstrip()
            for line in cells
        )
        return "\n".join(["what each level misses, and who took it", *lines])


def strictness_cost(stack: Stack, vdot: Array) -> StrictnessCost:
    """Cost of strictness at joint accelerations vdot (n,), of the present rows."""
    names = [level.name for level in stack.hierarchy.levels]
    costs = []
    for k, where in enumerate(stack.levels):
        slack = _slack(stack, where, vdot)
        asked = float(np.linalg.norm(_slack(stack, where, np.zeros(vdot.size))))
        bests = [_best(stack, k, above) for above in range(k + 1)]
        noise = ROUND_OFF * (1.0 + asked)
        bests = [0.0 if best <= noise else best for best in bests]
        bests = np.maximum.accumulate(bests).tolist()
        taken = tuple(d if d > noise else 0.0 for d in np.diff(bests).tolist())
        got = float(np.linalg.norm(slack))
        got = 0.0 if got <= noise else got
        shortfall = got - bests[-1]
        costs.append(
            LevelCost(
                level=k + 1,
                name=names[k],
                unit=_unit(stack, k),
                asked=asked,
                alone=bests[0],
                got=got,
                taken=taken,
                shortfall=shortfall if abs(shortfall) > noise else 0.0,
            )
        )
    return StrictnessCost(tuple(costs))


def _slack(stack: Stack, where: slice, vdot: Array) -> Array:
    return slack_of(stack.A[where], vdot, stack.lower[where], stack.upper[where])


def _best(stack: Stack, k: int, above: int) -> float:
    """Least |slack| of level k under the first `above` levels."""
    chosen = [*stack.levels[:above], stack.levels[k]]
    sizes = [where.stop - where.start for where in chosen]
    A, lower, upper = (
        np.concatenate([array[where] for where in chosen])
        for array in (stack.Ay, stack.lower, stack.upper)
    )
    solver = Lexicographic(sizes, A.shape[1])
    solver.solve(A, lower, upper)
    return float(np.linalg.norm(solver.slack[-sizes[-1] :]))


def _unit(stack: Stack, k: int) -> str:
    """The one unit of a level's rows, if it has one and its tasks weigh the same."""
    terms = [term for term in stack.terms if term.level == k]
    units = {u for t in terms for u in t.task.wish_units(len(t.names))}
    plain = all(term.weight == 1.0 for term in terms)
    return units.pop() if len(units) == 1 and plain else "weighted"


def _takers(costs: StrictnessCost, cost: LevelCost) -> str:
    """Who took what, in words."""
    said = [
        f"level {j} ({costs.levels[j - 1].name}): {taken:.3g}"
        for j, taken in enumerate(cost.taken, 1)
        if taken > 0.0
    ]
    if cost.shortfall:
        said.append(f"resolver: {cost.shortfall:+.3g}")
    return "; ".join(said) or "-"
