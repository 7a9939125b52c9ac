"""Prioritised control by null-space projection: WBCF, TSID and the UF family.

In coordinates y where the law's metric is the identity (y = L^T vdot with M = L L^T
for the operational-space laws, y = vdot for TSID) the dynamically consistent
projection is an orthogonal one. With Z an orthonormal basis of what higher levels
leave free, P4 eqs. (4)-(8), as corrected, become for each level

    y <- y + Z (J Z)^+ (b - J y),      Z <- Z null(J Z),

with b the wanted acceleration less the drift. Gravity and Coriolis torques are added
once, outside the levels, so that an unassigned null space is compensated too.
"""

from __future__ import annotations

from typing import Literal, TypeAlias, final, get_args

from wbc.checks import known
from wbc.damped import DampedInverse
from wbc.errors import InputError, shown
from wbc.resolver import Resolver, Solver
from wbc.saturation import Saturation
from wbc.stack import Stack

__all__ = ["NullSpace"]

LawName: TypeAlias = Literal["wbcf", "tsid", "uf"]


@final
class NullSpace(Resolver):
    """Strict priorities by projection, inequalities by saturation.

    A violated bound becomes an equality row on top of its own level and is released
    when its multiplier changes sign (saturation in the null space). Should that go
    round in circles, the set of rows to hold is taken from the strict QP.

    Args:
        law: "wbcf" (Sentis and Khatib; sound, and optimal on equalities), "tsid" (Del
            Prete; least joint acceleration in the free space), or "uf" (Peters; each
            task solved alone, then projected: sound, not optimal).
        damping: None for the exact truncated inverse.

    Raises:
        UnknownName: no such law.
        InputError: damping is something else.
    """

    def __init__(
        self, law: LawName = "wbcf", damping: DampedInverse | None = None
    ) -> None:
        known("projection law", law, get_args(LawName))
        if damping is not None and not isinstance(damping, DampedInverse):
            raise InputError(
                "damping must be None or a DampedInverse, such as DampedInverse(), not "
                f"{shown(damping)}."
            )
        self.law, self.damping = law, damping
        self.name = "nullspace" if law == "wbcf" else f"nullspace:{law}"

    def start(self, stack: Stack) -> Solver:
        """A solver with an active set of its own."""
        return Saturation(
            stack,
            kinetic=self.law != "tsid",
            alone=self.law == "uf",
            damping=self.damping,
        )
