"""What the runs gave, and what they are judged by, from the simulator's truth."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, final

import numpy as np

from sims.contact.crank import Turning, handle
from sims.contact.peg import DEPTH, Insertion, Search
from sims.contact.scene import AXIS, CRANK, HOLE, LEVER, TIP
from sims.log import Log
from sims.metrics import Metric
from wbc.arrays import Array

__all__ = ["Attempt", "Crank", "force_of", "metrics"]

FORCE: Final = 40.0
"""Largest force on the peg [N]."""
RADIAL: Final = 20.0
"""Largest force along the crank's lever [N]."""
SHORT: Final = 1e-3
"""By which a depth may fall short [m]."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Attempt:
    """One search for the hole, with the insertion if it came to that.

    Attributes:
        believed: (3,) where the hole was believed to be [m].
        search: the first phase.
        insertion: the second one; None if the peg never sank.
        logs: of the search, the insertion and the rest that follows, as far as it came.
    """

    believed: Array
    search: Search
    insertion: Insertion | None
    logs: tuple[Log, ...]

    @property
    def error(self) -> float:
        """Distance of the belief from the truth [m]."""
        return float(np.linalg.norm(self.believed - HOLE))

    @property
    def search_time(self) -> float:
        """From the start to where the peg began to sink [s]."""
        t = self.logs[0].t
        return float(t[-1] - t[0])

    @property
    def force(self) -> float:
        """Largest force between the peg and the block [N]."""
        return max(float(force_of(log).max()) for log in self.logs)

    @property
    def depth(self) -> float:
        """Of the peg's end in the hole when it was over [m]."""
        return float(HOLE[2] - self.logs[-1].p[TIP][-1, 2])

    @property
    def succeeded(self) -> bool:
        """Whether the peg is in, without too much force."""
        deep = self.insertion is not None and self.depth >= DEPTH - SHORT
        return deep and self.force <= FORCE


@final
@dataclass(frozen=True, eq=False)
class Crank:
    """A crank that was turned.

    Attributes:
        turning: the run's script, with what it learnt.
        log: of the run.
        angle: (T,) true angle of the crank [rad].
    """

    turning: Turning
    log: Log
    angle: Array

    @cached_property
    def forces(self) -> Array:
        """(T, 3) on the handle: along the lever, with the turn, along the axis [N]."""
        arm = np.array([handle(float(a)) for a in self.angle]) - CRANK
        out = arm / np.linalg.norm(arm, axis=1, keepdims=True)
        axis = np.broadcast_to(AXIS / np.linalg.norm(AXIS), out.shape)
        own = np.stack([out, np.cross(axis, out), axis], axis=1)
        forces: Array = np.einsum("tij,tj->ti", own, self.log.wrenches["wrist"][:, :3])
        return forces


def force_of(log: Log) -> Array:
    """Size (T,) of the force between tool and surroundings [N]."""
    return np.linalg.norm(log.wrenches["wrist"][:, :3], axis=1)


def metrics(attempts: list[Attempt], cranks: list[Crank]) -> list[Metric]:
    """The cell's own metrics: of either kind of job, if there was one."""
    logs = [log for a in attempts for log in a.logs] + [c.log for c in cranks]
    speed = max(float(np.abs(log.v / log.robot.v_max).max()) for log in logs)
    return [
        *(_of_pegs(attempts) if attempts else []),
        *(_of_cranks(cranks) if cranks else []),
        Metric("joint_speed_max_fraction", speed, 1.0),
    ]


def _of_pegs(attempts: list[Attempt]) -> list[Metric]:
    inserted = [a.logs[1] for a in attempts if len(a.logs) > 1]
    pressed = max((float(force_of(log).max()) for log in inserted), default=np.nan)
    return [
        Metric("peg_attempts", len(attempts), 1, ">="),
        Metric(
            "peg_success_fraction",
            float(np.mean([a.succeeded for a in attempts])),
            0.9,
            ">=",
        ),
        Metric("peg_force_max_n", max(a.force for a in attempts), FORCE),
        Metric("peg_insertion_force_max_n", pressed, FORCE),
        Metric("peg_belief_error_max_m", max(a.error for a in attempts)),
        Metric("peg_search_time_max_s", max(a.search_time for a in attempts)),
    ]


def _of_cranks(cranks: list[Crank]) -> list[Metric]:
    circles = [crank.turning.circle for crank in cranks]
    turns = min(float(c.angle[-1]) / (2.0 * np.pi) for c in cranks)
    radial = max(float(np.abs(c.forces[:, 0]).max()) for c in cranks)
    centre = max(float(np.linalg.norm(c.centre - CRANK[:2])) for c in circles)
    radius = max(abs(c.radius - LEVER) for c in circles)
    return [
        Metric("crank_turns", turns, 1.0, ">="),
        Metric("crank_radial_force_max_n", radial, RADIAL),
        Metric("crank_centre_error_m", centre),
        Metric("crank_radius_error_m", radius),
    ]
