"""One instant to resolve, as a state and levels of fixed rows; families of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TypeAlias, final

import numpy as np

from sims.compare.arm import random_arm, random_state
from wbc import Hierarchy, Level, Robot, Rows, Solution, State, Task, solve_hierarchy
from wbc.arrays import Array

__all__ = ["FAMILIES", "Family", "FixedRows", "Problem", "problems"]

Rng: TypeAlias = np.random.Generator
LevelRows: TypeAlias = tuple[Array, Array, Array]


@final
class FixedRows(Task):
    """Lower <= A vdot <= upper with matrices that stay as they are.

    Args:
        name: of the task.
        A: (m, n).
        lower, upper: (m,).
    """

    def __init__(self, name: str, A: Array, lower: Array, upper: Array) -> None:
        super().__init__(name, "-")
        self.A, self.lower, self.upper = A, lower, upper

    def row_names(self, robot: Robot) -> tuple[str, ...]:
        """Numbers."""
        del robot
        return tuple(str(i + 1) for i in range(self.lower.size))

    def update(self, state: State, rows: Rows) -> None:
        """Write the rows."""
        rows.A[:], rows.lower[:], rows.upper[:] = self.A, self.lower, self.upper


@final
@dataclass(frozen=True, slots=True, eq=False)
class Problem:
    """One instant to resolve.

    Attributes:
        state: of the robot.
        levels: (A (m, n), lower (m,), upper (m,)) in vdot, from the top.
    """

    state: State
    levels: tuple[LevelRows, ...]

    @classmethod
    def of(cls, solution: Solution, state: State) -> Problem:
        """What a controller resolved in its last tick."""
        return cls(state, tuple(solution.level_rows()))

    def hierarchy(self) -> Hierarchy:
        """The levels as tasks."""
        return Hierarchy(
            *(
                Level.of(FixedRows(f"level {k}", *rows))
                for k, rows in enumerate(self.levels, 1)
            )
        )

    def perturbed(self, k: int, rng: Rng, size: float) -> Problem:
        """The same with other targets of level k, from 0, by up to `size`."""
        A, lower, upper = self.levels[k]
        change = rng.uniform(-size, size, lower.size)
        other = (A, lower + change, upper + change)
        return replace(self, levels=(*self.levels[:k], other, *self.levels[k + 1 :]))

    def scaled(self, share: float) -> Problem:
        """The same with all targets at this share; bounds stay."""
        levels = []
        for A, lower, upper in self.levels:
            factor = np.where(lower == upper, share, 1.0)
            levels.append((A, lower * factor, upper * factor))
        return replace(self, levels=tuple(levels))


@final
@dataclass(frozen=True, slots=True)
class Family:
    """Random stacks of one kind.

    Attributes:
        name: of the family.
        axes: of the arm.
        levels: of equalities.
        rows: of each level.
        conflict: share of levels whose rows lie in those above, with other targets.
        singular: share of levels that lose a direction of their own.
        limits: by how much the accelerations are cut below what the tasks would use;
            0 for no limits, 0.5 for half of the largest. They are the top level.
    """

    name: str
    axes: int = 7
    levels: int = 3
    rows: int = 2
    conflict: float = 0.0
    singular: float = 0.0
    limits: float = 0.0

    @property
    def text(self) -> str:
        """The parameters in words."""
        return (
            f"{self.axes} axes, {self.levels} levels of {self.rows} rows, conflict "
            f"{self.conflict:g}, singular {self.singular:g}, limits {self.limits:g}"
        )


FAMILIES = (
    Family("compatible"),
    Family("many levels", axes=12, levels=6, rows=2, conflict=0.2),
    Family("conflict", levels=4, conflict=0.7),
    Family("singular", levels=3, rows=3, singular=0.7),
    Family("limits", levels=3, limits=0.5),
    Family("everything", axes=9, levels=4, conflict=0.4, singular=0.4, limits=0.4),
)


def problems(family: Family, count: int, seed: int) -> Iterator[Problem]:
    """So many of a family, always the same for a seed."""
    for index in range(count):
        rng = np.random.default_rng([seed, index, *family.name.encode()])
        yield _random(family, rng)


def _random(family: Family, rng: Rng) -> Problem:
    state = random_state(random_arm(rng, family.axes), rng)
    levels: list[LevelRows] = []
    for _ in range(family.levels):
        A = rng.normal(size=(family.rows, family.axes))
        if levels and rng.uniform() < family.conflict:
            above = np.vstack([rows for rows, _, _ in levels])
            A = rng.normal(size=(family.rows, len(above))) @ above / np.sqrt(len(above))
        if rng.uniform() < family.singular:
            A[-1] = rng.normal(size=family.rows - 1) @ A[:-1]
        b = 5.0 * rng.normal(size=family.rows)
        levels.append((A, b, b))
    if family.limits > 0.0:
        free = np.abs(solve_hierarchy(levels).x).max() * (1.0 - family.limits)
        box = np.full(family.axes, free)
        levels.insert(0, (np.eye(family.axes), -box, box))
    return Problem(state, tuple(levels))
