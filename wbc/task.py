"""Tasks: named quantities of a robot, and what should become of them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

from wbc.arrays import Array
from wbc.binding import announce
from wbc.checks import expect, names, text
from wbc.errors import InputError, shown
from wbc.kernel import Kernel
from wbc.law import Law
from wbc.rows import Rows, Space

if TYPE_CHECKING:
    from wbc.hierarchy import Hierarchy, Level
    from wbc.robot import Robot
    from wbc.state import State

__all__ = ["MotionTask", "Task"]


class Task(ABC):
    """A named quantity: says what, never how important.

    Tasks combine: `a + b` share a level, `a >> b` ranks a strictly above b, and
    `0.1 * a` scales a's residual within its level.

    Args:
        name: how reports call it.
        unit: of each row's error, such as "m".
        frames: names of the robot's frames that it reads.

    Raises:
        InputError: one of these is not a string.
    """

    space: Space = "acceleration"
    claims: tuple[str, ...] = ()
    """Measured forces that `advance` puts into the torques; no two tasks may share."""
    __array_ufunc__ = None  # numpy leaves products with arrays to `__rmul__`

    def __init__(self, name: str, unit: str, frames: tuple[str, ...] = ()) -> None:
        kind = type(self).__name__
        self.name = text(name, f"name of a {kind}")
        expect(str, **{f"unit of {kind} '{name}'": unit})
        self.unit = unit
        expect(tuple | list, frames=frames)
        self.frames = tuple(text(frame, f"frame of a {kind}") for frame in frames)

    @abstractmethod
    def row_names(self, robot: Robot) -> tuple[str, ...]:
        """One name a row; their number is the task's size m."""

    @abstractmethod
    def update(self, state: State, rows: Rows) -> None:
        """Write A, lower and upper at this state, in place."""

    def advance(self, state: State, torque: Array) -> None:
        """Once a tick, after `update`: move on what the task remembers.

        A task that counts on a contact force f, of the robot on its surroundings, adds
        J^T f to `torque` (n,) [Nm], which is zero at first: tau = M vdot + h + torque.
        """
        del state, torque

    def check(self, robot: Robot) -> None:
        """See that the task fits the robot; called once, by whoever binds them.

        Raises:
            UnknownName: a frame or joint that the robot does not have.
            InputError: a target or gain of the wrong size.
        """
        for frame in self.frames:
            robot.frame_id(frame)

    def row_units(self, rows: int) -> tuple[str, ...]:
        """Unit of the error of each of so many rows.

        A `unit` of several parts, "m, rad", is shared out in equal blocks.
        """
        parts = [part.strip() for part in self.unit.split(",")]
        if rows % len(parts):
            return (self.unit,) * rows
        return tuple(part for part in parts for _ in range(rows // len(parts)))

    def wish_units(self, rows: int) -> tuple[str, ...]:
        """Unit of the bounds of each row: torques as they are, errors per s^2."""
        units = self.row_units(rows)
        if self.space == "torque":
            return units
        return tuple(
            ", ".join(_per_second_squared(part.strip()) for part in unit.split(","))
            for unit in units
        )

    def kernel(self, robot: Robot) -> Kernel | None:
        """The task's compiled half for this robot; None for plain Python."""
        del robot
        return None

    def __add__(self, other: Task | Level) -> Level:
        from wbc.hierarchy import Level

        return Level.of(self) + other

    def __rmul__(self, weight: float) -> Level:
        from wbc.hierarchy import Level

        return weight * Level.of(self)

    __mul__ = __rmul__

    def __rshift__(self, other: Task | Level | Hierarchy) -> Hierarchy:
        from wbc.hierarchy import Hierarchy

        return Hierarchy.of(self) >> other

    def __repr__(self) -> str:
        return f"{type(self).__name__}('{self.name}')"


class MotionTask(Task):
    """An equality task: drives an error e(q, t) to zero by a law.

    A subclass writes `error`, `J` and `drift` of its rows so that

        de/dt = J v + partial,        d2e/dt2 = J vdot + drift,

    where `partial` is what changes by time alone (`rate` on entry to `evaluate` is
    zero; write the partial there), and `drift` holds all that is not J vdot. The
    base class asks for J vdot = law(e, de/dt) - drift. For orientations de/dt is the
    angular velocity of the error, not the derivative of its coordinates.

    Args:
        name: how reports call it.
        unit: of each row's error.
        rows: one name a row.
        law: from error and rate to acceleration.
        frames: names of the robot's frames that it reads.
    """

    def __init__(
        self,
        name: str,
        unit: str,
        rows: tuple[str, ...],
        law: Law,
        frames: tuple[str, ...] = (),
    ) -> None:
        super().__init__(name, unit, frames)
        self.rows = names(rows, f"rows of {type(self).__name__} '{self.name}'")
        self.law = law

    @property
    def law(self) -> Law:
        """From error and rate to acceleration; may be replaced, also in use.

        Raises:
            InputError: when set, no law, or one of the wrong number of gains.
        """
        return self._law

    @law.setter
    def law(self, law: Law) -> None:
        if not isinstance(law, Law):
            raise InputError(f"law of '{self.name}' must be a Law, got {shown(law)}.")
        before, self._law = getattr(self, "_law", law), law
        try:
            announce(self)
        except InputError:
            self._law = before
            raise

    @abstractmethod
    def evaluate(self, state: State, out: Rows) -> None:
        """Write out.error (m,), out.J (m, n), out.drift (m,), and add to out.rate.

        The arrays are fixed: write into them, `out.rate[:] -= speed`.
        """

    def row_names(self, robot: Robot) -> tuple[str, ...]:
        """The names given at construction."""
        return self.rows

    def check(self, robot: Robot) -> None:
        """Frames exist and the law has as many gains as there are rows."""
        super().check(robot)
        m = len(self.row_names(robot))
        for gain in ("stiffness", "damping"):
            size = getattr(getattr(self.law, gain, None), "size", 1)
            if size not in (1, m):
                raise InputError(
                    f"task '{self.name}' has {m} rows and {size} values of {gain}: "
                    "give one number, or one a row."
                )

    def update(self, state: State, rows: Rows) -> None:
        """Ask for the acceleration that the law wants."""
        for array in (rows.error, rows.rate, rows.drift, rows.A):
            array[:] = 0.0
        self.evaluate(state, rows)
        rows.rate[:] += rows.A @ state.v
        rows.upper[:] = self.law.acceleration(rows.error, rows.rate) - rows.drift
        rows.lower[:] = rows.upper


def _per_second_squared(unit: str) -> str:
    if unit in ("", "-") or unit.endswith("/s^2"):
        return unit.strip("-")
    return f"{unit}^2" if unit.endswith("/s") else f"{unit}/s^2"
