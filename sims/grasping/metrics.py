"""What the grasps are judged by, from the simulator's truth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from sims.constraints.soundness import soundness_along
from sims.grasping.cylinder import Cylinder
from sims.grasping.gripper import Grip
from sims.grasping.job import Job
from sims.grasping.plan import TCP
from sims.grasping.scene import GOAL
from sims.grasping.touch import Touch
from sims.log import Log
from sims.metrics import Metric
from wbc import Resolver
from wbc.arrays import Array

__all__ = ["OBJECT", "Result", "metrics", "misfit", "slip"]

OBJECT: Final = "object"
"""Site of the cylinder's frame."""
SLIP: Final = 1e-3
LIFTED: Final = 0.095
PLACED: Final = 3e-3
UPRIGHT: Final = 0.02
"""Bounds of a success: [m], [m], [m], [rad]."""
SHAKE: Final = 0.01
"""Of joint velocities in the test of soundness [rad/s]."""
SOUND: Final = 1e-9
"""Relative change of higher levels by lower ones."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Result:
    """A job that has been run, with its log and what the fingers exerted."""

    job: Job
    log: Log
    touch: Touch

    def span(self, first: str, last: str) -> slice:
        """Ticks from the end of one phase to the end of another."""
        ends = (self.job.timeline.ends(name) for name in (first, last))
        begin, end = (int(np.searchsorted(self.log.t, t)) for t in ends)
        return slice(begin, end)

    @property
    def complete(self) -> bool:
        """Whether the run came to the end of the job, with something in the grip."""
        rest = self.job.timeline.ends("retreat")
        return bool(self.job.grip is Grip.HOLDING and self.log.t[-1] >= rest)


def metrics(results: list[Result], resolver: Resolver) -> list[Metric]:
    """The cell's own metrics, over all cases that the resolver ran."""
    judged = [_judge(result) for result in results]
    worst = {
        name: float(np.max([values[name] for values in judged])) for name in judged[0]
    }
    speed = max(float(np.abs(r.log.v / r.log.robot.v_max).max()) for r in results)
    disturbed = max(_disturbed(result, resolver) for result in results)
    success = float(np.mean([_succeeded(values) for values in judged]))
    return [
        Metric("grasp_objects", len(results), 1, ">="),
        Metric("grasp_success_fraction", success, 1.0, "=="),
        Metric("grasp_constraint_error_max_m", worst["error"], 5e-4),
        Metric("grasp_constraint_angle_max_rad", worst["angle"], 5e-3),
        Metric("grasp_slip_max_m", worst["slip"], SLIP),
        Metric("grasp_lift_min_m", 0.1 - worst["sunk"], LIFTED, ">="),
        Metric("grasp_place_error_max_m", worst["place"], PLACED),
        Metric("grasp_place_tilt_max_rad", worst["tilt"], UPRIGHT),
        Metric("grasp_joint_speed_max_fraction", speed, 1.0),
        Metric("soundness_relative", disturbed, SOUND),
    ]


def _judge(result: Result) -> dict[str, float]:
    """Figures of one case; NaN where the run did not get so far."""
    if not result.complete:
        names = ("error", "angle", "slip", "sunk", "place", "tilt")
        return dict.fromkeys(names, np.nan)
    log, cylinder = result.log, result.job.cylinder
    lengths, angles = misfit(cylinder, log, result.span("approach", "close"))
    lift = result.span("close", "lift")
    rise = log.p[OBJECT][lift.stop - 1, 2] - log.p[OBJECT][lift.start, 2]
    upright = np.clip(log.R[OBJECT][-1, 2, 2], -1.0, 1.0)
    return {
        "error": float(np.abs(lengths).max()),
        "angle": float(angles.max()),
        "slip": float(slip(log, result.span("close", "settle")).max()),
        "sunk": float(0.1 - rise),
        "place": float(np.linalg.norm(log.p[OBJECT][-1] - GOAL)),
        "tilt": float(np.arccos(upright)),
    }


def _disturbed(result: Result, resolver: Resolver) -> float:
    """By how much the posture disturbs the grasp; the rim leaves it one freedom."""
    job, log = result.job, result.log
    return soundness_along(
        log,
        log.robot,
        job.rim.hierarchy,
        resolver,
        shake=SHAKE,
        script=lambda t: job.rim.follow(job.timeline.at(t)),
    )


def _succeeded(values: dict[str, float]) -> bool:
    return (
        values["slip"] <= SLIP
        and 0.1 - values["sunk"] >= LIFTED
        and values["place"] <= PLACED
        and values["tilt"] <= UPRIGHT
    )


def misfit(cylinder: Cylinder, log: Log, span: slice) -> tuple[Array, Array]:
    """By how much P4's grasp constraints are missed, tick by tick.

    The cylinder counts as where it was when the span began, before the fingers
    touched it.

    Returns:
        (T, 3) the axis beside the gripper's plane, the tcp's distance from the axis
        less the radius, the tcp above the top [m]; and (T,) the larger one of the angle
        between approach and axis and that of the closing direction from square [rad].
    """
    p, R = log.p[OBJECT][span.start], log.R[OBJECT][span.start]
    axis = R[:, 2]
    tcp, R_T = log.p[TCP][span], log.R[TCP][span]
    beside = np.einsum("ti,ti->t", p - tcp, R_T[:, :, 1])
    local = (tcp - p) @ R
    radial = np.hypot(local[:, 0], local[:, 1]) - cylinder.rim
    lengths = np.column_stack([beside, radial, local[:, 2] - cylinder.height])
    across = np.linalg.norm(np.cross(R_T[:, :, 2], axis), axis=1)
    square = np.abs(R_T[:, :, 0] @ axis)
    return lengths, np.arcsin(np.clip(np.maximum(across, square), 0.0, 1.0))


def slip(log: Log, span: slice) -> Array:
    """How far (T,) the grasped point of the cylinder has moved in the gripper [m]."""
    R_T = log.R[TCP][span]
    R = np.einsum("tji,tjk->tik", R_T, log.R[OBJECT][span])
    p = np.einsum("tji,tj->ti", R_T, log.p[OBJECT][span] - log.p[TCP][span])
    grasped = -R[0].T @ p[0]
    return np.linalg.norm(p + R @ grasped, axis=1)
