"""Torque and joint limits hold whatever the tasks want, and are found again."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from tasks import JointLimits, Posture, TorqueLimits
from tests.arms import random_arm, seven_axis, seven_axis_mjcf, six_axis
from tests.tolerances import JOINT, TORQUE
from wbc import Controller, HierarchicalQP, InputError, NullSpace, Robot, UnknownName

TICKS = 10_000
PERIODS = (1e-3, 5e-3)
"""Control periods [s]."""
CHANGE = 25
"""Ticks between two wild targets."""

ROBOTS = {
    "racer": six_axis,
    "seven": seven_axis,
    "random 3": cache(lambda: random_arm(np.random.default_rng(3), 3)),
    "random 5": cache(lambda: random_arm(np.random.default_rng(5), 5)),
    "random 7": cache(lambda: random_arm(np.random.default_rng(7), 7)),
}
RESOLVERS = {"nullspace": NullSpace, "hqp": HierarchicalQP}
INTEGRATORS = ("semi-implicit", "exact")
RUNS = len(ROBOTS) * len(RESOLVERS) * len(INTEGRATORS) * len(PERIODS)

each_robot = pytest.mark.parametrize("robot", ROBOTS)
each_resolver = pytest.mark.parametrize("resolver", RESOLVERS)
each_integrator = pytest.mark.parametrize("integrator", INTEGRATORS)
each_period = pytest.mark.parametrize("dt", PERIODS)


def step(integrator: str, q, v, a, dt: float):
    """How the robot moves between two ticks."""
    if integrator == "exact":
        return q + dt * v + 0.5 * dt * dt * a, v + dt * a
    v = v + dt * a
    return q + dt * v, v


class Wild:
    """A saturated robot: huge posture targets under the limits."""

    def __init__(self, robot: Robot, resolver: str, integrator: str, dt: float) -> None:
        self.robot, self.integrator, self.dt = robot, integrator, dt
        self.posture = Posture(robot.q_home, stiffness=2_000.0, damping=20.0)
        limits = JointLimits(integrator=integrator)
        self.controller = Controller(
            robot,
            TorqueLimits() >> limits >> self.posture,
            RESOLVERS[resolver](),
            dt,
        )

    def run(self, q, v, ticks: int, rng: np.random.Generator):
        """Yield (q, v, next q, next v, solution) of every tick."""
        centre = 0.5 * (self.robot.q_min + self.robot.q_max)
        for k in range(ticks):
            if k % CHANGE == 0:
                reach = rng.choice([3.0, 30.0, 300.0])
                self.posture.set_target(centre + reach * rng.normal(size=centre.size))
            solution = self.controller(q, v, k * self.dt)
            nq, nv = step(self.integrator, q, v, solution.acceleration, self.dt)
            yield q, v, nq, nv, solution
            q, v = nq, nv


def outside(value, low, high) -> float:
    """Largest violation of low <= value <= high."""
    return float(np.maximum(value - high, low - value).max())


@each_period
@each_integrator
@each_resolver
@each_robot
def test_no_limit_is_exceeded_in_saturated_ticks(robot, resolver, integrator, dt):
    arm = ROBOTS[robot]()
    wild = Wild(arm, resolver, integrator, dt)
    rng = np.random.default_rng(0)
    saturated, worst = 0, 0.0
    torque = accelerated = fast = 0.0
    start = np.clip(arm.q_home, arm.q_min + 0.05, arm.q_max - 0.05)
    for _, _, q, v, solution in wild.run(start, np.zeros(arm.nv), TICKS // RUNS, rng):
        assert solution.ok, solution.message
        worst = max(worst, outside(q, arm.q_min, arm.q_max))
        fast = max(fast, outside(v, -arm.v_max, arm.v_max))
        ratio = np.abs(solution.acceleration) / arm.a_max
        accelerated = max(accelerated, float(ratio.max()) - 1.0)
        load = np.abs(solution.torque) / arm.tau_max
        torque = max(torque, float(load.max()) - 1.0)
        saturated += any(r.active for r in solution.reports())
    assert torque <= TORQUE
    assert worst <= JOINT
    assert fast <= JOINT
    assert accelerated <= JOINT
    assert saturated >= 0.8 * (TICKS // RUNS), "the run is meant to saturate"


def test_the_runs_add_up_to_ten_thousand_ticks():
    assert RUNS * (TICKS // RUNS) == TICKS


@each_integrator
@each_resolver
@each_robot
def test_started_outside_a_position_limit_the_robot_comes_back(
    robot, resolver, integrator
):
    arm, rng = ROBOTS[robot](), np.random.default_rng(1)
    wild = Wild(arm, resolver, integrator, 2e-3)
    q = np.clip(arm.q_home, arm.q_min + 0.3, arm.q_max - 0.3)
    q[0], q[1] = arm.q_max[0] + 0.05, arm.q_min[1] - 0.03
    v = np.zeros(arm.nv)
    for _, _, nq, nv, solution in wild.run(q, v, 250, rng):
        q, v = nq, nv
        assert solution.ok, solution.message
        assert (np.abs(solution.torque) <= arm.tau_max * (1 + TORQUE)).all()
        assert outside(v, -arm.v_max, arm.v_max) <= JOINT
        assert (np.abs(solution.acceleration) <= arm.a_max * (1 + JOINT)).all()
    assert outside(q, arm.q_min, arm.q_max) <= 1e-3
    assert wild.controller.failures == 0


@each_integrator
@each_resolver
@each_robot
def test_started_beyond_a_velocity_limit_the_robot_slows_down(
    robot, resolver, integrator
):
    arm, rng = ROBOTS[robot](), np.random.default_rng(2)
    wild = Wild(arm, resolver, integrator, 2e-3)
    q = 0.5 * (np.maximum(arm.q_min, -3) + np.minimum(arm.q_max, 3))
    v = np.zeros(arm.nv)
    v[0] = 1.05 * arm.v_max[0]
    speeds = [v[0]]
    for *_, nv, solution in wild.run(q, v, 100, rng):
        assert solution.ok, solution.message
        assert (np.abs(solution.torque) <= arm.tau_max * (1 + TORQUE)).all()
        speeds.append(float(np.abs(nv / arm.v_max).max()))
    assert speeds[-1] <= 1.0 + JOINT
    assert wild.controller.failures == 0


@each_integrator
def test_a_robot_at_rest_on_its_limit_may_stay_there(integrator):
    arm = seven_axis()
    limits = JointLimits(integrator=integrator)
    controller = Controller(arm, limits >> Posture(arm.q_max, stiffness=100.0))
    q, v = arm.q_max.copy(), np.zeros(arm.nv)
    for k in range(20):
        solution = controller(q, v, k * 1e-3)
        q, v = step(integrator, q, v, solution.acceleration, 1e-3)
    np.testing.assert_allclose(q, arm.q_max, rtol=0, atol=JOINT)


def test_the_margin_is_kept_from_the_position_limits():
    arm, margin, dt = seven_axis(), 0.1, 5e-3
    far = Posture(10 * arm.q_max, stiffness=100.0)
    controller = Controller(arm, JointLimits(margin=margin) >> far, dt=dt)
    q, v = arm.q_home.copy(), np.zeros(arm.nv)
    for _ in range(600):
        q, v = step("semi-implicit", q, v, controller(q, v).acceleration, dt)
        assert (q <= arm.q_max - margin + JOINT).all()
    np.testing.assert_allclose(q, arm.q_max - margin, rtol=0, atol=1e-3)


def test_a_fraction_of_the_torque_is_kept():
    arm = seven_axis()
    limits = TorqueLimits(fraction=0.5)
    far = Posture(arm.q_home + 2.0, stiffness=1e4)
    torque = Controller(arm, limits >> far)(arm.q_home, np.zeros(arm.nv)).torque
    load = np.abs(torque) / arm.tau_max
    assert load.max() == pytest.approx(0.5, abs=TORQUE)


def test_the_bounds_of_the_wrong_integrator_overshoot():
    # why the integrator must be named: exact bounds on a semi-implicit simulator
    arm = six_axis()
    overshoot = {}
    for integrator in INTEGRATORS:
        posture = Posture(np.minimum(arm.q_max, 3.0) + 5.0, stiffness=400.0)
        controller = Controller(
            arm, JointLimits(integrator=integrator, braking=1.0) >> posture, dt=2e-2
        )
        q, v, worst = np.clip(arm.q_home, arm.q_min, -0.5), np.zeros(arm.nv), -np.inf
        for _ in range(300):
            q, v = step("semi-implicit", q, v, controller(q, v).acceleration, 2e-2)
            worst = max(worst, outside(q, arm.q_min, arm.q_max))
        overshoot[integrator] = worst
    assert overshoot["semi-implicit"] <= JOINT
    assert overshoot["exact"] > 1e-4


# ------------------------------------------------------------------------- bad input


@pytest.mark.parametrize("fraction", [0.0, -0.5, np.nan, np.inf, None])
def test_a_fraction_that_is_not_positive_is_refused(fraction):
    with pytest.raises(InputError, match="fraction must be"):
        TorqueLimits(fraction)


@pytest.mark.parametrize("margin", [-0.1, np.nan, np.inf])
def test_a_margin_that_is_negative_or_not_finite_is_refused(margin):
    with pytest.raises(InputError, match="margin must be finite and at least 0"):
        JointLimits(margin=margin)


@pytest.mark.parametrize("braking", [0.0, -1.0, np.nan])
def test_braking_that_is_not_positive_is_refused(braking):
    with pytest.raises(InputError, match="braking must be finite and greater than 0"):
        JointLimits(braking=braking)


def test_braking_with_more_than_the_limit_is_refused():
    with pytest.raises(InputError, match="braking is a share"):
        JointLimits(braking=1.1)


def test_an_unknown_integrator_is_refused_with_those_that_exist():
    with pytest.raises(UnknownName, match=r"'euler'.*semi-implicit, exact"):
        JointLimits(integrator="euler")


def test_margins_that_leave_no_range_are_refused_at_binding():
    with pytest.raises(InputError, match=r"margin 9\.0 of 'joint limits' leaves no"):
        Controller(seven_axis(), JointLimits(margin=9.0))


def test_an_infinite_acceleration_limit_is_refused_at_binding():
    limit = [9.0, 9.0, np.inf, 9.0, 9.0, 9.0, 9.0]
    arm = Robot.from_mjcf(seven_axis_mjcf(), acceleration_limit=limit)
    with pytest.raises(InputError, match="finite acceleration limit of joint 'a3'"):
        Controller(arm, JointLimits())
