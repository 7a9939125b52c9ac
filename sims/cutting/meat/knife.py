"""What a knife feels: fracture toughness, slice-push ratio, friction of its sides."""

from __future__ import annotations

from typing import Final, final

import mujoco
import numpy as np

from wbc import UnknownName
from wbc.arrays import Array
from wbc.linalg import cross

__all__ = ["Knife", "resistance"]

CHORD: Final = 0.028
"""From the edge to the back of the blade [m]."""
CREEP: Final = 2e-3
"""Speed below which the resistance fades, as it must without stiction [m/s]."""


def resistance(velocity: Array, edge: Array, tearing: float, friction: float) -> Array:
    """Force (3,) on a knife that moves through tissue [N].

    With xi the ratio of the speeds along the edge (slicing) and across it (pushing),
    the energy balance of Atkins (2004) gives
    J w / (1 + xi^2) against the push and J w xi / (1 + xi^2) against the slice.

    Args:
        velocity: (3,) of the knife [m/s].
        edge: (3,) unit vector along its edge.
        tearing: toughness times engaged length of the edge, J w [N].
        friction: of the blade's sides, against the motion [N].
    """
    speed = float(np.sqrt(velocity @ velocity))
    slicing = float(velocity @ edge)
    across = velocity - slicing * edge
    pushing = float(np.sqrt(across @ across))
    fade = 1.0 / np.hypot(speed, CREEP)
    # tearing (push n + xi slice t) / (1 + xi^2), xi = slicing / pushing, is
    # tearing * pushing * velocity / speed^2: no division by a pushing speed of 0.
    share = pushing / speed if speed > 0.0 else 0.0
    return np.asarray(-(tearing * share + friction) * fade * velocity)


@final
class Knife:
    """A knife of a scene, by the site at its tip whose z axis runs along the blade.

    Args:
        model: the scene.
        site: name of the site.

    Raises:
        UnknownName: there is no such site.
    """

    def __init__(self, model: mujoco.MjModel, site: str) -> None:
        names = [model.site(i).name for i in range(model.nsite)]
        if site not in names:
            raise UnknownName("site", site, names)
        self._site = names.index(site)
        self._body = int(model.site_bodyid[self._site])

    def edge(self, data: mujoco.MjData) -> Array:
        """Unit vector (3,) along the blade, out of the tip."""
        return data.site_xmat[self._site, 2::3].copy()

    def feel(self, data: mujoco.MjData, force: Array, point: Array) -> None:
        """Let a force (3,) [N] at a point (3,) act on the tool, and no other.

        Through `xfrc_applied`, which a wrist sensor feels, unlike `qfrc_applied`.
        """
        arm = point - data.xipos[self._body]
        data.xfrc_applied[self._body, :3] = force
        data.xfrc_applied[self._body, 3:] = cross(arm, force)
