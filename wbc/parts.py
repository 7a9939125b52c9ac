"""The one array that a compiled tick writes."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["Parts"]


class Parts(NamedTuple):
    """Where things lie in it.

    Attributes:
        torque: (n,) joint torques.
        vdot: (n,) joint accelerations.
        slacks: (m,) weighted slack of every row when its own level was solved.
        ranks: (p,) for each level, how many independent directions it could use.
    """

    torque: slice
    vdot: slice
    slacks: slice
    ranks: slice

    @classmethod
    def of(cls, n: int, m: int, p: int) -> Parts:
        """For n joints, m rows and p levels; `ranks.stop` is the array's size."""
        ends = (n, 2 * n, 2 * n + m, 2 * n + m + p)
        return cls(*map(slice, (0, *ends[:-1]), ends))
