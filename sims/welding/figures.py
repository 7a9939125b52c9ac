"""Figures of the welding report."""

from __future__ import annotations

import numpy as np

from sims.log import Log
from sims.report.figures import lines3d, time_series
from sims.welding.metrics import across, speed_along, travel_angle
from sims.welding.parts import CURVE_SPEED, SEAM_SPEED, TIP, TRAVEL
from sims.welding.workpiece import CURVE, POINT, SEAM

__all__ = ["figures"]

MICRO, MILLI = 1e6, 1e3


def figures(logs: dict[str, Log]) -> list[tuple[str, str]]:
    """(caption, svg) pairs: the process first, then the robot."""
    point, seam, still, curve = (
        logs[name] for name in ("point", "seam", "seam_still", "curve")
    )
    drawn = [
        _point(point),
        _seam(seam, still),
        _speeds(seam, curve),
        _curve(curve),
        _angles(curve),
        _path(logs),
    ]
    for name, log in logs.items():
        drawn.extend(_robot(name, log))
    return drawn


def _point(log: Log) -> tuple[str, str]:
    error = np.linalg.norm(log.p[TIP] - POINT, axis=1) * MICRO
    svg = time_series(
        "Point weld: tip error while the torch is jogged",
        log.t,
        {"distance from the point": error},
        "tip error [µm]",
    )
    return "The tip stays on the point whatever the operator does with the torch.", svg


def _seam(seam: Log, still: Log) -> tuple[str, str]:
    t = seam.t if seam.t.size <= still.t.size else still.t
    lines = {
        label: across(SEAM, log)[: t.size] * MICRO
        for label, log in (("jogged", seam), ("not jogged", still))
    }
    svg = time_series("Straight seam: lateral error", t, lines, "lateral error [µm]")
    return "Jogging stands below the seam in the hierarchy: it hardly shows.", svg


def _speeds(seam: Log, curve: Log) -> tuple[str, str]:
    t = seam.t if seam.t.size <= curve.t.size else curve.t
    lines = {
        label: speed_along(path, log)[: t.size] * MILLI
        for label, path, log in (("seam", SEAM, seam), ("saddle", CURVE, curve))
    }
    wanted = {"seam, wanted": SEAM_SPEED * MILLI, "saddle, wanted": CURVE_SPEED * MILLI}
    svg = time_series("Travel speed", t, lines, "speed [mm/s]", bounds=wanted)
    return "Smooth ramps at both ends, and a stop before the end of the path.", svg


def _curve(log: Log) -> tuple[str, str]:
    lateral = across(CURVE, log) * MICRO
    svg = time_series(
        "Saddle: lateral error", log.t, {"saddle": lateral}, "lateral error [µm]"
    )
    return "Distance of the tip from the intersection of the two pipes.", svg


def _angles(log: Log) -> tuple[str, str]:
    error = (travel_angle(log) - TRAVEL) * MILLI
    title = f"Saddle: travel angle, wanted {np.degrees(TRAVEL):.1f} deg"
    svg = time_series(title, log.t, {"travel angle": error}, "angle error [mrad]")
    return "The torch pushes at a constant angle all around the pipe.", svg


def _path(logs: dict[str, Log]) -> tuple[str, str]:
    lines = {name: logs[name].p[TIP] for name in ("seam", "curve")}
    return "Path of the torch tip.", lines3d("Path of the torch tip", lines)


def _robot(name: str, log: Log) -> list[tuple[str, str]]:
    share = np.abs(log.torque) / log.robot.tau_max
    joints = dict(zip(log.robot.joint_names, share.T, strict=True))
    torques = time_series(
        f"{name}: use of the torque limits", log.t, joints, "share of limit [1]"
    )
    return [(f"Joint torques of the job '{name}'.", torques)]
