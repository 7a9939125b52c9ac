"""The local update of the knife's y: as the paper prints it, and as it works."""

from __future__ import annotations

from typing import Literal, TypeAlias, final, get_args

from sims.cutting.live import Sight
from sims.cutting.timelaw import Motion
from wbc import UnknownName
from wbc.arrays import positive

__all__ = ["Correction", "Experiment"]

Experiment: TypeAlias = Literal["local", "initial", "printed"]


@final
class Correction:
    """Adds Delta y to the planned y, P0 eq. (18), smooth enough to be fed forward.

    - "initial": Delta y = 0, the line of the start of the passage;
    - "local": Delta y = y_g - y_d with its rate, so that y* = y_g;
    - "printed": Delta y = y_g - y_c as in eq. (19). Fed with the knife's own y_c,
      it settles half-way between the planned and the live line.

    Delta y is followed by a critically damped second-order filter.

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

    def restart(self) -> None:
        """Begin again at zero."""
        self._value = self._rate = 0.0

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
        rate = seen.rate + seen.slope * xd - planned.rate
        return seen.y - planned.value, rate
