"""What the cutting cell is judged by, from the simulator's truth."""

from __future__ import annotations

from typing import Final

import numpy as np

from sims.cutting.clearance import arm_clearance
from sims.cutting.correction import Experiment
from sims.cutting.loop import Run
from sims.cutting.record import Record
from sims.log import Log
from sims.metrics import Metric
from wbc.arrays import Array, BoolArray

__all__ = ["metrics", "opening_after", "while_cutting"]

REST: Final = 0.3
"""Time after a stroke at which the opening is measured [s]."""
LOCAL: Final = {
    "guide_error_rms_m": 1e-3,
    "muscle_cut_length_m": 0.005,
    "pull_force_std_n": 5.0,
}
"""What only the corrected update is held to."""
APART: Final = 0.08
"""Least distance between the axes of the two arms' links and tools [m]."""


def metrics(run: Run, experiment: Experiment, passages: int) -> list[Metric]:
    """The cell's own metrics.

    Args:
        run: a cut.
        experiment: how the guide line was updated, which decides the bounds.
        passages: as many as were planned.
    """
    record, job, tissue = run.record, run.job, run.cell.tissue
    local = experiment == "local"
    pull = record.pull[while_cutting(record, job.separated_at)]
    own = [
        Metric("links_cut_fraction", tissue.links_cut_fraction, 1, "=="),
        Metric("links_torn_fraction", tissue.links_torn_fraction),
        Metric("separated", float(tissue.separated), 1, "=="),
        Metric("passages", job.passages.completed, passages, "=="),
        _bounded("muscle_cut_length_m", tissue.muscle_cut_length, local),
        _bounded("guide_error_rms_m", guide_error(record), local),
        Metric("pull_force_mean_n", _mean(pull), 102.0),
        Metric("pull_force_mean_least_n", _mean(pull), 98.0, ">="),
        _bounded("pull_force_std_n", _spread(pull), local),
        Metric("cutting_force_max_n", np.linalg.norm(record.knife, axis=1).max()),
        Metric("knife_orientation_error_max_rad", record.heading_error.max(), 0.03),
        Metric("arm_clearance_min_m", arm_clearance(run), APART, ">="),
        Metric("joint_speed_violation_rad_s", max(map(_speeding, run.logs)), 0, "=="),
        Metric("stopped_early", float(job.stopped is not None), 0, "=="),
    ]
    return own[:6] + _openings(record, job.passages.ended) + own[6:]


def _bounded(name: str, value: float, local: bool) -> Metric:
    return Metric(name, value, LOCAL[name] if local else None)


def _mean(values: Array) -> float:
    return float(values.mean()) if values.size else np.nan


def _spread(values: Array) -> float:
    return float(values.std()) if values.size else np.nan


def while_cutting(record: Record, separated_at: float) -> BoolArray:
    """Samples (T,) of strokes, as long as links hold."""
    return (record.stroke >= 0) & (record.t < separated_at)


def guide_error(record: Record) -> float:
    """Root mean square of the knife's distance from the guide line, along y [m]."""
    error = record.guide_error[np.isfinite(record.guide_error)]
    return float(np.sqrt(np.mean(error**2))) if error.size else np.nan


def opening_after(record: Record, ended: list[float]) -> list[float]:
    """Mean opening after each passage [m]."""
    at = [np.searchsorted(record.coarse_t, t + REST) for t in ended]
    return [float(record.opening[min(i, record.opening.size - 1)]) for i in at]


def _openings(record: Record, ended: list[float]) -> list[Metric]:
    """Openings, each to be larger than the one before; the last is separation."""
    found, least = [], 0.0
    for number, opening in enumerate(opening_after(record, ended)[:-1], 1):
        found.append(Metric(f"opening_m_pass_{number}", opening, least, ">"))
        least = opening
    return found


def _speeding(log: Log) -> float:
    return float(np.maximum(np.abs(log.v) - log.robot.v_max, 0.0).max())
