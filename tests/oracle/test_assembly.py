"""The assembled rows of a stack against the same formulas in numpy."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tasks import Damping, FramePosition, JointLimits, Posture, TorqueLimits
from tests.arms import random_arm
from tests.tolerances import ROUND_OFF
from wbc import Hierarchy, Robot, Rows, State, Task
from wbc.stack import Stack


class Mixed(Task):
    """Torque rows in plain Python: sums of joints, with a band."""

    space = "torque"

    def __init__(self) -> None:
        super().__init__("mixed", "Nm")

    def row_names(self, robot: Robot) -> tuple[str, ...]:
        return ("all", "none", "ends")

    def update(self, state: State, rows: Rows) -> None:
        rows.A[:] = 0.0
        rows.A[0] = 1.0
        rows.A[2, [0, -1]] = 2.0, -3.0
        rows.lower[:], rows.upper[:] = -7.0, 9.0


@pytest.mark.parametrize("n", range(1, 13))
def test_rows_in_joint_accelerations_and_in_the_kinetic_metric(n):
    rng = np.random.default_rng(n)
    robot = random_arm(rng, n)
    some = robot.joint_names[:: 2 if n > 1 else 1]
    level = (
        0.5 * Posture(np.full(len(some), 0.3), joints=some)
        + 3.0 * Damping(joints=robot.joint_names[-1:])
        + FramePosition("tip", [0.2, 0.1, 0.9])
    )
    hierarchy = Hierarchy.of(2.0 * TorqueLimits() + JointLimits() + Mixed()) >> level
    stack = Stack(robot, hierarchy)
    for _ in range(3):
        state = robot.state(rng.uniform(-1, 1, n), rng.uniform(-1, 1, n))
        stack.update(state)
        L = np.linalg.cholesky(state.M)
        assert_allclose(stack.L, L, rtol=0, atol=ROUND_OFF * np.abs(L).max())
        U = np.linalg.inv(L).T
        near = ROUND_OFF * np.abs(U).max() * n
        assert_allclose(stack.U, U, rtol=0, atol=near)
        for term in stack.terms:
            raw, (*_, lower, upper) = stack.raw[term.where], stack.bands[:, term.where]
            torque = term.task.space == "torque"
            A = term.weight * (raw @ state.M if torque else raw)
            bias = raw @ state.h if torque else 0.0
            size = near * (1.0 + np.abs(A).max()) * np.linalg.cond(state.M)
            assert_allclose(stack.A[term.where], A, rtol=0, atol=size)
            assert_allclose(stack.Ay[term.where], A @ U, rtol=0, atol=size)
            for got, bound in ((stack.lower, lower), (stack.upper, upper)):
                wanted = term.weight * (bound - bias)
                assert_allclose(got[term.where], wanted, rtol=ROUND_OFF, atol=near)
