"""Time series of a run, and the metrics that every cell shares."""

from __future__ import annotations

from typing import final

import mujoco
import numpy as np

from sims.cell import Cell, Observation
from sims.levels import LevelLog
from sims.metrics import Metric, table
from wbc import Controller, Solution, UnknownName
from wbc.arrays import Array

__all__ = ["Log", "shared_metrics"]

ROUND_OFF = 1e-9
"""A torque counts as beyond its limit from here on, relative to the limit."""


@final
class Log:
    """What a run keeps of every tick; row i belongs to time t[i].

    Attributes:
        t: (T,) time [s].
        q, v: (T, n) true positions and velocities [rad, rad/s].
        torque: (T, n) commanded torques [Nm].
        qpos: (T, nq) of the whole simulated world; (T, 0) where it is not kept.
        errors: task name -> (T,) norm of its error, in the task's unit.
        units: task name -> unit of its error.
        active: "level k: task: row" -> (T,) whether that bound was active.
        wrenches: sensor name -> (T, 6) what the controller saw [N, Nm].
        ranks: (T, p) directions that each level could use.
        levels: what the tasks of every level went without, sampled.
        p, R: site name -> (T, 3) and (T, 3, 3) true poses.
        tick: (T,) time of the controller's call [s].
        spent: processor time of control and simulation [s], certificates not counted.
        failures: ticks that fell back.
        worst_certificate: largest residual of the sampled certificates, NaN if none.
    """

    def __init__(
        self,
        cell: Cell,
        controller: Controller,
        ticks: int,
        sites: tuple[str, ...],
        world: bool = True,
    ) -> None:
        n, tasks = cell.robot.nv, list(controller.hierarchy.tasks())
        self.robot, self._controller = cell.robot, controller
        self._cell, self._failed = cell, controller.failures
        self.t, self.tick = np.zeros(ticks), np.zeros(ticks)
        self.q, self.v, self.torque = (np.zeros((ticks, n)) for _ in range(3))
        self._world = world
        self.qpos = np.zeros((ticks, cell.model.nq if world else 0))
        self.ranks = np.zeros((ticks, len(controller.hierarchy)), dtype=int)
        self.errors = {task.name: np.full(ticks, np.nan) for task in tasks}
        self.units: dict[str, str] = {}
        self._learn_units()
        self.active: dict[str, Array] = {}
        self.levels = LevelLog(ticks)
        self.wrenches: dict[str, Array] = {}
        self._sites = {name: _site(cell, name) for name in sites}
        self.p = {name: np.zeros((ticks, 3)) for name in sites}
        self.R = {name: np.zeros((ticks, 3, 3)) for name in sites}
        self.spent, self.worst_certificate, self.count = 0.0, 0.0, 0

    def record(
        self, tick: int, seen: Observation, solution: Solution, spent: float
    ) -> None:
        """Keep one tick, before the cell moves on."""
        d = self._cell.data
        self.count = tick + 1
        self.t[tick], self.tick[tick] = seen.t, spent
        self.q[tick], self.v[tick] = self._cell.truth
        self.torque[tick] = solution.torque
        if self._world:
            self.qpos[tick] = d.qpos
        for name, wrench in seen.wrenches.items():
            if name not in self.wrenches:
                self.wrenches[name] = np.zeros((self.t.size, 6))
            self.wrenches[name][tick] = wrench
        for name, site in self._sites.items():
            self.p[name][tick] = d.site_xpos[site]
            self.R[name][tick] = d.site_xmat[site].reshape(3, 3)
        self.levels.record(tick, seen.t, solution)
        if solution.ok:
            self._keep_ranks(tick, solution.ranks)
            for name, error in solution.error_norms():
                if name not in self.errors:
                    self._learn_units()
                    self.errors[name] = np.full(self.t.size, np.nan)
                self.errors[name][tick] = error
            for name in solution.active_rows():
                if name not in self.active:
                    self.active[name] = np.zeros(self.t.size, dtype=bool)
                self.active[name][tick] = True

    def _learn_units(self) -> None:
        tasks = self._controller.hierarchy.tasks()
        self.units |= {task.name: task.unit for task in tasks}

    def _keep_ranks(self, tick: int, ranks: tuple[int, ...]) -> None:
        """Another hierarchy may have more levels than the first one, or fewer."""
        more = len(ranks) - self.ranks.shape[1]
        if more > 0:
            self.ranks = np.pad(self.ranks, ((0, 0), (0, more)))
        self.ranks[tick, : len(ranks)] = ranks

    def trimmed(self) -> Log:
        """The same log without the ticks that did not happen."""
        k = self.count
        for name in ("t", "tick", "q", "v", "torque", "qpos", "ranks"):
            setattr(self, name, getattr(self, name)[:k])
        for series in (self.errors, self.active, self.wrenches, self.p, self.R):
            for name in series:
                series[name] = series[name][:k]
        self.levels.trim()
        self.failures = self._controller.failures - self._failed
        if not self._controller.resolver.name.startswith("hqp"):
            self.worst_certificate = np.nan
        return self

    def arrays(self) -> dict[str, Array]:
        """Everything by name, for a file."""
        named = {"t": self.t, "q": self.q, "v": self.v, "torque": self.torque}
        named |= {"ranks": self.ranks, "tick_s": self.tick}
        named |= {f"error/{name}": e for name, e in self.errors.items()}
        named |= {f"active/{name}": a for name, a in self.active.items()}
        named |= {f"wrench/{name}": w for name, w in self.wrenches.items()}
        named |= {f"p/{name}": p for name, p in self.p.items()}
        return named | self.levels.arrays()

    def summary(self) -> str:
        """Shared metrics and the last error of every task, as text."""
        ends = [
            f"{name:<24} {error[-1]:.3g}"
            for name, error in self.errors.items()
            if np.isfinite(error[-1:]).all()
        ]
        return "\n".join([table(shared_metrics([self])), "", "error at the end", *ends])


def shared_metrics(logs: list[Log]) -> list[Metric]:
    """The metrics that every cell reports, over all its runs."""
    ticks = np.concatenate([log.tick for log in logs]) * 1e6
    simulated = sum(log.t.size * log._cell.model.opt.timestep for log in logs)
    spent = sum(log.spent for log in logs)
    metrics = [
        Metric("ticks", ticks.size),
        Metric("tick_median_us", float(np.median(ticks))),
        Metric("tick_p99_us", float(np.percentile(ticks, 99))),
        Metric("realtime_factor", simulated / spent, 1.0, ">="),
        Metric("solver_failures", sum(log.failures for log in logs), 0, "=="),
        Metric("torque_limit_violation_nm", max(map(_torque, logs)), 0, "=="),
        Metric("joint_limit_violation_rad", max(map(_position, logs)), 0, "=="),
    ]
    worst = max(log.worst_certificate for log in logs)
    if np.isfinite(worst):
        metrics.append(Metric("worst_certificate_residual", worst, 1e-6))
    return metrics


def _torque(log: Log) -> float:
    limit = log.robot.tau_max * (1.0 + ROUND_OFF)
    return float(np.maximum(np.abs(log.torque) - limit, 0.0).max())


def _position(log: Log) -> float:
    robot = log.robot
    outside = np.maximum(log.q - robot.q_max, robot.q_min - log.q)
    return float(np.maximum(outside, 0.0).max())


def _site(cell: Cell, name: str) -> int:
    site = mujoco.mj_name2id(cell.model, mujoco.mjtObj.mjOBJ_SITE, name)
    if site < 0:
        valid = [cell.model.site(i).name for i in range(cell.model.nsite)]
        raise UnknownName("site", name, valid)
    return int(site)
