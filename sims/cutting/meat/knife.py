"""What a knife feels: fracture toughness, slice-push ratio, friction of its sides."""

from __future__ import annotations

from typing import Final, final

import mujoco
import numpy as np

from wbc import UnknownName
from wbc.arrays import Array
from wbc.linalg import cross

__all__ = ["CHORD", "Indentation", "Knife", "resistance"]

CHORD: Final = 0.028
"""From the edge to the back of the blade [m]."""
INDENTATION: Final = 2e4
"""Stiffness of tissue before an edge cuts it [N/m]."""


def resistance(motion: Array, edge: Array, tearing: float, friction: float) -> float:
    """Force with which tissue resists a knife that moves on in it [N].

    With xi the ratio of the ways along the edge (slicing) and across it (pushing), the
    energy balance of Atkins (2004) gives J w / (1 + xi^2) against the push and
    J w xi / (1 + xi^2) against the slice: together a force against the motion of
    J w / sqrt(1 + xi^2), whose work is J w times the way that the edge is pushed.

    Args:
        motion: (3,) of the knife in a step [m]; at rest it counts as pushing.
        edge: (3,) unit vector along the knife's edge.
        tearing: toughness times engaged length of the edge, J w [N].
        friction: of the blade's sides [N].
    """
    way2 = float(motion @ motion)
    slicing = float(motion @ edge)
    share = max(1.0 - slicing * slicing / way2, 0.0) ** 0.5 if way2 > 0.0 else 1.0
    return tearing * share + friction


@final
class Indentation:
    """Tissue in front of an edge: it yields elastically, then is cut.

    So the resistance exists at rest as well, and a knife that cannot cut stands still
    instead of creeping. Motions are those of the knife against the tissue.
    """

    def __init__(self) -> None:
        self._z = np.zeros(3)

    def force(self, motion: Array, limit: float) -> Array:
        """Force (3,) on the knife after a motion (3,) [m], at most the limit [N]."""
        z = self._z + motion
        force = INDENTATION * float(np.sqrt(z @ z))
        if force > limit:
            z *= limit / force
        self._z = z
        return -INDENTATION * z


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
        return np.array(data.site_xmat[self._site, 2::3])

    def feel(self, data: mujoco.MjData, force: Array, point: Array) -> None:
        """Let a force (3,) [N] at a point (3,) act on the tool, and no other.

        Through `xfrc_applied`, which a wrist sensor feels, unlike `qfrc_applied`.
        """
        arm = point - data.xipos[self._body]
        data.xfrc_applied[self._body, :3] = force
        data.xfrc_applied[self._body, 3:] = cross(arm, force)
