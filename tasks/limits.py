"""Joint and torque limits as inequality rows."""

from __future__ import annotations

from typing import Literal, TypeAlias, final, get_args

import numpy as np
from numpy.typing import ArrayLike

from tasks.base import run_kernel
from tasks.evaluator import Code, run
from wbc import Kernel, Robot, Rows, State, Task
from wbc.arrays import Array, per_row, positive
from wbc.binding import announce
from wbc.checks import known
from wbc.errors import InputError
from wbc.kernel import NO_TABLE
from wbc.settled import Settled

__all__ = ["JointLimits", "TorqueLimits", "TorqueRateLimits"]

Integrator: TypeAlias = Literal["semi-implicit", "exact"]


@final
class TorqueLimits(Settled, Task):
    """-tau_max <= tau <= tau_max, one row a joint [Nm or N].

    Args:
        fraction: share of the robot's limits that may be used.
        name: "torque limits" by default.

    Raises:
        InputError: the fraction is not greater than 0, or above 1.
    """

    space = "torque"

    def __init__(self, fraction: float = 1.0, *, name: str = "torque limits") -> None:
        super().__init__(name, "Nm")
        self.fraction = fraction

    @property
    def fraction(self) -> float:
        """Share of the robot's limits that may be used; may be changed on the way.

        Raises:
            InputError: when set, not greater than 0, or above 1; it stays as it was.
        """
        return self._fraction

    @fraction.setter
    def fraction(self, fraction: float) -> None:
        if positive(fraction, "fraction") > 1.0:
            raise InputError("fraction is a share of the torque limits, at most 1.")
        self._fraction = float(fraction)
        announce(self)

    def row_names(self, robot: Robot) -> tuple[str, ...]:
        """The joints' names."""
        return robot.joint_names

    def kernel(self, robot: Robot) -> Kernel:
        """The compiled half."""
        limit = self.fraction * robot.tau_max
        joints = np.arange(limit.size)
        return Kernel(run, int(Code.TORQUE_BOUNDS), limit, joints=joints)

    def update(self, state: State, rows: Rows) -> None:
        """Write the rows."""
        p = self.kernel(state.robot).parameters
        run_kernel(Code.TORQUE_BOUNDS, p, NO_TABLE, None, state, rows)


@final
class TorqueRateLimits(Settled, Task):
    """|tau - tau_before| <= rate dt, one row a joint [Nm or N].

    The torque before is what the controller sent at the last tick, blends and
    fallbacks included; at the first tick nothing is bounded. Industrial arms stop at
    1000 Nm/s. Below the limits that no task may break, these give way to them.

    Args:
        rate: largest change of a torque [Nm/s], one number or one a joint.
        name: "torque rate limits" by default.

    Raises:
        InputError: a rate is not greater than 0; at binding, not one a joint.
    """

    space = "torque"

    def __init__(
        self, rate: ArrayLike = 1000.0, *, name: str = "torque rate limits"
    ) -> None:
        super().__init__(name, "Nm")
        self.rate = rate

    @property
    def rate(self) -> Array:
        """Largest change [Nm/s], () or (n,); may be changed on the way.

        Raises:
            InputError: when set, not greater than 0, or not one a joint.
        """
        return self._rate

    @rate.setter
    def rate(self, rate: ArrayLike) -> None:
        checked = per_row(rate, f"rate of '{self.name}'")
        if (checked == 0.0).any():
            raise InputError(f"rate of '{self.name}' must be greater than 0.")
        before, self._rate = getattr(self, "_rate", checked), checked
        try:
            announce(self)
        except InputError:
            self._rate = before
            raise

    def row_names(self, robot: Robot) -> tuple[str, ...]:
        """The joints' names."""
        return robot.joint_names

    def check(self, robot: Robot) -> None:
        """One rate, or one a joint."""
        if self._rate.size not in (1, robot.nv):
            raise InputError(
                f"'{self.name}' has {self._rate.size} rates, but robot '{robot.name}' "
                f"has {robot.nv} joints: give one number, or one a joint."
            )

    def update(self, state: State, rows: Rows) -> None:
        """Write the rows."""
        np.fill_diagonal(rows.A, 1.0)
        if state.commanded is None:
            rows.lower[:], rows.upper[:] = -np.inf, np.inf
            return
        step = self._rate * state.dt
        rows.lower[:], rows.upper[:] = state.commanded - step, state.commanded + step


@final
class JointLimits(Settled, Task):
    """Position, velocity and acceleration limits as bounds on vdot, one row a joint.

    The bounds are viable: whoever keeps them can always stop before the position
    limit, with the share `braking` of the acceleration limit (Del Prete 2018, RA-L
    3(1); the form must match how the robot moves between ticks). Outside a position
    limit they lead back in at a bounded speed; they never ask for more than the
    acceleration limit.

    Args:
        margin: distance kept from the position limits [rad or m].
        braking: share of the acceleration limit that stopping counts on.
        integrator: "semi-implicit" for a simulator that steps the velocity first
            (MuJoCo), "exact" for constant acceleration between ticks.
        name: "joint limits" by default.

    Raises:
        InputError: an unusable number; at binding, an infinite acceleration limit,
            or no range left between the margins.
        UnknownName: no such integrator.
    """

    def __init__(
        self,
        *,
        margin: float = 0.0,
        braking: float = 0.9,
        integrator: Integrator = "semi-implicit",
        name: str = "joint limits",
    ) -> None:
        super().__init__(name, "rad/s^2")
        self.margin = positive(margin, "margin", zero=True)
        self.braking = positive(braking, "braking")
        if self.braking > 1.0:
            raise InputError("braking is a share of the acceleration limit, at most 1.")
        self.integrator = known("integrator", integrator, get_args(Integrator))

    def row_names(self, robot: Robot) -> tuple[str, ...]:
        """The joints' names."""
        return robot.joint_names

    def check(self, robot: Robot) -> None:
        """Accelerations are bounded and the margins leave a range."""
        if not np.isfinite(robot.a_max).all():
            bad = robot.joint_names[int(np.argmax(~np.isfinite(robot.a_max)))]
            raise InputError(
                f"'{self.name}' needs a finite acceleration limit of joint '{bad}': "
                "load the robot with acceleration_limit=..."
            )
        if (robot.q_max - robot.q_min <= 2.0 * self.margin).any():
            raise InputError(f"margin {self.margin} of '{self.name}' leaves no range.")

    def kernel(self, robot: Robot) -> Kernel:
        """The compiled half."""
        parameters = np.array([self.braking, float(self.integrator == "exact")])
        low, high = robot.q_min + self.margin, robot.q_max - self.margin
        table = np.concatenate([low, high, robot.v_max, robot.a_max])
        joints = np.arange(low.size)
        return Kernel(run, int(Code.JOINT_BOUNDS), parameters, table, joints=joints)

    def update(self, state: State, rows: Rows) -> None:
        """Write the rows."""
        kernel = self.kernel(state.robot)
        p, table = kernel.parameters, kernel.table
        run_kernel(Code.JOINT_BOUNDS, p, table, None, state, rows)
