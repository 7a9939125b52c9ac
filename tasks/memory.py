"""What tasks on forces remember from tick to tick.

It lies apart from the task, whose own attributes are settled: setting one costs a
question whether it may be set, which is too much at every tick.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from wbc.arrays import Array

__all__ = ["Felt", "Pushed", "Reference"]


@final
@dataclass(slots=True, eq=False)
class Felt:
    """Of a task that presses; m force rows.

    Attributes:
        J: (m, n) Jacobian of the force rows.
        wrench: (6,) about the frame's origin, of the robot on its surroundings, world.
        measured: (m,) the wrench's part in the force rows.
        held: (m,) integral term of the force law.
        rate: (m,) at which that grows.
        p: (3,) the frame's origin.
    """

    J: Array
    wrench: Array
    measured: Array
    held: Array
    rate: Array
    p: Array


@final
@dataclass(slots=True, eq=False)
class Pushed:
    """Of a task that gives way by torque.

    Attributes:
        J: (6, n) Jacobian of the frame.
        wrench: (6,) as in `Felt`.
    """

    J: Array
    wrench: Array


@final
@dataclass(slots=True, eq=False)
class Reference:
    """Of a task that gives way by moving; None before its first tick.

    Attributes:
        x: (3,) where the reference is [m].
        v: (3,) its velocity [m/s].
        acceleration: (3,) what it wants in the task's axes [m/s^2].
    """

    x: Array
    v: Array
    acceleration: Array
