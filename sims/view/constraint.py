"""What a geometric constraint wants, read from the numbers that its rows come from."""

from __future__ import annotations

from typing import NamedTuple, final

import numpy as np

from sims.view.marks import TARGET, Mark, ball, faint
from sims.view.sketches import (
    angle_of,
    long_line,
    missed,
    pointing,
    ring,
    sheet,
    tube,
)
from tasks.geometry import Constraint
from wbc import State
from wbc.arrays import Array
from wbc.kernel import WORLD
from wbc.relative import MOVING_SIZE, moved

__all__ = ["constraint_marks"]

ON_AXIS = 1e-9
"""Distance below which any direction away from an axis is as good [m]."""


@final
class Relation:
    """The parameters of `tasks.kernels.constraints.constraint`, by name.

    Attributes:
        along, apart: vectors along which a distance is to vanish, or together to have a
            given length; unit vectors (k, 3) in the second feature's carrier.
        distance: that length [m].
        a, b: (3,) the features' points, each in its carrier's axes [m].
        kind: 0 no directions, 1 parallel ones, 2 at an angle.
        sense: 1 same, -1 opposite, 0 the nearer one.
        angle: between the directions [rad].
        first, second: (3,) the directions, each in its carrier's axes.
    """

    def __init__(self, p: Array) -> None:
        n, m = int(p[0]), int(p[1])
        vectors = p[12 : 12 + 3 * (n + m)].reshape(-1, 3)
        self.along, self.apart, self.distance = vectors[:n], vectors[n:], float(p[4])
        self.a, self.b = p[6:9], p[9:12]
        self.kind, self.sense, self.angle = int(p[2]), float(p[3]), float(p[5])
        self.first, self.second = p[21:24], p[30:33]


class Pose(NamedTuple):
    """Of a carrier: origin p (3,) and axes R (3, 3) in the world."""

    p: Array
    R: Array


def constraint_marks(task: Constraint, state: State) -> list[Mark]:
    """The second feature, the first one's point, and what is between them."""
    relation = Relation(task.parameters(state.robot))
    first = _carrier(task, task.frames[0], state)
    second = _carrier(task, next(iter(task.frames[1:]), WORLD), state)
    marks = _position(relation, first, second)
    if relation.kind:
        on_robot = task.frames[0] != WORLD
        marks += _direction(relation, first, second, on_robot)
    return marks


def _carrier(task: Constraint, name: str, state: State) -> Pose:
    if name != WORLD:
        F = state.frame(name)
        return Pose(F.p, F.R)
    if task.moving is None:
        return Pose(np.zeros(3), np.eye(3))
    flat = np.zeros(MOVING_SIZE)
    moved(task.moving, state.t, flat)
    return Pose(flat[:3], flat[3:12].reshape(3, 3))


def _position(r: Relation, F: Pose, G: Pose) -> list[Mark]:
    """The feature near the point, and the way from the point to it."""
    if not (len(r.along) or len(r.apart)):
        return []
    actual = F.p + F.R @ r.a
    x = G.R.T @ (actual - G.p) - r.b
    across = r.apart.T @ (r.apart @ x)
    size = float(np.linalg.norm(across))
    wish = -r.along.T @ (r.along @ x)
    if len(r.apart):
        out = across / size if size > ON_AXIS else r.apart[0]
        wish = wish + (r.distance - size) * out
    on_axis = G.p + G.R @ (r.b + x - across)
    wanted = actual + G.R @ wish
    return [*_feature(r, G, wanted, on_axis), *missed(actual, wanted)]


def _feature(r: Relation, G: Pose, near: Array, on_axis: Array) -> list[Mark]:
    """What the rows describe: point, line, plane; sphere, circle, cylinder."""
    along, apart = r.along @ G.R.T, r.apart @ G.R.T
    b = G.p + G.R @ r.b
    if len(apart) == 3:
        return [ball(b, faint(TARGET), r.distance), ball(b, TARGET)]
    if len(apart) == 2 and len(along) == 1:
        return ring(b, along[0], r.distance)
    if len(apart) == 2:
        return [tube(on_axis, np.cross(*apart), r.distance)]
    if len(along) == 3:
        return [ball(b, TARGET)]
    if len(along) == 2:
        return [long_line(near, np.cross(*along))]
    return [sheet(near, along[0])]


def _direction(r: Relation, F: Pose, G: Pose, on_robot: bool) -> list[Mark]:
    """Both directions at the place of the robot's own feature."""
    a, n = F.R @ r.first, G.R @ r.second
    turned = angle_of(a, n)
    if r.kind == 1:
        opposite = r.sense < 0.0 or (r.sense == 0.0 and a @ n < 0.0)
        error = np.pi - turned if opposite else turned
        flip = -1.0 if opposite else 1.0
    else:
        error, flip = turned - r.angle, 1.0
    if on_robot:
        return pointing(F.p + F.R @ r.a, a, flip * n, error)
    return pointing(G.p + G.R @ r.b, n, flip * a, error)
