"""Tiny images of directions, which projection and certificate once took for more."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from robots import lwr4
from sims.resolvers import make_resolver
from tasks import FramePosition, JointLimits, Posture, TorqueLimits
from tests.tolerances import AGREEMENT, PROOF, ROUND_OFF
from wbc import Hierarchy, State, Status, resolve, solve_hierarchy

ARM = lwr4.load()
TIP = "knife_tip"


def reach() -> Hierarchy:
    p = ARM.state(ARM.q_home).frame(TIP).p
    return TorqueLimits() >> JointLimits() >> FramePosition(TIP, p + 0.2)


def state(seed: int) -> State:
    rng = np.random.default_rng(seed)
    q = np.clip(ARM.q_home + 0.3 * rng.normal(size=7), ARM.q_min, ARM.q_max)
    return ARM.state(q, 0.5 * rng.normal(size=7))


@pytest.mark.parametrize("seed", [70, *range(8)])
def test_a_joint_that_moves_nothing_is_not_driven_by_what_a_reflection_left(seed):
    # Six bounds held, and the seventh joint turns about the tip: at seed 70 the last
    # reflection left it 3e-9 of another joint, and the projection used that.
    exact, projected = (
        resolve(state(seed), reach(), make_resolver(name))
        for name in ("hqp", "nullspace")
    )
    assert projected.status is Status.SOLVED
    assert projected.certificate().holds(PROOF)
    assert_allclose(
        projected.acceleration,
        exact.acceleration,
        rtol=0,
        atol=AGREEMENT * np.linalg.norm(exact.acceleration),
    )


@pytest.mark.parametrize("seed", [261, 306, 578, 2378])
def test_a_right_answer_is_proven_where_equalities_leave_bounds_no_say(seed):
    # What was left of the bounds' rows was round-off, and multipliers came out of it.
    solution = resolve(
        state(seed), reach() >> Posture(), make_resolver("nullspace:tsid")
    )
    assert solution.status is Status.SOLVED
    assert solution.certificate().holds(PROOF)


def test_levels_stored_by_columns_are_read_as_they_are_written():
    A = np.array([[1.0, 3.0], [2.0, 5.0]]).T
    found = solve_hierarchy([(A, [1, 1], [1, 1])])
    assert_allclose(found.x, [-3.0, 2.0], rtol=0, atol=100 * ROUND_OFF)
    assert found.certificate().holds(PROOF)
