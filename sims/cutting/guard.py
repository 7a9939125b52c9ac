"""When the cell must stop: a knife that is stuck, a force out of bounds."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import final

from wbc.arrays import Array

__all__ = ["Guard"]


@final
@dataclass(slots=True)
class Guard:
    """Watches knife and pull; says why to stop.

    Attributes:
        lag: how far the tip may be from its target [m].
        cutting: largest force of the knife [N]; 137 N at the tip are all that the
            38 Nm of the sixth joint can hold.
        excess: by how much the pull may be above what is wanted [N]. Below it may be:
            a muscle that comes free takes no force.
        patience: how long any of these may last [s].
    """

    lag: float = 0.015
    cutting: float = 120.0
    excess: float = 40.0
    patience: float = 0.05
    _since: dict[str, float] = field(default_factory=dict)

    def check(
        self, t: float, tip: Array, wanted: Array, knife: Array, pull: float, due: float
    ) -> str | None:
        """A reason to stop, or None.

        Args:
            t: [s].
            tip: (3,) of the knife [m].
            wanted: (3,) its target [m].
            knife: (6,) wrench of the knife on the meat [N, Nm].
            pull: force along the pull [N].
            due: what it should be [N].
        """
        behind, force = math.dist(tip, wanted), math.hypot(*knife[:3].tolist())
        if self._lasts("lag", t, behind > self.lag):
            return f"knife blocked at {_place(tip)}: {1e3 * behind:.0f} mm behind"
        if self._lasts("cutting", t, force > self.cutting):
            return f"cutting force out of bounds at {_place(tip)}: {force:.0f} N"
        if self._lasts("pull", t, pull - due > self.excess):
            return f"pull out of bounds: {pull:.0f} N instead of {due:.0f} N"
        return None

    def _lasts(self, what: str, t: float, wrong: bool) -> bool:
        if not wrong:
            self._since.pop(what, None)
            return False
        return t - self._since.setdefault(what, t) >= self.patience


def _place(p: Array) -> str:
    return f"({p[0]:.3f}, {p[1]:.3f}, {p[2]:.3f}) m"
