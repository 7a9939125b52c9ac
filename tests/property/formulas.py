"""What tests of compiled formulas share: tolerance, rows, finite differences."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.arms import ROBOTS
from tests.tolerances import DIFFERENCE, STEP
from wbc import Rows, State, Task, allocate_rows

SEEDS = 20
CLOSE = 1e-10
"""Relative to the size of what is compared."""

both_robots = pytest.mark.parametrize("robot", ROBOTS)


def same(found, expected) -> None:
    expected = np.asarray(expected)
    size = max(1.0, float(np.abs(expected).max(initial=0.0)))
    assert_allclose(found, expected, rtol=0, atol=CLOSE * size)


def rows_of(task: Task, state: State) -> Rows:
    rows = allocate_rows(len(task.row_names(state.robot)), state.robot.nv)
    task.update(state, rows)
    return rows


def check_differences(task: Task, state: State, which: Sequence[int]) -> None:
    """J is the slope of the rate over v, drift that of the rate over time."""

    def rate(q, v):
        return rows_of(task, state.robot.state(q, v, wrenches=state.wrenches)).rate

    q, v, h, which = state.q, state.v, STEP, list(which)
    now = rows_of(task, state)
    J = np.array([rate(q, v + e) - now.rate for e in np.eye(v.size)]).T
    drift = (rate(q + h * v, v) - rate(q - h * v, v)) / (2.0 * h)
    for found, expected in ((now.A, J), (now.drift, drift)):
        size = 1.0 + float(np.abs(expected).max())
        assert_allclose(found[which], expected[which], rtol=0, atol=DIFFERENCE * size)
