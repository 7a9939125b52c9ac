"""Joint and torque limits as inequality rows."""

from __future__ import annotations

from typing import Literal, TypeAlias, final, get_args

import numpy as np

from wbc import Robot, Rows, State, Task, UnknownName
from wbc.arrays import Array, positive
from wbc.errors import InputError

__all__ = ["JointLimits", "TorqueLimits", "exact_bounds", "semi_implicit_bounds"]

Integrator: TypeAlias = Literal["semi-implicit", "exact"]

RECOVERY = 0.1
"""Time constant [s] of the way back into the limits."""
RECOVERY_SPEED = 0.25
"""Share of the velocity limit that the way back may use."""


@final
class TorqueLimits(Task):
    """-tau_max <= tau <= tau_max, one row a joint [Nm or N].

    Args:
        fraction: share of the robot's limits that may be used.
        name: "torque limits" by default.

    Raises:
        InputError: the fraction is not greater than 0.
    """

    space = "torque"

    def __init__(self, fraction: float = 1.0, *, name: str = "torque limits") -> None:
        super().__init__(name, "Nm")
        self.fraction = positive(fraction, "fraction")

    def row_names(self, robot: Robot) -> tuple[str, ...]:
        """The joints' names."""
        return robot.joint_names

    def update(self, state: State, rows: Rows) -> None:
        """Write the rows."""
        limit = self.fraction * state.robot.tau_max
        np.fill_diagonal(rows.A, 1.0)
        rows.lower[:], rows.upper[:] = -limit, limit


@final
class JointLimits(Task):
    """Position, velocity and acceleration limits as bounds on vdot, one row a joint.

    The bounds are viable: whoever keeps them can always stop before the position
    limit, with the share `braking` of the acceleration limit (Del Prete 2018, RA-L
    3(1), as corrected in section 8 of the facts; the form must match how the robot
    moves between ticks). Outside a position limit they lead back in at a bounded
    speed; they never ask for more than the acceleration limit.

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
        if integrator not in get_args(Integrator):
            raise UnknownName("integrator", integrator, get_args(Integrator))
        self._bounds = {"semi-implicit": semi_implicit_bounds, "exact": exact_bounds}[
            integrator
        ]

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

    def update(self, state: State, rows: Rows) -> None:
        """Write the rows."""
        robot = state.robot
        np.fill_diagonal(rows.A, 1.0)
        A, V, dt = robot.a_max, robot.v_max, state.dt
        stop = self.braking * A
        upper = self._bounds(
            robot.q_max - self.margin - state.q, state.v, V, A, stop, dt
        )
        lower = -self._bounds(
            state.q - robot.q_min - self.margin, -state.v, V, A, stop, dt
        )
        middle = 0.5 * (lower + upper)
        crossed = lower > upper
        rows.lower[:] = np.where(crossed, middle, lower)
        rows.upper[:] = np.where(crossed, middle, upper)


def semi_implicit_bounds(
    gap: Array, v: Array, V: Array, A: Array, stop: Array, dt: float
) -> Array:
    """Largest acceleration (n,) towards a limit, for v+ = v + dt a, q+ = q + dt v+.

    v+ <= min(V, -stop dt + sqrt((stop dt)^2 + 2 stop gap)): after the step, braking
    with `stop` ends at the limit.

    Args:
        gap: distance to the limit (n,), negative beyond it.
        v: velocity towards it (n,).
        V: velocity limit (n,).
        A: acceleration limit (n,).
        stop: deceleration that braking counts on (n,).
        dt: control period [s].
    """
    room = np.maximum(gap, 0.0)
    after = -stop * dt + np.sqrt((stop * dt) ** 2 + 2.0 * stop * room)
    after = np.where(gap < 0.0, _way_back(gap, V), np.minimum(V, after))
    return np.clip((after - v) / dt, -A, A)


def exact_bounds(
    gap: Array, v: Array, V: Array, A: Array, stop: Array, dt: float
) -> Array:
    """Largest acceleration (n,) towards a limit, constant over dt.

    Arguments as for `semi_implicit_bounds`. The smallest of the bounds by position
    within the step, by velocity, and by viability after it.
    """
    room = np.maximum(gap, 0.0)
    a1 = -v / dt
    a3 = 2.0 * (room - dt * v) / dt**2
    with np.errstate(divide="ignore", invalid="ignore"):
        peak = np.where(room > 0.0, -(v**2) / (2.0 * room), -np.inf)
    position = np.where((v <= 0.0) | (a3 > a1), a3, np.minimum(a1, peak))
    b = 2.0 * dt * v + stop * dt**2
    c = v**2 - 2.0 * stop * (room - dt * v)
    root = b * b - 4.0 * dt**2 * c
    smooth = (-b + np.sqrt(np.maximum(root, 0.0))) / (2.0 * dt**2)
    viable = np.where(root < 0.0, a1, np.maximum(a1, smooth))
    inside = np.minimum(np.minimum(position, (V - v) / dt), viable)
    back = (_way_back(gap, V) - v) / dt
    return np.clip(np.where(gap < 0.0, back, inside), -A, A)


def _way_back(gap: Array, V: Array) -> Array:
    """Velocity (n,) wanted beyond a limit: back in, at a share of the limit's speed."""
    return np.maximum(gap / RECOVERY, -RECOVERY_SPEED * V)
