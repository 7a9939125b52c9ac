"""The indicators of random stacks, sampled along the runs of a cell."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import final

import numpy as np

from sims.compare.indicators import Indicators, measure, reference
from sims.compare.problems import Problem
from sims.metrics import Metric
from wbc import Controller, Solution, SolverError
from wbc.arrays import Array

__all__ = ["Sampler"]

EVERY = 200
"""Ticks between two samples, each of which costs many ticks."""


@final
@dataclass(eq=False)
class Sampler:
    """Looks at every tick of the runs that a resolver controls.

    Args:
        resolver: name; runs under others, which some cells bring along, are left out.
        seed: of the perturbations.
    """

    resolver: str
    seed: int = 0
    _found: list[Indicators] = field(default_factory=list)
    _last: tuple[Controller, Array] | None = None
    _rate: float = 0.0

    def __call__(
        self, tick: int, controller: Controller, solution: Solution, q: Array, v: Array
    ) -> None:
        """See a tick, before the controller is called again."""
        if controller.resolver.name != self.resolver:
            return
        if self._last is not None and self._last[0] is controller and tick > 0:
            change = float(np.abs(solution.torque - self._last[1]).max())
            self._rate = max(self._rate, change / controller.dt)
        self._last = controller, solution.torque
        if tick % EVERY == 0 and solution.ok and solution.share == 1.0:
            self._sample(controller, solution, q, v)

    def _sample(
        self, controller: Controller, solution: Solution, q: Array, v: Array
    ) -> None:
        problem = Problem.of(solution, controller.robot.state(q, v))
        rng = np.random.default_rng([self.seed, len(self._found)])
        try:
            best, _ = reference(problem)
        except SolverError:
            return  # without an optimum there is nothing to compare with
        self._found.append(measure(problem, controller.resolver, best, rng))

    def metrics(self) -> list[Metric]:
        """What was found; nothing where nothing was seen."""
        found = [f for f in self._found if not np.isnan(f.leak)]
        if not found:
            return []
        of = {
            name: np.array([getattr(f, name) for f in found])
            for name in ("leak", "gap", "violation", "gauss", "acceleration")
        }
        return [
            Metric("samples", len(found)),
            Metric("leak_max_relative", float(of["leak"].max())),
            Metric("optimality_gap_max_relative", float(of["gap"].max())),
            Metric("optimality_gap_median_relative", float(np.median(of["gap"]))),
            Metric("top_bound_excess_max_relative", float(of["violation"].max())),
            Metric("gauss_effort_mean_w_s", float(of["gauss"].mean())),
            Metric("acceleration_norm_mean_rad_s2", float(of["acceleration"].mean())),
            Metric("torque_rate_max_nm_s", self._rate),
        ]
