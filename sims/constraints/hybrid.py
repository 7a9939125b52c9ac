"""P4 section III-C: a plane of unknown height and tilt, found and followed by force."""

from __future__ import annotations

import numpy as np

from sims.constraints.case import (
    DOWN,
    Case,
    Stack,
    Trial,
    limits,
    posture_at,
)
from sims.constraints.follower import SLIDE, Follower, axes_along
from sims.constraints.plane import STIFF, TURNING, angle
from sims.constraints.surface import NORMAL, PLANE, TIP
from sims.metrics import Metric
from sims.report.figures import time_series
from tasks import AxisAlignment, Damping, ForceLaw, HybridForceMotion
from wbc import Robot
from wbc.arrays import Array

__all__ = ["cases", "figures", "metrics"]

FORCE = 20.0
"""That the probe should press with [N]."""
HEIGHT = 0.012
"""Of the start over the plate, which the controller does not know [m]."""
APPROACH = 0.01
"""Speed of the search [m/s]."""
DURATION = 11.5
"""More than it takes to find the plate, to turn twice and to slide [s]."""
START = PLANE.point + np.array([0.0, -0.10, 0.0])


def cases(robot: Robot) -> list[Case]:
    """One run, all phases."""
    start = posture_at(robot, START + HEIGHT * NORMAL)
    make = lambda q, t: _stack(robot, q)  # noqa: E731
    return [Case("hybrid", make, DURATION, start, contact=True)]


def _stack(robot: Robot, q: Array) -> Stack:
    p = robot.state(q).frame(TIP).p
    press = HybridForceMotion(
        TIP,
        p,
        [0.0, 0.0, FORCE],
        axes=axes_along(DOWN),
        law=ForceLaw(0.5, 25.0),
        stiffness=STIFF,
        approach=APPROACH,
        name="press and slide",
    )
    axis = AxisAlignment(TIP, DOWN, stiffness=TURNING, name="probe along force")
    return limits() >> press >> axis >> Damping(), Follower(press, axis)


def metrics(trials: dict[str, Trial], mismatch: bool) -> list[Metric]:
    """Force, normal and contact while sliding, and the impact."""
    del mismatch
    trial = trials["hybrid"]
    sliding = _sliding(trial)
    force = trial.touch[sliding]
    way = trial.log.p[TIP][sliding]
    if not force.size:
        rms = lean = lost = length = np.nan
    else:
        rms = float(np.sqrt(np.mean((force - FORCE) ** 2)))
        lean = float(angle(trial.log)[sliding].max())
        lost = float(np.mean(force <= 0.0))
        length = float(np.linalg.norm(way[-1] - way[0]))
    return [
        Metric("hybrid_force_error_rms_n", rms, 0.5),
        Metric("hybrid_normal_error_rad", lean, 0.01),
        Metric("hybrid_contact_lost_fraction", lost, 0.01),
        Metric("hybrid_slide_length_m", length, 0.2, ">="),
        Metric("hybrid_impact_peak_n", float(trial.touch.max()), 60.0),
    ]


def _sliding(trial: Trial) -> slice:
    """The ticks of the slide; none if it never came to that."""
    script = trial.stack[1]
    if not isinstance(script, Follower) or np.isnan(script.slid):
        return slice(0, 0)
    begin, end = np.searchsorted(trial.log.t, [script.slid, script.slid + SLIDE])
    return slice(int(begin), int(end))


def figures(trials: dict[str, Trial]) -> list[tuple[str, str]]:
    """Force, direction and way over time."""
    trial = trials["hybrid"]
    log, t, script = trial.log, trial.log.t, trial.stack[1]
    spans = []
    if isinstance(script, Follower) and np.isfinite([script.found, script.slid]).all():
        end = min(script.slid + SLIDE, t[-1])
        spans = [
            ("search", 0.0, script.found),
            ("align", script.found, script.slid),
            ("slide", script.slid, end),
        ]
    own = log.R[TIP].transpose(0, 2, 1) @ log.wrenches["wrist"][:, :3, None]
    felt = dict(zip("xyz", own[..., 0].T, strict=True))
    force = time_series(
        "Hybrid: normal force, true",
        t,
        {"normal force": trial.touch},
        "force [N]",
        bounds={"wanted": FORCE},
        spans=spans,
    )
    across = time_series(
        "Hybrid: measured force in the probe's axes", t, felt, "force [N]", spans=spans
    )
    lean = time_series(
        "Hybrid: angle between probe and normal",
        t,
        {"angle": angle(log)},
        "angle [rad]",
        spans=spans,
    )
    gone = time_series(
        "Hybrid: way of the tip",
        t,
        {"from where it begins": np.linalg.norm(log.p[TIP] - log.p[TIP][0], axis=1)},
        "distance [m]",
        spans=spans,
    )
    return [
        ("The plate is found by force; its height and tilt are not known.", force),
        (
            "After the turn only the force along the probe is left, till friction.",
            across,
        ),
        ("Turned towards the measured force, which at rest is the normal's.", lean),
        ("Down to the plate, then along it.", gone),
    ]
