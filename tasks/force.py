"""Motion in some directions and force in the others, as one task."""

from __future__ import annotations

from collections.abc import Sequence
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from tasks.contact import Contact
from tasks.forcelaw import ForceLaw
from tasks.kernels.force import (
    APPROACH,
    DAMPING,
    FELT,
    FORCE_DAMPING,
    HELD,
    MEMORY,
    PLACE,
    SELECTION,
    SIZE,
    STIFFNESS,
    lean,
    move_and_press,
    work_size,
)
from tasks.touch import TouchTask
from wbc import PD, Robot, Rows, State
from wbc.arrays import Array, frozen, numbers, per_row, positive, rotation
from wbc.checks import expect, named
from wbc.compiled import announce
from wbc.errors import InputError, shown

__all__ = ["HybridForceMotion"]

STILL = np.zeros(3)


@final
class HybridForceMotion(TouchTask):
    """A frame moves along some axes of D and presses along the others.

    P4 eqs. (9) and (19) with Omega_f = R S R^T, Omega_m = I - Omega_f; rows of D are
    either motion rows (PD on position and orientation) or force rows. In a force row
    J_f vdot + drift = (J_f M^-1 J_f^T) (f* - F_s) - kd v, while the torque carries
    J_f^T F_s for what is measured already: together they are Omega_f f* outside
    Lambda, so that a rigid surface feels exactly f*. Yet before contact, where F_s is
    0, nothing leaks into other directions, and torque limits know of all of it. The
    last term is Khatib's damping (1987).

    While nothing is felt, force rows search: they move along F_d at the speed
    `approach`, and the integral term of the force law learns what holds them back.

    Args:
        frame: name of the robot's frame F.
        target: (3,) p_d in the world [m]; only its motion rows matter.
        force: (3,) or (6,) F_d in D, robot on environment, about F's origin [N, Nm].
        selection: (3,) or (6,) diagonal of S, 1 for a force row, 0 for a motion row.
        orientation: (3, 3) R_d in the world; needed for six rows, unused for three.
        axes: (3, 3) R_WD; the world's by default.
        law: of the force.
        stiffness: of the motion rows [1/s^2].
        damping: of the motion rows [1/s], critical by default.
        force_damping: kd of the force rows [1/s].
        approach: speed of the search [m/s].
        threshold: of the force that counts as contact [N, Nm].
        sensor: name of the force sensor.
        sensor_frame: where it sits on the robot.
        name: "<frame> hybrid" by default.

    Raises:
        InputError: shapes that do not fit, a selection that is not of 0 and 1, no
            orientation for six rows, unusable gains; at the first tick, no such sensor.
    """

    def __init__(
        self,
        frame: str,
        target: ArrayLike,
        force: ArrayLike,
        selection: Sequence[int] = (0, 0, 1),
        *,
        orientation: ArrayLike | None = None,
        axes: ArrayLike | None = None,
        law: ForceLaw | None = None,
        stiffness: ArrayLike = 400.0,
        damping: ArrayLike | None = None,
        force_damping: ArrayLike = 60.0,
        approach: float = 0.01,
        threshold: float = 1.0,
        sensor: str = "wrist",
        sensor_frame: str = "wrist_sensor",
        name: str | None = None,
    ) -> None:
        name = named(name, f"{frame} hybrid")
        S = _selection(selection, name)
        super().__init__(name, "m, N", frame, S.size, SIZE, axes, sensor, sensor_frame)
        self._numbers[SELECTION : SELECTION + S.size] = S
        self.claims = tuple(
            f"{kind} of sensor '{sensor}'"
            for kind, rows in (("force", S[:3]), ("moment", S[3:]))
            if rows.any()
        )
        self._S, self._f, self._m = S, np.flatnonzero(S), np.flatnonzero(S == 0.0)
        expect(ForceLaw | None, law=law)
        self.law = ForceLaw() if law is None else law
        self.motion_law = PD(stiffness, damping)
        self.force_damping = per_row(force_damping, "force_damping")
        self.approach = positive(approach, "approach", zero=True)
        self._contact = Contact(threshold)
        self._memory, self._work = np.zeros((MEMORY, 6)), np.zeros(0)
        self._held = self._memory[HELD, : self._f.size]
        if S.size == 6 and orientation is None:
            raise InputError(f"'{name}' has six rows: give it an orientation.")
        self.set_target(target, orientation)
        self.set_force(force)
        self.reset()

    def set_target(
        self,
        target: ArrayLike,
        orientation: ArrayLike | None = None,
        velocity: ArrayLike = STILL,
        acceleration: ArrayLike = STILL,
    ) -> None:
        """Move the target of the motion rows; angular ones are at rest.

        Raises:
            InputError: unusable values; the target stays as it was.
        """
        R = self._R_d
        if orientation is not None:
            R = rotation(orientation, f"orientation of '{self.name}'")
        self._aim(target, velocity, acceleration)
        self._R_d[:] = R

    def set_force(self, force: ArrayLike) -> None:
        """Change F_d, (3,) or (6,) in D; motion rows ignore theirs.

        Raises:
            InputError: not one number a row, or not finite; the force stays as it was.
        """
        self._force[:] = frozen(force, (self.size,), f"force of '{self.name}'")

    def reset(self) -> None:
        """Forget the integral term and the contact."""
        self._contact.reset()
        self._memory[:], self._size = 0.0, 0.0
        self._memory[PLACE, :3] = self._target[0]

    @property
    def felt(self) -> Array:
        """Wrench (6,) on the surroundings about F's origin, at the last tick, world."""
        return np.array(self._memory[FELT])

    @property
    def position(self) -> Array:
        """Where F's origin was at the last tick, (3,) [m]."""
        return np.array(self._memory[PLACE, :3])

    @property
    def touching(self) -> bool:
        """Whether contact was felt at the last tick."""
        return self._contact.touching

    @property
    def Omega_f(self) -> Array:
        """R S R^T, (m, m) in world axes."""
        R = np.kron(np.eye(self.size // 3), self._R)
        return R @ np.diag(self._S) @ R.T

    @property
    def Omega_m(self) -> Array:
        """I - Omega_f, (m, m) in world axes."""
        return np.eye(self.size) - self.Omega_f

    def check(self, robot: Robot) -> None:
        """Frames exist, and gains are one number or one a row of their kind."""
        super().check(robot)
        announce(move_and_press, f"'{self.name}'")
        for gain, rows in (
            (self.motion_law.stiffness, self._m),
            (self.motion_law.damping, self._m),
            (self.force_damping, self._f),
        ):
            if gain.size not in (1, rows.size):
                raise InputError(
                    f"'{self.name}' has {rows.size} such rows and {gain.size} gains: "
                    "give one number, or one a row."
                )

    def row_units(self, rows: int) -> tuple[str, ...]:
        """Metres and radians where it moves, newtons and newton metres where not."""
        kinds = (("m", "N"), ("rad", "Nm"))
        pressed = self._S.astype(int)
        return tuple(kinds[i // 3][pressed[i]] for i in range(rows))

    def update(self, state: State, rows: Rows) -> None:
        """Write the rows."""
        F = S = state.flat(self.frame)
        if self._f.size:
            self._listen(state)
            S = state.flat(self.sensor_frame)
        if self._work.size != work_size(state.robot.nv):
            self._work = np.zeros(work_size(state.robot.nv))
        self._size = move_and_press(
            self._parameters(),
            F,
            S,
            self._wrench,
            state.M,
            self._memory,
            self._work,
            self.law.proportional,
            self.law.integral,
            self._contact.touching,
            rows,
        )

    def advance(self, state: State, torque: Array) -> None:
        """Add J_f^T F_s to the torques, and move on contact and integral term."""
        count, touching = self._f.size, self._contact.touching
        if not count:
            return
        F, limit = state.flat(self.frame), self.law.limit
        lean(F, self._memory, count, touching, state.dt, limit, torque)
        if self._contact.feel(self._size, state.dt) and self.law.integral == 0.0:
            self._held[:] = 0.0  # nothing would unlearn it

    def _parameters(self) -> Array:
        """Numbers for the kernels, with the gains as they are now."""
        p, moving, pressing = self._numbers, self._m.size, self._f.size
        p[STIFFNESS : STIFFNESS + moving] = self.motion_law.stiffness
        p[DAMPING : DAMPING + moving] = self.motion_law.damping
        p[FORCE_DAMPING : FORCE_DAMPING + pressing] = self.force_damping
        p[APPROACH] = self.approach
        return p


def _selection(selection: Sequence[int], task: str) -> Array:
    S = numbers(selection, f"selection of '{task}'")
    if S.shape not in ((3,), (6,)) or not np.isin(S, (0.0, 1.0)).all():
        raise InputError(
            f"selection of '{task}' must be three or six of 0 (motion) and 1 (force), "
            f"got {shown(selection)}."
        )
    return S
