"""What every contender of the tick benchmark is asked to do: one job, one file."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import Any

__all__ = ["Job"]


@dataclass(frozen=True)
class Job:
    """A robot, its gains and the motion of its tips.

    Every tip swings along y and z, starting at rest from where it is at home, with
    its orientation kept; the posture is home.

    Attributes:
        name: what the table calls it.
        urdf: file of the model; empty for a stack of one of our cells.
        tips: frames that follow a pose.
        home: (n,) start and posture [rad].
        acceleration: (n,) acceleration limits [rad/s^2].
        split: five strict levels (torques, joints, position, orientation, posture)
            instead of three (both limits, pose, posture); with `planes`, a level each.
        planes: instead of poses, so many tasks of one row: a link's height kept.
        torque_share: share of the torque limits that may be used.
        pace: of the swing [rad/s].
        swing: half of its height [m].
        stiffness: of pose and posture [1/s^2]; damping is critical.
        weights: of pose and posture, for those who have no levels.
        dt: control period [s].
        cell: name of a cell's stack (`benchmarks.stacks`).
        recorded: with a cell, so many ticks of a run of it are replayed; 0 for its
            stack on an ideal robot.
    """

    name: str
    urdf: str = ""
    tips: tuple[str, ...] = ()
    home: tuple[float, ...] = ()
    acceleration: tuple[float, ...] = ()
    split: bool = False
    planes: int = 0
    torque_share: float = 1.0
    pace: float = 3.0
    swing: float = 0.06
    stiffness: tuple[float, float] = (400.0, 25.0)
    weights: tuple[float, float] = (1.0, 1e-3)
    dt: float = 1e-3
    cell: str = ""
    recorded: int = 0

    def to_json(self) -> str:
        """The job as a line of text."""
        return json.dumps(asdict(self))

    @classmethod
    def from_dict(cls, fields: dict[str, Any]) -> Job:
        """The job from what `to_json` wrote; lists become tuples."""
        values: dict[str, Any] = {
            key: tuple(value) if isinstance(value, list) else value
            for key, value in fields.items()
        }
        return cls(**values)
