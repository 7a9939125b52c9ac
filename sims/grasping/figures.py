"""Figures of the grasping report."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from sims.grasping.metrics import OBJECT, Result, misfit, slip
from sims.grasping.plan import TCP
from sims.report.figures import lines3d, time_series, xy
from wbc.arrays import Array

__all__ = ["figures"]

MICRO, MILLI = 1e6, 1e3
SHOWN = 4
"""Cases whose curves are drawn; the metrics are those of all."""


def figures(results: list[Result]) -> list[tuple[str, str]]:
    """(caption, svg) pairs: the process first, then the robot."""
    done = [result for result in results if result.complete]
    drawn = [_rims(results), _paths(results)]
    if done:
        drawn += [_misfit(done), _slip(done), _height(done)]
    return drawn + _robot(results[0])


def _rims(results: list[Result]) -> tuple[str, str]:
    """Seen from above the cylinder: the rims, and where they were grasped."""
    angle, curves = np.linspace(0.0, 2.0 * np.pi, 90), {}
    for result in results[:SHOWN]:
        cylinder = result.job.cylinder
        r = cylinder.rim * MILLI
        curves[cylinder.name] = (r * np.cos(angle), r * np.sin(angle))
        grasp = result.job.plan.grasp.X
        tcp = (grasp.translation - cylinder.p) @ cylinder.R
        closing = cylinder.R.T @ grasp.rotation[:, 0]
        ends = MILLI * (tcp + np.outer([-0.012, 0.012], closing))
        curves[f"fingers at {cylinder.name.split(':')[0]}"] = (ends[:, 0], ends[:, 1])
    svg = xy("Grasps on the rim, seen along the axis", curves, "x [mm]", "y [mm]")
    return "The place on the rim is the one nearest to the arm's posture.", svg


def _paths(results: list[Result]) -> tuple[str, str]:
    lines = {r.job.cylinder.name: r.log.p[TCP] for r in results[:SHOWN]}
    return "Path of the tcp: reach, grasp, lift, carry, place.", lines3d(
        "Path of the tcp", lines
    )


def _misfit(results: list[Result]) -> tuple[str, str]:
    def error(result: Result) -> Array:
        span = result.span("approach", "close")
        lengths, _ = misfit(result.job.cylinder, result.log, span)
        return np.abs(lengths).max(axis=1) * MICRO

    svg = _curves("Error of the grasp while closing", results, error, "error [µm]")
    return "The four constraints of the rim grasp, from the simulator's truth.", svg


def _slip(results: list[Result]) -> tuple[str, str]:
    def moved(result: Result) -> Array:
        return slip(result.log, result.span("close", "settle")) * MICRO

    svg = _curves("Slip since the fingers closed", results, moved, "slip [µm]")
    return "How far the cylinder moves in the fingers, lifted and carried.", svg


def _height(results: list[Result]) -> tuple[str, str]:
    def height(result: Result) -> Array:
        z = result.log.p[OBJECT][:, 2]
        return (z - z[0]) * MILLI

    svg = _curves("Height of the cylinder", results, height, "height [mm]")
    return "Lifted by 100 mm, carried, and put down upright.", svg


def _curves(
    title: str, results: list[Result], values: Callable[[Result], Array], label: str
) -> str:
    """One curve a case over the time since it began; the shorter ones end earlier."""
    curves = {r.job.cylinder.name: values(r) for r in results[:SHOWN]}
    longest = max(len(curve) for curve in curves.values())
    padded = {
        name: np.append(curve, np.full(longest - len(curve), np.nan))
        for name, curve in curves.items()
    }
    dt = results[0].log.t[1] - results[0].log.t[0]
    return time_series(title, dt * np.arange(longest), padded, label)


def _robot(result: Result) -> list[tuple[str, str]]:
    log, name = result.log, result.job.cylinder.name
    share = np.abs(log.torque) / log.robot.tau_max
    joints = dict(zip(log.robot.joint_names, share.T, strict=True))
    title = f"{name}: use of the torque limits"
    torques = time_series(title, log.t, joints, "share of limit [1]")
    return [(f"Joint torques of the job '{name}'.", torques)]
