"""Readings and targets that no arm has: limits on top hold, or the fallback does."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

from robots import lwr4, racer
from tasks import FramePose, FramePosition, JointLimits, Posture, TorqueLimits
from tests.tolerances import PROOF_OF_INEQUALITIES, TORQUE
from wbc import (
    Controller,
    DampedInverse,
    HierarchicalQP,
    InputError,
    NullSpace,
    SolverError,
    Status,
    WeightedQP,
    resolve,
)

ARM = racer.load()
RESOLVERS = [HierarchicalQP(), NullSpace(), NullSpace("tsid"), WeightedQP()]
NAMES = [resolver.name for resolver in RESOLVERS]
WRAPPED = 4.3e12  # [rad/s] what a 32-bit counter that wraps within 1 ms looks like


def limits():
    return TorqueLimits() >> JointLimits()


def over(joint: int, speed: float) -> np.ndarray:
    v = np.zeros(ARM.nv)
    v[joint] = speed
    return v


@pytest.mark.parametrize("resolver", RESOLVERS, ids=NAMES)
@pytest.mark.parametrize("speed", [1e9, WRAPPED])
def test_a_velocity_beyond_all_reason_breaks_no_torque_limit(resolver, speed):
    reach = FramePosition("torch_tip", [1.0, 0.2, 0.8])
    controller = Controller(ARM, limits() >> reach >> Posture(), resolver)
    solution = controller(ARM.q_home, over(1, speed))
    assert np.all(np.abs(solution.torque) <= ARM.tau_max * (1.0 + TORQUE))
    assert solution.status is Status.SOLVER_FAILED
    assert "too large to calculate with" in solution.message
    assert controller(ARM.q_home, over(1, 0.0)).status is Status.SOLVED


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("name", ["certificate", "explain"])
def test_what_cannot_be_proven_after_absurd_readings_is_an_error_of_ours(name):
    arm = lwr4.load()
    hold = FramePose("flange", [1.0, 0.0, 1.0], np.eye(3))
    controller = Controller(arm, TorqueLimits() >> hold >> Posture())
    q = arm.q_home.copy()
    q[0] = 1e308
    solution = controller(q, np.zeros(arm.nv))
    assert solution.ok
    with pytest.raises(SolverError, match=r"cannot be proven.*absurd measurement"):
        getattr(solution, name)()


def test_a_target_beyond_all_reason_breaks_no_torque_limit():
    reach = FramePosition("torch_tip", [1e150, 0.0, 0.0])
    with np.errstate(all="ignore"):
        solution = Controller(ARM, limits() >> reach)(ARM.q_home, over(0, 0.0))
    assert np.all(np.abs(solution.torque) <= ARM.tau_max * (1.0 + TORQUE))


@pytest.mark.parametrize("resolver", RESOLVERS[:3], ids=NAMES[:3])
def test_joints_too_fast_to_be_stopped_are_braked_as_well_as_can_be(resolver):
    """Bounds of such a joint close to a point, which torque limits put out of reach."""
    stack, worst = limits() >> Posture(), 0.0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        q = np.clip(
            ARM.q_home + 0.3 * rng.normal(size=ARM.nv), ARM.q_min + 0.01, ARM.q_max
        )
        v = rng.choice([5.0, 8.0]) * rng.normal(size=ARM.nv)
        proof = resolve(ARM.state(q, v), stack, resolver).certificate()
        worst = max(worst, proof.worst)
    assert worst <= PROOF_OF_INEQUALITIES


def test_the_least_acceleration_of_tsid_is_proven_in_its_own_measure():
    reach = FramePosition("torch_tip", [1.0, 0.2, 0.8])
    for stack in (reach, limits() >> reach):
        solution = resolve(ARM.state(ARM.q_home), stack, NullSpace("tsid"))
        assert solution.certificate().holds()


@pytest.mark.parametrize("damping", [0.1, True, "much"])
def test_damping_that_is_none_is_refused(damping):
    with pytest.raises(InputError, match="DampedInverse"):
        NullSpace(damping=damping)
    assert NullSpace(damping=DampedInverse()).damping is not None


@pytest.mark.parametrize("resolver", ["hqp", NullSpace])
def test_a_resolver_that_is_none_is_refused_everywhere(resolver):
    controller = Controller(ARM, Posture())
    for call in (
        lambda: resolve(ARM.state(ARM.q_home), Posture(), resolver),
        lambda: Controller(ARM, Posture(), resolver),
        lambda: controller.change(Posture(), resolver=resolver),
    ):
        with pytest.raises(InputError, match="expected a resolver such as"):
            call()


def test_weights_that_turn_priorities_over_are_refused():
    with pytest.raises(InputError, match="at least 1"):
        WeightedQP(ratio=0.1)


@pytest.mark.parametrize("way", [copy.copy, copy.deepcopy, pickle.dumps])
def test_a_controller_is_neither_copied_nor_pickled(way):
    with pytest.raises(InputError, match="make another one"):
        way(Controller(ARM, Posture()))
