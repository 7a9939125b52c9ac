"""The loop that every contender runs, and the checks that it passes.

Needs numpy and Pinocchio only, which every environment has.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import NamedTuple, Protocol

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from benchmarks.jobs import Job

__all__ = [
    "Contender",
    "Failed",
    "Instant",
    "Loop",
    "Target",
    "load_model",
    "twice_root",
]

Array = NDArray[np.float64]
Wrenches = Mapping[str, Array]

CHECK_EVERY = 10


class Failed(RuntimeError):
    """A contender has no torques for this tick."""


class Target(NamedTuple):
    """Where a tip should be: position, orientation, velocity, acceleration."""

    p: Array
    R: Array
    v: Array
    a: Array


class Instant(NamedTuple):
    """What a controller saw at a tick of a recorded run, and the torques that it sent.

    Time, positions, velocities, wrenches by sensor, torques.
    """

    t: float
    q: Array
    v: Array
    wrenches: Wrenches
    torque: Array


class Contender(Protocol):
    """Someone's controller, set up for a job."""

    def aim(self, t: float, targets: list[Target]) -> None:
        """Move the references; timed apart from the tick."""

    def tick(self, q: Array, v: Array, *felt: Wrenches) -> Array:
        """From (q, v) to the torques (n,): what is timed.

        In a replay of a recorded run, `felt` is what its sensors measured.
        """

    def acceleration(self) -> Array:
        """The joint accelerations (n,) that belong to the last torques."""


class Loop:
    """One job of one contender, run in pieces.

    The robot is an ideal integrator, or is wherever it was in a recorded run, whatever
    the contender does.

    Args:
        job: the job.
        contender: who does it.
        model: of the robot.
        recorded: the run to replay; () for the integrator.
    """

    def __init__(
        self,
        job: Job,
        contender: Contender,
        model: pin.Model,
        recorded: Sequence[Instant] = (),
    ) -> None:
        self.job, self.contender, self.recorded = job, contender, recorded
        self.model, self.data = model, model.createData()
        self.q = np.array(job.home) if job.home else pin.neutral(model)
        self.v = np.zeros(model.nv)
        self.limit = np.array(model.effortLimit) * job.torque_share
        self.done, self.failure = 0, ""
        self.torque_share = self.worst_dynamics = self.beyond = self.off = 0.0
        self.saturated = 0
        self._start = self._tips()

    def run(self, count: int) -> tuple[list[int], list[int]]:
        """The next ticks: time of each, and of moving its references [ns]."""
        ticks, aims = [], []
        clock = time.perf_counter_ns
        for _ in range(0 if self.failure else self._left(count)):
            t, felt = self._begin()
            targets = self.targets(t)
            start = clock()
            self.contender.aim(t, targets)
            aimed = clock()
            try:
                torque = self.contender.tick(self.q, self.v, *felt)
            except Failed as failure:
                self.failure = f"{failure} at tick {self.done}"
                break
            ticks.append(clock() - aimed)
            aims.append(aimed - start)
            self._step(torque, self.contender.acceleration())
        return ticks, aims

    def targets(self, t: float) -> list[Target]:
        """The references of all tips at a time."""
        w, swing = self.job.pace, self.job.swing
        y, z = np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])
        p = swing * ((1 - np.cos(w * t)) * z + (1 - np.cos(0.7 * w * t)) * y)
        v = swing * w * (np.sin(w * t) * z + 0.7 * np.sin(0.7 * w * t) * y)
        a = swing * w * w * (np.cos(w * t) * z + 0.49 * np.cos(0.7 * w * t) * y)
        return [Target(p0 + p, R0, v, a) for p0, R0 in self._start]

    def report(self) -> dict[str, object]:
        """How the job went."""
        error = 0.0
        for (p, _), target in zip(
            self._tips(), self.targets(self.done * self.job.dt), strict=True
        ):
            error = max(error, float(np.linalg.norm(p - target.p)))
        return {
            "ticks": self.done,
            "end_error_mm": 1e3 * error,
            "torque_share": self.torque_share,
            "saturated": self.saturated / max(self.done, 1),
            "dynamics_nm": self.worst_dynamics,
            "beyond_limits_rad": self.beyond,
            "off_record_nm": self.off,
            "failure": self.failure,
        }

    def _left(self, count: int) -> int:
        """So many ticks, or what is left of the recorded run."""
        return min(count, len(self.recorded) - self.done) if self.recorded else count

    def _begin(self) -> tuple[float, tuple[Wrenches, ...]]:
        """Time of the next tick, and what is felt there."""
        if not self.recorded:
            return self.done * self.job.dt, ()
        t, self.q, self.v, wrenches, _ = self.recorded[self.done]
        return t, (wrenches,)

    def _step(self, torque: Array, vdot: Array) -> None:
        """Check the torques, and go on to the next tick."""
        share = float(np.max(np.abs(torque) / self.limit))
        self.torque_share = max(self.torque_share, share)
        self.saturated += share > 1 - 1e-6
        if self.recorded:
            off = np.abs(torque - self.recorded[self.done].torque)
            self.off = max(self.off, float(off.max()))
        else:
            self._accelerate(torque, vdot)
        self.done += 1

    def _accelerate(self, torque: Array, vdot: Array) -> None:
        """Check the dynamics, then let the ideal robot accelerate as promised."""
        if self.done % CHECK_EVERY == 0:
            needed = pin.rnea(self.model, self.data, self.q, self.v, vdot)
            self.worst_dynamics = max(
                self.worst_dynamics, float(np.max(np.abs(needed - torque)))
            )
        self.v = self.v + self.job.dt * vdot
        self.q = self.q + self.job.dt * self.v
        above = np.max(self.q - self.model.upperPositionLimit)
        below = np.max(self.model.lowerPositionLimit - self.q)
        self.beyond = max(self.beyond, float(above), float(below))

    def _tips(self) -> list[tuple[Array, Array]]:
        pin.framesForwardKinematics(self.model, self.data, self.q)
        poses = [self.data.oMf[self.model.getFrameId(tip)] for tip in self.job.tips]
        return [(X.translation.copy(), X.rotation.copy()) for X in poses]


def load_model(job: Job) -> pin.Model:
    """The job's robot, as Pinocchio reads it."""
    return pin.buildModelFromUrdf(job.urdf)


def twice_root(stiffness: float) -> float:
    """Critical damping [1/s]."""
    return 2.0 * stiffness**0.5
