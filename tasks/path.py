"""Paths in space: position along them, their frame, how both move with a robot."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import final

from wbc import FrameState, State
from wbc.arrays import Array

__all__ = ["Path", "PathPoint", "PathState"]


@final
class PathPoint:
    """A point of a path with its frame, and their derivatives by s.

    Row i of each property is the i-th derivative, i = 0..3.

    Args:
        rows: (4, 9), columns [point, normal 1, normal 2].
    """

    __slots__ = ("c", "n1", "n2")

    def __init__(self, rows: Array) -> None:
        self.c, self.n1, self.n2 = rows[:, :3], rows[:, 3:6], rows[:, 6:]


class Path(ABC):
    """A curve with parameter s [m], its arc length, and two normals along it.

    Attributes:
        length: s runs from 0 to here [m]; infinite for an unbounded line.
    """

    length: float

    @abstractmethod
    def locate(self, p: Array) -> float:
        """Position s [m] of the path's point nearest to p (3,)."""

    @abstractmethod
    def at(self, s: float) -> PathPoint:
        """Point and frame at s; beyond the ends the path goes on straight."""

    def follow(self, state: State, frame: str) -> PathState:
        """Where a frame's origin is along the path, and how that changes.

        Several tasks on one path share the answer within a tick.
        """
        return state.remember((self, frame), lambda: self._follow(state.frame(frame)))

    def _follow(self, F: FrameState) -> PathState:
        s = self.locate(F.p)
        point = self.at(s)
        c, tangent, bend, twist = point.c
        velocity = F.V[:3]
        offset = F.p - c
        stretch = float(tangent @ tangent - offset @ bend)
        rate = float(tangent @ velocity) / stretch
        change = float(
            2.0 * (tangent @ bend) * rate
            - (velocity - tangent * rate) @ bend
            - (offset @ twist) * rate
        )
        drift = tangent @ F.drift[:3] + (bend @ velocity) * rate - change * rate
        J = (tangent @ F.J[:3]) / stretch
        return PathState(s, rate, J, float(drift) / stretch, point)


@final
@dataclass(frozen=True, slots=True, eq=False)
class PathState:
    """Motion of the nearest point of a path below a frame of the robot.

    From c'(s) . (p - c(s)) = 0, differentiated twice.

    Attributes:
        s: position along the path [m].
        rate: ds/dt = J v [m/s].
        J: (n,) Jacobian of s.
        drift: d2s/dt2 at zero joint acceleration [m/s^2].
        point: the path there.
    """

    s: float
    rate: float
    J: Array
    drift: float
    point: PathPoint
