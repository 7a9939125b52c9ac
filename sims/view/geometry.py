"""What a task constrains, as something that can be drawn: one function by its type."""

from __future__ import annotations

from functools import lru_cache, singledispatch
from typing import Final

import numpy as np

from sims.view.constraint import constraint_marks
from sims.view.forces import pulled, pushed
from sims.view.marks import ACTUAL, TARGET, THIN, Mark, arrow, ball, faint, line
from sims.view.sketches import angle_of, chain, missed, pointing, triad
from tasks import (
    Admittance,
    AxisAlignment,
    AxisAlongPath,
    Clearance,
    FrameOrientation,
    FramePose,
    FramePosition,
    HybridForceMotion,
    Impedance,
    KnifePose,
    Path,
    PointOnCurve,
    TravelSpeed,
)
from tasks.geometry import Constraint
from wbc import State, Task
from wbc.arrays import Array
from wbc.kernel import WORLD

__all__ = ["geometry_of"]

SAMPLES: Final = 60
"""Of a curve."""
ENDLESS: Final = 0.5
"""What is shown of a path without an end [m]."""
SECOND: Final = 1.0
"""A speed is shown as the way that it makes in this time [s]."""


@singledispatch
def geometry_of(task: Task, state: State) -> list[Mark]:
    """What a task wants, blue, and how far the robot is from it, green to red.

    Tasks in joint space have no geometry and give nothing. A task of a kind that is
    not known here shows the frames that it reads; `geometry_of.register` teaches it.

    Args:
        task: any.
        state: of its robot.
    """
    frames = (name for name in task.frames if name != WORLD)
    return [ball(state.frame(name).p, ACTUAL) for name in frames]


@geometry_of.register
def _(task: FramePosition, state: State) -> list[Mark]:
    wanted = task.parameters(state.robot)[:3]
    return [ball(wanted, TARGET), *missed(state.frame(task.frames[0]).p, wanted)]


@geometry_of.register
def _(task: FrameOrientation, state: State) -> list[Mark]:
    F, R = state.frame(task.frames[0]), task.parameters(state.robot)[:9]
    return [*triad(F.p, R.reshape(3, 3)), *triad(F.p, F.R, 0.4)]


@geometry_of.register(FramePose)
@geometry_of.register(KnifePose)
def _(task: FramePose | KnifePose, state: State) -> list[Mark]:
    F, p = state.frame(task.frames[0]), task.parameters(state.robot)
    wanted, R = p[:3], p[9:18].reshape(3, 3)
    return [*triad(wanted, R), *triad(F.p, F.R, 0.4), *missed(F.p, wanted)]


@geometry_of.register
def _(task: Constraint, state: State) -> list[Mark]:
    return constraint_marks(task, state)


@geometry_of.register
def _(task: PointOnCurve, state: State) -> list[Mark]:
    p = state.frame(task.frames[0]).p
    wanted = task.curve.at(task.curve.locate(p)).c[0]
    return [*_way(task.curve), *missed(p, wanted)]


@geometry_of.register
def _(task: TravelSpeed, state: State) -> list[Mark]:
    F = state.frame(task.frames[0])
    c = task.path.at(task.path.locate(F.p)).c
    travelled = SECOND * float(c[1] @ F.V[:3]) * c[1]
    return [*_way(task.path), arrow(c[0], c[0] + travelled, TARGET, radius=THIN)]


@geometry_of.register
def _(task: AxisAlignment, state: State) -> list[Mark]:
    p = task.parameters(state.robot)
    return _aimed(task, state, p[:3], p[9:12])


@geometry_of.register
def _(task: AxisAlongPath, state: State) -> list[Mark]:
    p, path = task.parameters(state.robot), task.path
    s = path.locate(state.frame(task.frames[0]).p)
    return _aimed(task, state, p[:3], task.direction_at(path.at(s))[0])


@geometry_of.register
def _(task: Clearance, state: State) -> list[Mark]:
    a, b = (state.frame(name).p for name in task.frames)
    near = float(np.linalg.norm(a - b)) < task.distance
    room = faint(TARGET, 0.5 if near else 0.15)
    spheres = [ball(p, room, 0.5 * task.distance) for p in (a, b)]
    return [*spheres, line(a, b, TARGET, THIN)]


@geometry_of.register
def _(task: HybridForceMotion, state: State) -> list[Mark]:
    F = state.frame(task.frame)
    p = F.p
    wanted = p + task.Omega_m[:3, :3] @ (task.target - p)
    force = task.Omega_f[:3, :3] @ (task.axes @ task.force[:3])
    push = pushed(p, force, TARGET, THIN)
    marks = [ball(wanted, TARGET), *missed(p, wanted), *push]
    if task.size == 6:
        marks += [*triad(p, task.orientation), *triad(p, F.R, 0.4)]
    return marks


@geometry_of.register(Impedance)
@geometry_of.register(Admittance)
def _(task: Impedance | Admittance, state: State) -> list[Mark]:
    p = state.frame(task.frame).p
    spring = line(p, task.target, TARGET, THIN)
    pull = pulled(p, task.axes @ task.force, TARGET, THIN)
    return [ball(task.target, TARGET), spring, ball(p, ACTUAL), *pull]


def _aimed(task: Task, state: State, axis: Array, wanted: Array) -> list[Mark]:
    """An axis (3,) of a frame, and the direction (3,) that it should have."""
    F = state.frame(task.frames[0])
    actual = F.R @ axis
    return pointing(F.p, actual, wanted, angle_of(actual, wanted))


@lru_cache(maxsize=16)
def _way(path: Path) -> list[Mark]:
    """The whole of a path; a straight one in one piece."""
    length = path.length if np.isfinite(path.length) else ENDLESS
    s = np.linspace(0.0, length, SAMPLES)
    points = np.array([path.at(x).c[0] for x in s])
    straight = np.allclose(np.diff(points, 2, axis=0), 0.0, atol=1e-9)
    return chain(points[[0, -1]] if straight else points, TARGET)
