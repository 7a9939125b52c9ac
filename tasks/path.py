"""Paths in space: position along them, and their frame."""

from __future__ import annotations

from abc import ABC
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.kernels.nearest import locate, write_point
from wbc.arrays import Array, frozen, number
from wbc.errors import InputError, shown

__all__ = ["Path", "PathPoint", "still"]


@final
class PathPoint:
    """A point of a path with its frame, and their derivatives by s.

    Row i of each property is the i-th derivative, i = 0..3.

    Args:
        rows: (4, 9), columns [point, normal 1, normal 2].

    Attributes:
        c: (4, 3) the point.
        n1: (4, 3) the first normal.
        n2: (4, 3) the second.
    """

    __slots__ = ("c", "n1", "n2", "rows")

    def __init__(self, rows: Array) -> None:
        self.rows = rows
        self.c, self.n1, self.n2 = rows[:, :3], rows[:, 3:6], rows[:, 6:]


class Path(ABC):
    """A curve with parameter s [m], its arc length, and two normals along it.

    Attributes:
        length: s runs from 0 to here [m]; infinite for an unbounded line.
        table: what the kernels of `tasks.kernels.nearest` read of it.
        on: what carries it, None for the world.
    """

    length: float
    table: Array
    on: object = None

    def locate(self, p: ArrayLike) -> float:
        """Position s [m] of the path's point nearest to p (3,)."""
        return locate(self.table, frozen(p, (3,), "p"), np.zeros((4, 9)))

    def at(self, s: float) -> PathPoint:
        """Point and frame at s; beyond the ends the path goes on straight.

        Raises:
            InputError: s is not a finite number.
        """
        rows = np.zeros((4, 9))
        write_point(self.table, number(s, "s"), rows)
        return PathPoint(rows)


def still(path: Path, task: str) -> Path:
    """The path, which a task follows in the world.

    Raises:
        InputError: it is no path, or something carries it.
    """
    if not isinstance(path, Path):
        raise InputError(
            f"'{task}' follows a path, such as a Line or a Curve, not {shown(path)}."
        )
    if path.on is not None:
        raise InputError(
            f"'{task}' follows a path in the world, but {path.on!r} carries this one."
        )
    return path
