"""Rows that are nothing but round-off, at a robot that stands exactly singular."""

from __future__ import annotations

import numpy as np
import pytest

from sims.resolvers import make_resolver
from tasks import JointLimits, Plane, PointOnPlane, Posture, TorqueLimits
from tests.arms import two_link
from tests.tolerances import PROOF, ROUND_OFF
from wbc import Hierarchy, resolve

ARM = two_link()
TIP = "tip"


def beyond_reach(q: np.ndarray) -> PointOnPlane:
    """A plane across the stretched arm, 5 cm further out than the tip."""
    p, elbow = ARM.state(q).frame(TIP).p, ARM.state(q).frame("lower").p
    along = (p - elbow) / np.linalg.norm(p - elbow)
    return PointOnPlane(TIP, Plane(p + 0.05 * along, along))


@pytest.mark.parametrize("name", ["hqp", "nullspace", "nullspace:tsid"])
@pytest.mark.parametrize("turn", [0.0, 0.3, 1.0, np.pi / 2])
@pytest.mark.parametrize("limited", [True, False], ids=["limits", "none"])
def test_a_stretched_arm_is_not_driven_outwards_by_round_off(name, turn, limited):
    q = np.array([turn, 0.0])
    tasks = beyond_reach(q) >> Posture(q)
    stack = TorqueLimits() >> JointLimits() >> tasks if limited else tasks
    solution = resolve(ARM.state(q), stack, make_resolver(name))
    assert solution.ranks[-2:] == (0, 2)
    assert np.abs(solution.acceleration).max() < 100 * ROUND_OFF
    assert solution.certificate().holds(PROOF)
    assert "singular" in str(solution.explain())


@pytest.mark.parametrize("turn", [0.0, 0.3, 1.0, np.pi / 2])
def test_analyse_counts_no_such_row(turn):
    q = np.array([turn, 0.0])
    level = Hierarchy.of(beyond_reach(q)).analyse(ARM.state(q)).levels[0]
    assert (level.rank, level.free) == (0, 2)
