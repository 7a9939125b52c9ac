"""What the welding jobs are judged by, from the simulator's truth."""

from __future__ import annotations

import numpy as np

from sims.log import Log
from sims.metrics import Metric
from sims.welding.parts import (
    CURVE_SPEED,
    DEPARTURE,
    RAMP,
    SEAM_SPEED,
    TIP,
    TRAVEL,
)
from sims.welding.workpiece import CURVE, CURVE_WORK, POINT, SEAM
from tasks import Curve, Line
from wbc.arrays import Array

__all__ = ["across", "metrics", "speed_along"]

BOUNDS = {
    "point_tip_error_max_m": (5e-5, 5e-4),
    "seam_lateral_error_max_m": (5e-5, 5e-4),
    "seam_speed_rms_error_m_s": (4e-4, 2e-3),
    "curve_lateral_error_max_m": (2e-4, 1e-3),
    "curve_travel_angle_error_max_rad": (0.02, 0.05),
}
"""Largest values: with a perfect model, and with a mismatched one."""
JOG_EFFECT = 5e-5
"""By how much jogging may change the largest lateral error [m]."""


def metrics(logs: dict[str, Log], mismatch: bool = False) -> list[Metric]:
    """The cell's own metrics.

    Args:
        logs: of "point", "seam", "seam_still" and "curve".
        mismatch: whether the simulated robot differed from the model.
    """
    point, seam, still, curve = (
        logs[name] for name in ("point", "seam", "seam_still", "curve")
    )
    lateral, calm = across(SEAM, seam).max(), across(SEAM, still).max()
    values = {
        "point_tip_error_max_m": np.linalg.norm(point.p[TIP] - POINT, axis=1).max(),
        "seam_lateral_error_max_m": lateral,
        "seam_speed_rms_error_m_s": _rms(_speed_error(SEAM, seam, SEAM_SPEED)),
        "curve_lateral_error_max_m": across(CURVE, curve).max(),
        "curve_travel_angle_error_max_rad": np.abs(travel_angle(curve) - TRAVEL).max(),
    }
    judged = [
        Metric(name, float(value), BOUNDS[name][mismatch])
        for name, value in values.items()
    ]
    length = _travelled(SEAM, seam)
    curve_speed = _rms(_speed_error(CURVE, curve, CURVE_SPEED))
    return [
        *judged,
        Metric("point_jog_range_rad", jog_range(point.R[TIP]), 0.5, ">="),
        Metric("seam_length_m", length, 0.35, ">="),
        Metric("seam_jog_range_rad", jog_range(seam.R[TIP]), 0.5, ">="),
        Metric("seam_jog_effect_m", abs(float(lateral - calm)), JOG_EFFECT),
        Metric("curve_length_m", _travelled(CURVE, curve)),
        Metric("curve_speed_rms_error_m_s", curve_speed),
        Metric("curve_work_angle_error_max_rad", np.abs(work_angle(curve)).max()),
    ]


def across(path: Line | Curve, log: Log) -> Array:
    """Distance (T,) of the tip from its path [m]."""
    tip = log.p[TIP]
    if isinstance(path, Line):
        return np.linalg.norm((tip - path.point) @ path.normals.T, axis=1)
    return np.array([np.linalg.norm(p - path.at(path.locate(p)).c[0]) for p in tip])


def _along(path: Line | Curve, log: Log) -> Array:
    """Position (T,) of the tip along its path [m]."""
    return np.array([path.locate(p) for p in log.p[TIP]])


def speed_along(path: Line | Curve, log: Log) -> Array:
    """Speed (T,) of the tip along its path, by central differences [m/s]."""
    s = _along(path, log)
    return np.gradient(s, log.t) if s.size > 1 else np.zeros_like(s)


def _speed_error(path: Line | Curve, log: Log, speed: float) -> Array:
    """Speed errors outside the ramps; NaN where the run never left them."""
    s = _along(path, log)
    cruising = (log.t > DEPARTURE + RAMP) & (s < path.length - 1.05 * speed * RAMP)
    error = (speed_along(path, log) - speed)[cruising]
    return error if error.size else np.array([np.nan])


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _travelled(path: Line | Curve, log: Log) -> float:
    s = _along(path, log)
    return float(s.max() - s.min())


def jog_range(R: Array) -> float:
    """Largest angle [rad] between two directions of the torch's axis in R (T, 3, 3)."""
    axes = R[:, :, 2]
    sample = axes[:: max(1, len(axes) // 400)]
    return float(np.arccos(np.clip(sample @ sample.T, -1.0, 1.0)).max())


def travel_angle(log: Log) -> Array:
    """Angle (T,) of the torch against the plane across the path [rad]."""
    angles = np.zeros(log.t.size)
    for i, (p, R) in enumerate(zip(log.p[TIP], log.R[TIP], strict=True)):
        tangent = CURVE.at(CURVE.locate(p)).c[1]
        angles[i] = np.arcsin(np.clip(tangent @ R[:, 2], -1.0, 1.0))
    return angles


def work_angle(log: Log) -> Array:
    """Error (T,) of the torch's work angle on the saddle [rad]."""
    errors = np.zeros(log.t.size)
    for i, (p, R) in enumerate(zip(log.p[TIP], log.R[TIP], strict=True)):
        point = CURVE.at(CURVE.locate(p))
        back = -R[:, 2]
        errors[i] = np.arctan2(back @ point.n2[0], back @ point.n1[0]) - CURVE_WORK
    return errors
