"""Random changes of hierarchies, one on top of another, on a moving robot."""

from __future__ import annotations

import numpy as np
import pytest

from tasks import (
    Damping,
    FrameOrientation,
    FramePosition,
    JointLimits,
    Posture,
    TorqueLimits,
    TorqueRateLimits,
)
from tests.arms import seven_axis
from tests.tolerances import JOINT, SAME, TORQUE
from wbc import Controller, HierarchicalQP, Hierarchy, NullSpace
from wbc.transition import Bound

ARM = seven_axis()
DT = 1e-3
RATE = 300.0
TICKS = 700
SEEDS = range(3)
families = pytest.mark.parametrize(
    "resolver",
    [HierarchicalQP(), NullSpace(), NullSpace("tsid")],
    ids=["hqp", "nullspace", "tsid"],
)


class Motion:
    """An arm that moves as its controller wants, under random stacks."""

    def __init__(self, resolver, seed: int, top: Hierarchy) -> None:
        self.rng, self.top = np.random.default_rng(seed), top
        self.F = ARM.state(ARM.q_home).frame("tip")
        self.control = Controller(ARM, self.stack(), resolver, DT)
        self.q, self.v = ARM.q_home.copy(), np.zeros(ARM.nv)

    def stack(self) -> Hierarchy:
        """Some of the tasks, to random targets, in random order."""
        rng = self.rng
        tip = FramePosition("tip", self.F.p + rng.uniform(-0.1, 0.1, 3))
        aim = FrameOrientation("tip", self.F.R)
        posture = Posture(ARM.q_home + rng.uniform(-0.3, 0.3, ARM.nv))
        pool = [tip, aim, posture]
        order = rng.permutation(len(pool))[: int(rng.integers(1, len(pool) + 1))]
        stack = self.top
        for i in order:
            stack = stack >> pool[i]
        return stack >> Damping()

    def ticks(self, count: int, over: float):
        """Yield every solution; a change comes at random ticks."""
        for _ in range(count):
            if self.rng.uniform() < 0.01:
                self.control.change(self.stack(), over, rate=RATE)
            solution = self.control(self.q, self.v)
            assert solution.ok, solution.message
            self.v = self.v + DT * solution.acceleration
            self.q = self.q + DT * self.v
            yield solution


class Own:
    """How fast the torques of each hierarchy change by themselves [Nm/s]."""

    def __init__(self, monkeypatch) -> None:
        self.now: dict[Bound, np.ndarray] = {}
        self.then: dict[Bound, np.ndarray] = {}
        tick = Bound.tick

        def spied(bound, state):
            found = tick(bound, state)
            self.now[bound] = found[0].copy()
            return found

        monkeypatch.setattr(Bound, "tick", spied)

    def fastest(self) -> float:
        """Of those that were resolved at this tick and the one before."""
        changes = [
            float(np.abs(self.now[b] - self.then[b]).max())
            for b in self.now.keys() & self.then.keys()
        ]
        self.then, self.now = self.now, {}
        return max(changes, default=0.0) / DT


@families
@pytest.mark.parametrize("seed", SEEDS)
def test_limits_hold_and_changes_add_no_more_than_their_rate(
    resolver, seed, monkeypatch
):
    # a stack may be fast by itself, next to a singularity: then so is the blend
    own = Own(monkeypatch)
    motion = Motion(resolver, seed, TorqueLimits(0.8) >> JointLimits())
    before, blended = None, 0
    for solution in motion.ticks(TICKS, over=0.2):
        assert (np.abs(solution.torque) <= 0.8 * ARM.tau_max * (1 + TORQUE)).all()
        assert (motion.q <= ARM.q_max + JOINT).all()
        assert (motion.q >= ARM.q_min - JOINT).all()
        assert (np.abs(motion.v) <= ARM.v_max + JOINT).all()
        fastest = own.fastest()
        if before is not None:
            rate = float(np.abs(solution.torque - before).max()) / DT
            assert rate <= (RATE + fastest) * (1.0 + TORQUE)
        before, blended = solution.torque, blended + (solution.share < 1.0)
    assert blended > TICKS // 5, "changes were under way for much of the time"


@families
@pytest.mark.parametrize("seed", SEEDS)
def test_a_task_that_all_have_on_top_is_met_all_the_way(resolver, seed):
    start = ARM.state(ARM.q_home).frame("tip").p
    fixed = FramePosition("tip", start + np.array([0.0, 0.05, 0.03]), name="fixed")
    motion = Motion(resolver, 10 + seed, Hierarchy(fixed))
    for solution in motion.ticks(TICKS // 2, over=0.2):
        residual = solution.report("fixed").residual
        assert np.abs(residual).max() <= SAME


@families
def test_rate_limits_hold_through_changes_at_once(resolver):
    motion = Motion(resolver, 20, TorqueLimits() >> TorqueRateLimits(800.0))
    torques = np.array([s.torque for s in motion.ticks(TICKS // 2, over=0.0)])
    rates = np.abs(np.diff(torques, axis=0)).max(axis=1) / DT
    assert rates.max() <= 800.0 * (1.0 + TORQUE)
    assert rates.max() >= 790.0, "they were at work"
