"""What all constraints between two geometric features share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike

from tasks.base import CatalogueTask
from tasks.evaluator import Code
from tasks.geometry.features import Carrier, Point, perpendicular
from tasks.geometry.moving import MovingFrame
from wbc import PD, Kernel, Robot, Rows, State
from wbc.arrays import Array, frozen
from wbc.checks import known
from wbc.errors import InputError
from wbc.kernel import WORLD

__all__ = [
    "Constraint",
    "Sense",
    "angle_between",
    "as_point",
    "parallel",
    "relation",
]

Sense: TypeAlias = Literal["same", "opposite", "nearest"]
"""Of two parallel directions; "nearest" takes at each tick what is less than a right
angle away."""
SENSES = {"same": 1.0, "opposite": -1.0, "nearest": 0.0}
Direction: TypeAlias = tuple[float, float, float, Array, Array]
"""Kind (1 parallel, 2 angle), sense, angle, triad of the first axis, second axis."""


class Constraint(CatalogueTask):
    """A relation between a feature and another one, at least one on the robot.

    Both may be on frames of the same robot (two arms in one model): the Jacobian is
    then the difference of the two. What moves by itself enters rate and drift.

    Attributes:
        ROWS: name and unit of every row, of every object of the class.
        rows: their names.
        units: their units.
        rank: how many of them are independent, away from singular places: all.
    """

    code = Code.CONSTRAINT
    ROWS: ClassVar[tuple[tuple[str, str], ...]]

    def __init__(
        self,
        first: Carrier,
        second: Carrier,
        relation: Array,
        name: str,
        stiffness: ArrayLike,
        damping: ArrayLike | None,
    ) -> None:
        rows, units = zip(*self.ROWS, strict=True)
        unit = units[0] if len(set(units)) == 1 else ", ".join(units)
        frames = _frames(first, second, name)
        super().__init__(name, unit, rows, PD(stiffness, damping), frames)
        self._carrier = next((c for c in (first, second) if _moves(c)), None)
        if isinstance(self._carrier, MovingFrame):
            self.moving = self._carrier.block
            relation[33] = 1.0
        self._parameters = relation

    @property
    def units(self) -> tuple[str, ...]:
        """Unit of every row's error."""
        return tuple(unit for _, unit in self.ROWS)

    @property
    def rank(self) -> int:
        """How many of the rows are independent, away from singular places."""
        return len(self.ROWS)

    def parameters(self, robot: Robot) -> Array:
        """Those of `tasks.kernels.constraints.constraint`."""
        del robot
        return self._parameters

    def kernel(self, robot: Robot) -> Kernel | None:
        """The compiled half; None where a function of time moves a feature."""
        carrier = self._carrier
        if isinstance(carrier, MovingFrame) and carrier.motion is not None:
            return None
        return super().kernel(robot)

    def evaluate(self, state: State, out: Rows) -> None:
        """Write the rows."""
        if isinstance(self._carrier, MovingFrame):
            self._carrier.follow(state.t)
        super().evaluate(state, out)


def relation(
    *,
    point: ArrayLike = (0.0, 0.0, 0.0),
    origin: ArrayLike = (0.0, 0.0, 0.0),
    along: Sequence[Array] = (),
    apart: Sequence[Array] = (),
    distance: float = 0.0,
    direction: Direction | None = None,
) -> Array:
    """Parameters of the kernel, (34,), as `tasks.kernels.constraints` lists them.

    Args:
        point: (3,) of the first feature, in its carrier's axes [m].
        origin: (3,) of the second feature, in its carrier's axes [m].
        along: unit vectors in the second's axes, one row each.
        apart: vectors in whose space one row measures a length.
        distance: what that row subtracts [m].
        direction: two rows that make axes parallel, or one of an angle.
    """
    p = np.zeros(34)
    p[0], p[1], p[4] = len(along), len(apart), distance
    p[6:9], p[9:12] = point, origin
    vectors = [*along, *apart]
    if vectors:
        p[12 : 12 + 3 * len(vectors)] = np.concatenate(vectors)
    if direction is not None:
        p[2], p[3], p[5], p[21:30], p[30:33] = direction
    return p


def parallel(a: Array, n: Array, sense: str) -> Direction:
    """Two rows that turn the axis a of the first carrier to n of the second.

    Raises:
        UnknownName: no such sense.
    """
    return 1.0, SENSES[known("sense", sense, get_args(Sense))], 0.0, _triad(a), n


def angle_between(a: Array, n: Array, angle: float) -> Direction:
    """One row for the angle [rad] between axes a and n."""
    return 2.0, 1.0, angle, _triad(a), n


def as_point(point: str | Point | ArrayLike, what: str = "the point") -> Point:
    """A point as it is, the origin of a frame, or a point of the world.

    Raises:
        InputError: not a point.
    """
    if isinstance(point, Point):
        return point
    if isinstance(point, str):
        return Point(on=point)
    return Point(frozen(point, (3,), what))


def _triad(a: Array) -> Array:
    return np.concatenate([a, perpendicular(a).ravel()])


def _moves(carrier: Carrier) -> bool:
    return isinstance(carrier, MovingFrame)


def _frames(first: Carrier, second: Carrier, name: str) -> tuple[str, ...]:
    """Names of the robot's frames that are read; the world's where it takes two."""
    if not isinstance(first, str) and not isinstance(second, str):
        raise InputError(
            f"'{name}' relates two features of which no joint moves any: give one of "
            "them a frame of the robot, on='<frame>'."
        )
    if first == second:
        raise InputError(
            f"'{name}' relates two features of the same frame '{first}': no joint "
            "moves one against the other."
        )
    if second is None and isinstance(first, str):
        return (first,)
    return tuple(c if isinstance(c, str) else WORLD for c in (first, second))
