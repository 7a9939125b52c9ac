"""The local update of the knife's y: as the paper prints it, and as it works."""

from __future__ import annotations

from typing import Final, Literal, TypeAlias, final, get_args

from sims.cutting.live import Sight
from sims.cutting.timelaw import Motion
from wbc import UnknownName
from wbc.arrays import positive

__all__ = ["Correction", "Experiment"]

SLOW: Final = 0.015
"""Forward speed at which half of the line's own motion is fed forward [m/s]."""

Experiment: TypeAlias = Literal["local", "initial", "printed"]


SHARES: Final[dict[Experiment, float]] = {"local": 1.0, "printed": 0.5, "initial": 0.0}
"""Of y_g - y_d, where each settles."""


@final
class Correction:
    """Adds Delta y to the planned y, P0 eq. (18), smooth enough to be fed forward.

    - "initial": Delta y = 0, the line of the start of the passage;
    - "local": Delta y = y_g - y_d with its rate, so that y* = y_g;
    - "printed": Delta y = y_g - y_c as in eq. (19). Fed with the knife's own y_c,
      it settles half-way between the planned and the live line.

    Delta y is followed by a critically damped second-order filter. The live line's own
    motion is fed forward by as much as the knife moves forward: one that hardly does
    drags the meat along sideways, and would chase a line that flees from it.

    Args:
        experiment: which.
        quickness: of the filter [1/s].

    Raises:
        UnknownName: no such experiment.
    """

    def __init__(self, experiment: Experiment, quickness: float = 50.0) -> None:
        if experiment not in get_args(Experiment):
            raise UnknownName("experiment", experiment, get_args(Experiment))
        self.experiment = experiment
        self._quickness = positive(quickness, "quickness")
        self.restart()

    def restart(self, offset: float = 0.0) -> float:
        """Begin again, and return Delta y: where it would settle.

        Args:
            offset: y_g - y_d at the start [m].
        """
        self._value = SHARES[self.experiment] * offset
        self._rate = 0.0
        return self._value

    def tick(
        self, dt: float, seen: Sight | None, planned: Motion, knife_y: float, xd: float
    ) -> Motion:
        """Delta y after another dt [s].

        Args:
            dt: [s].
            seen: the live line at the knife's x; None holds the last Delta y.
            planned: y_d with its rate [m, m/s].
            knife_y: y_c [m].
            xd: speed along x [m/s].
        """
        wanted, rate = self._wanted(seen, planned, knife_y, xd)
        w = self._quickness
        bent = w * w * (wanted - self._value) + 2.0 * w * (rate - self._rate)
        self._rate += dt * bent
        self._value += dt * self._rate
        return Motion(self._value, self._rate, bent)

    def _wanted(
        self, seen: Sight | None, planned: Motion, knife_y: float, xd: float
    ) -> tuple[float, float]:
        if self.experiment == "initial":
            return 0.0, 0.0
        if seen is None:
            return self._value, 0.0
        if self.experiment == "printed":
            return seen.y - knife_y, 0.0
        rate = seen.rate * abs(xd) / (abs(xd) + SLOW) + seen.slope * xd - planned.rate
        return seen.y - planned.value, rate
