"""How a simulated robot differs from the controller's model of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import mujoco
import numpy as np

from wbc.arrays import Array, BoolArray, positive
from wbc.checks import flag, whole

__all__ = ["Mismatch"]


@final
@dataclass(frozen=True, slots=True)
class Mismatch:
    """Seeded errors of masses, centres of mass and joint friction.

    Attributes:
        mass: largest relative error of a link's mass and inertia.
        offset: largest shift of a centre of mass along each axis [m].
        coulomb: dry friction, as a share of each joint's torque limit.
        viscous: viscous friction [s], as a share of the torque limit per rad/s.
        seed: of the errors.

    Raises:
        InputError: a negative number, or a seed that is not whole.
    """

    mass: float = 0.05
    offset: float = 0.003
    coulomb: float = 0.005
    viscous: float = 0.005
    seed: int = 0

    def __post_init__(self) -> None:
        """Refuse what are no sizes."""
        for name in ("mass", "offset", "coulomb", "viscous"):
            positive(getattr(self, name), name, zero=True)
        whole(self.seed, "seed")

    @classmethod
    def when(cls, mismatch: bool, seed: int) -> Mismatch | None:
        """The errors of a seed where they are wanted, else None.

        Raises:
            InputError: not a truth value, or not a seed.
        """
        flag(mismatch=mismatch)
        errors = cls(seed=seed)
        return errors if mismatch else None

    def apply(self, model: mujoco.MjModel, dofs: Array, tau_max: Array) -> None:
        """Change the simulated model, in place; the controller's is not touched."""
        rng = np.random.default_rng(self.seed)
        moved = _carried_by(model, dofs)
        factor = 1.0 + moved * rng.uniform(-self.mass, self.mass, model.nbody)
        model.body_mass *= factor
        model.body_inertia *= factor[:, None]
        shift = rng.uniform(-self.offset, self.offset, (model.nbody, 3))
        model.body_ipos += shift * (moved & (model.body_mass > 0.0))[:, None]
        model.dof_frictionloss[dofs] = self.coulomb * tau_max
        model.dof_damping[dofs] = self.viscous * tau_max
        mujoco.mj_setConst(model, mujoco.MjData(model))


def _carried_by(model: mujoco.MjModel, dofs: Array) -> BoolArray:
    """Bodies (nbody,) that move with these degrees of freedom: the robot's own."""
    carried = np.zeros(model.nbody, dtype=bool)
    carried[model.dof_bodyid[dofs]] = True
    for body in range(1, model.nbody):  # parents come before children
        carried[body] |= carried[model.body_parentid[body]]
    return carried
