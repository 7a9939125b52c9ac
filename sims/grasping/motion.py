"""Smooth references in time: where the tcp should be, how fast, in which posture."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, final

import numpy as np
import pinocchio as pin

from wbc import Robot
from wbc.arrays import Array

__all__ = ["Phase", "Reference", "Straight", "Timeline", "Transfer"]

SPEED_SHARE = 0.3
"""Of the joints' speed limits that a transfer uses."""
LEAST = 0.8
"""Shortest duration of a transfer [s]."""
PEAK_SPEED, PEAK_ACCELERATION = 1.875, 10.0 / np.sqrt(3.0)
"""Of a quintic, over its mean speed and over that divided by its time."""
ALIGNED = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED


class Reference(NamedTuple):
    """A pose on the move.

    Attributes:
        p: (3,) [m].
        R: (3, 3)
        V: (6,) twist, [linear; angular], world axes.
        A: (6,) its derivative.
        q: (n,) a posture for what the pose leaves free.
    """

    p: Array
    R: Array
    V: Array
    A: Array
    q: Array


def quintic(u: float) -> tuple[float, float, float]:
    """Smooth step from 0 to 1 at u in [0, 1], with two derivatives by u."""
    u = min(max(u, 0.0), 1.0)
    return (
        u**3 * (10.0 - 15.0 * u + 6.0 * u**2),
        30.0 * u**2 * (1.0 - u) ** 2,
        60.0 * u * (1.0 - u) * (1.0 - 2.0 * u),
    )


class Motion(ABC):
    """A reference over `duration` seconds."""

    duration: float

    @abstractmethod
    def at(self, t: float) -> Reference:
        """The reference t seconds after the beginning; the ends go on forever."""


@final
class Transfer(Motion):
    """From posture to posture, straight in joint space; the pose follows from it.

    Args:
        robot: whose postures they are.
        frame: whose pose it is.
        start: (n,) [rad].
        end: (n,) [rad].
        push: share of the joints' acceleration limits that it uses.
    """

    def __init__(
        self, robot: Robot, frame: str, start: Array, end: Array, push: float = 0.5
    ) -> None:
        self._model, self._data = robot.model, robot.model.createData()
        self._frame, self._start, self._way = robot.frame_id(frame), start, end - start
        way = np.abs(self._way)
        speed = PEAK_SPEED * way / (SPEED_SHARE * robot.v_max)
        square = PEAK_ACCELERATION * way / (push * robot.a_max)
        self.duration = max(LEAST, float(speed.max()), float(np.sqrt(square.max())))

    def at(self, t: float) -> Reference:
        """The pose by forward kinematics."""
        s, ds, dds = quintic(t / self.duration)
        q = self._start + s * self._way
        v = ds / self.duration * self._way
        a = dds / self.duration**2 * self._way
        model, data, frame = self._model, self._data, self._frame
        pin.forwardKinematics(model, data, q, v, a)
        X = pin.updateFramePlacement(model, data, frame)
        V = pin.getFrameVelocity(model, data, frame, ALIGNED).vector
        A = pin.getFrameClassicalAcceleration(model, data, frame, ALIGNED).vector
        return Reference(np.array(X.translation), np.array(X.rotation), V, A, q)


@final
class Straight(Motion):
    """Along a line at a fixed orientation; a rest where the line has no length.

    Args:
        start: pose at the beginning.
        end: pose at the end, of the same orientation.
        postures: (2, n) that belong to them [rad].
        duration: [s].
    """

    def __init__(
        self, start: pin.SE3, end: pin.SE3, postures: Array, duration: float
    ) -> None:
        self._p, self._R = np.array(start.translation), np.array(start.rotation)
        self._way = np.array(end.translation) - self._p
        self._q, self._dq = postures[0], postures[1] - postures[0]
        self.duration = duration

    def at(self, t: float) -> Reference:
        """The pose on the line."""
        s, ds, dds = quintic(t / self.duration)
        V, A = np.zeros(6), np.zeros(6)
        V[:3] = ds / self.duration * self._way
        A[:3] = dds / self.duration**2 * self._way
        return Reference(self._p + s * self._way, self._R, V, A, self._q + s * self._dq)


@final
@dataclass(frozen=True, slots=True, eq=False)
class Phase:
    """A motion with the name of what it is for."""

    name: str
    motion: Motion


@final
class Timeline:
    """Phases one after another.

    Args:
        phases: at least one, of different names.
    """

    def __init__(self, phases: Sequence[Phase]) -> None:
        self.phases = tuple(phases)
        ends = np.cumsum([phase.motion.duration for phase in phases])
        self._ends = dict(zip((p.name for p in phases), ends.tolist(), strict=True))

    @property
    def duration(self) -> float:
        """Of all phases [s]."""
        return float(max(self._ends.values()))

    def ends(self, name: str) -> float:
        """When a phase ends [s]; infinite if there is none of that name."""
        return self._ends.get(name, np.inf)

    def phase(self, t: float) -> Phase:
        """The phase at time t [s]; the last one for ever."""
        for phase in self.phases:
            if t < self._ends[phase.name]:
                return phase
        return self.phases[-1]

    def at(self, t: float) -> Reference:
        """The reference at time t [s]."""
        phase = self.phase(t)
        begin = self._ends[phase.name] - phase.motion.duration
        return phase.motion.at(t - begin)

    def after(self, name: str, phases: Sequence[Phase]) -> Timeline:
        """The same up to the end of a phase, then others instead."""
        names = [phase.name for phase in self.phases]
        return Timeline([*self.phases[: names.index(name) + 1], *phases])
