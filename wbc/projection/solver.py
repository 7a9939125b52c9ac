"""The projection as an object: fixed arrays, held bounds kept between calls."""

from __future__ import annotations

from collections.abc import Sequence
from typing import final

import numpy as np

from wbc.arrays import Array
from wbc.compiled import announce
from wbc.damped import DampedInverse
from wbc.memory import Memory
from wbc.projection.active import saturate
from wbc.projection.work import WORK

__all__ = ["Projection"]


@final
class Projection:
    """Levels of rows lower <= A y <= upper by projection, bounds by saturation.

    Args:
        sizes: number of rows of every level, from the top.
        n: number of unknowns.
        damping: of the levels' inverses; bounds are always inverted exactly.
        alone: solve each level without regard to those above, then project (UF).
        tasks: (m,) first row of the task that each row belongs to; by default each row
            is a task. An equality of a task that bounds other rows is a bound without
            room, and counts as one.

    Attributes:
        y: (n,) the result of the last call; overwritten by the next.
        side: (m,) bounds that are held: 1 at upper, -1 at lower, 0 for other rows.
        ranks: (p,) directions that every level could use.
        directions: (n, n) orthonormal rows; those that levels use come first, level by
            level.
    """

    def __init__(
        self,
        sizes: Sequence[int],
        n: int,
        damping: DampedInverse | None = None,
        alone: bool = False,
        tasks: Sequence[int] | None = None,
    ) -> None:
        self._memory = Memory(sizes, n, WORK)
        memory = self._memory
        self.y, self.side, self.ranks = memory["y"], memory["side"], memory["ranks"]
        self.directions = memory["Z"]
        memory["alone"][0] = alone
        memory["task"][:] = np.arange(self.side.size) if tasks is None else tasks
        memory["damping"][:] = (
            (1.0, 0.0) if damping is None else (damping.threshold, damping.factor)
        )
        announce(saturate, "the projection")
        m = self.side.size  # compile now, by solving nothing, not within a loop
        self.solve(np.zeros((m, n)), np.zeros(m), np.zeros(m), np.zeros(n))

    def solve(self, A: Array, lower: Array, upper: Array, rest: Array) -> bool:
        """Hold violated bounds and release those that pull, until neither is left.

        Args:
            A: (m, n) the levels' rows, stacked, in coordinates where the law's metric
                is the identity; C-contiguous, finite.
            lower: (m,) -inf where there is no bound.
            upper: (m,) +inf where there is no bound; not below `lower`.
            rest: (n,) what y would be if all motion were to die out.

        Returns:
            whether that came to an end; it may go round in circles.
        """
        return self._run(A, lower, upper, rest, True) > 0

    def keep(self, A: Array, lower: Array, upper: Array, rest: Array) -> bool:
        """The same without releasing any; whether what was held was all it takes."""
        return self._run(A, lower, upper, rest, False) == 1

    def _run(
        self, A: Array, lower: Array, upper: Array, rest: Array, release: bool
    ) -> int:
        return saturate(A, lower, upper, rest, self._memory.address, release)
