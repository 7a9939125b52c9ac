"""What is said of the projection laws (facts, section 3), on the seven-axis arm."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.arms import seven_axis
from tests.catalogue import (
    Levels,
    hierarchy_of,
    random_equalities,
    random_state,
)
from tests.tolerances import (
    PROOF_OF_EQUALITIES,
    PROOF_OF_INEQUALITIES,
    ROUND_OFF,
    SAME,
    SOUND,
)
from wbc import (
    DampedInverse,
    HierarchicalQP,
    InputError,
    NullSpace,
    State,
    UnknownName,
    resolve,
)

N = 7
SEEDS = range(50)
SOUND_RESOLVERS = {
    "wbcf": NullSpace(),
    "tsid": NullSpace(law="tsid"),
    "uf": NullSpace(law="uf"),
    "damped": NullSpace(damping=DampedInverse()),
    "hqp": HierarchicalQP(),
}
sound_resolvers = pytest.mark.parametrize(
    "resolver", SOUND_RESOLVERS.values(), ids=SOUND_RESOLVERS
)


def state_of(seed: int) -> tuple[State, np.random.Generator]:
    rng = np.random.default_rng(seed)
    return random_state(seven_axis(), rng), rng


def compatible(rng: np.random.Generator, sizes=(3, 2)) -> Levels:
    """Random rows, together fewer than joints: all can be met."""
    levels = []
    for m in sizes:
        b = 5.0 * rng.normal(size=m)
        levels.append((rng.normal(size=(m, N)), b, b.copy()))
    return levels


def full_posture(rng: np.random.Generator):
    b = rng.normal(size=N)
    return np.eye(N), b, b.copy()


def missed(levels: Levels, vdot: np.ndarray) -> list[float]:
    """How far each level is from its target, relative to the targets."""
    return [
        float(np.linalg.norm(A @ vdot - b)) / (1.0 + float(np.linalg.norm(b)))
        for A, b, _ in levels
    ]


# -------------------------------------------------------------------------- sound


@sound_resolvers
def test_changing_a_lower_level_does_not_move_a_higher_one(resolver):
    for seed in SEEDS:
        state, rng = state_of(seed)
        levels = random_equalities(rng, N)
        A, b, _ = levels[-1]
        other = [*levels[:-1], (rng.normal(size=A.shape), b + 9.0, b + 9.0)]
        before = resolve(state, hierarchy_of(levels), resolver).acceleration
        after = resolve(state, hierarchy_of(other), resolver).acceleration
        for A, b, _ in levels[:-1]:
            moved = np.linalg.norm(A @ (after - before))
            size = np.linalg.norm(A) * (1.0 + np.linalg.norm(after - before))
            assert moved <= SOUND * (size + np.linalg.norm(b)), f"seed {seed}"


@sound_resolvers
def test_adding_a_lower_level_does_not_move_a_higher_one(resolver):
    for seed in SEEDS:
        state, rng = state_of(seed)
        levels = random_equalities(rng, N)
        more = [*levels, full_posture(rng)]
        before = resolve(state, hierarchy_of(levels), resolver).acceleration
        after = resolve(state, hierarchy_of(more), resolver).acceleration
        for A, b, _ in levels:
            moved = np.linalg.norm(A @ (after - before))
            size = np.linalg.norm(A) * (1.0 + np.linalg.norm(after - before))
            assert moved <= SOUND * (size + np.linalg.norm(b)), f"seed {seed}"


def test_damping_acts_in_the_force_only():
    # the first level is nearly singular, so that it is damped; nothing leaks up
    for seed in SEEDS:
        state, rng = state_of(seed)
        levels = compatible(rng, (3, 2))
        A, b, _ = levels[0]
        A[2] = A[0] + 1e-3 * A[2]
        damped = NullSpace(damping=DampedInverse())
        alone = resolve(state, hierarchy_of(levels[:1]), damped).acceleration
        both = resolve(state, hierarchy_of(levels), damped).acceleration
        exact = resolve(state, hierarchy_of(levels), NullSpace()).acceleration
        assert np.linalg.norm(A @ (exact - both)) > 1e-3, "the damping is at work"
        assert np.linalg.norm(alone) < np.linalg.norm(exact)
        assert_allclose(A @ both, A @ alone, rtol=0, atol=SOUND * np.linalg.norm(b))


def test_damping_away_from_singularities_changes_nothing():
    state, _ = state_of(0)
    level = (np.eye(3, N), np.arange(3.0), np.arange(3.0))
    hierarchy = hierarchy_of([level])
    resolvers = NullSpace(law="tsid", damping=DampedInverse()), NullSpace(law="tsid")
    damped, exact = (resolve(state, hierarchy, r).acceleration for r in resolvers)
    assert_allclose(damped, exact, rtol=0, atol=ROUND_OFF)


def test_damping_bounds_the_acceleration_near_a_singularity():
    state, rng = state_of(1)
    row = rng.normal(size=N)
    for gap in (1e-2, 1e-4, 1e-6):
        A = np.stack([row, row + gap * rng.normal(size=N)])
        hierarchy = hierarchy_of([(A, np.array([1.0, -1.0]), np.array([1.0, -1.0]))])
        free = resolve(state, hierarchy, NullSpace()).acceleration
        damped = resolve(
            state, hierarchy, NullSpace(damping=DampedInverse())
        ).acceleration
        assert np.linalg.norm(free) > 0.1 / gap
        assert np.linalg.norm(damped) < 100.0


# ------------------------------------------------------------------------ optimal


@pytest.mark.parametrize("law", ["wbcf", "tsid"])
def test_compatible_tasks_are_all_met(law):
    for seed in SEEDS:
        state, rng = state_of(seed)
        levels = compatible(rng, (3, 2, 2))
        vdot = resolve(state, hierarchy_of(levels), NullSpace(law=law)).acceleration
        assert max(missed(levels, vdot)) <= SAME, f"seed {seed}"


def test_uf_meets_its_first_task_and_misses_the_second():
    shortfalls = []
    for seed in SEEDS:
        state, rng = state_of(seed)
        levels = compatible(rng, (3, 3))
        vdot = resolve(state, hierarchy_of(levels), NullSpace(law="uf")).acceleration
        first, second = missed(levels, vdot)
        assert first <= SAME, f"seed {seed}"
        shortfalls.append(second)
    assert np.median(shortfalls) > 0.1


def test_uf_is_khatibs_law_on_a_single_task():
    for seed in SEEDS:
        state, rng = state_of(seed)
        ((A, b, _),) = levels = compatible(rng, (4,))
        M_inv = np.linalg.inv(state.M)
        force = np.linalg.solve(A @ M_inv @ A.T, b)
        solution = resolve(state, hierarchy_of(levels), NullSpace(law="uf"))
        torque = state.h + A.T @ force
        assert_allclose(
            solution.torque, torque, rtol=0, atol=SAME * (1 + np.abs(torque).max())
        )


def test_wbcf_is_the_operational_space_recursion_of_the_paper():
    # P4 eqs. (4)-(8) as corrected: h outside, drift in b, coupling inside F_p
    for seed in SEEDS:
        state, rng = state_of(seed)
        levels = compatible(rng, (3, 2, 2))
        M_inv = np.linalg.inv(state.M)
        N_p, applied = np.eye(N), np.zeros(N)
        for A, b, _ in levels:
            J_p = A @ N_p
            Lambda = np.linalg.inv(J_p @ M_inv @ J_p.T)
            force = Lambda @ (b - A @ M_inv @ applied)
            applied = applied + J_p.T @ force
            N_p = N_p - M_inv @ J_p.T @ Lambda @ J_p
        torque = resolve(state, hierarchy_of(levels), NullSpace()).torque
        size = 1.0 + np.abs(applied).max()
        assert_allclose(torque, state.h + applied, rtol=0, atol=1e-6 * size)


def test_wbcf_and_tsid_leave_the_same_task_errors():
    for seed in SEEDS:
        state, rng = state_of(seed)
        levels = random_equalities(rng, N, 2)
        vdots = [
            resolve(state, hierarchy_of(levels), NullSpace(law=law)).acceleration
            for law in ("wbcf", "tsid")
        ]
        for A, b, _ in levels:
            one, two = (A @ vdot for vdot in vdots)
            size = np.linalg.norm(A) * (1 + np.linalg.norm(vdots[0])) + np.abs(b).max()
            assert_allclose(one, two, rtol=0, atol=SAME * size, err_msg=f"{seed}")


def test_wbcf_and_tsid_give_one_torque_once_a_posture_fills_the_space():
    for seed in SEEDS:
        state, rng = state_of(seed)
        hierarchy = hierarchy_of([*compatible(rng, (3, 2)), full_posture(rng)])
        wbcf, tsid = (
            resolve(state, hierarchy, NullSpace(law=law)).torque
            for law in ("wbcf", "tsid")
        )
        size = 1.0 + np.abs(wbcf).max()
        assert_allclose(wbcf, tsid, rtol=0, atol=SAME * size, err_msg=f"{seed}")


def gauss_cost(state: State, torque: np.ndarray) -> float:
    effort = torque - state.h
    return float(effort @ np.linalg.solve(state.M, effort))


def test_wbcf_wins_the_gauss_cost_and_tsid_the_acceleration():
    for seed in SEEDS:
        state, rng = state_of(seed)
        hierarchy = hierarchy_of(compatible(rng, (3, 2)))
        wbcf, tsid = (
            resolve(state, hierarchy, NullSpace(law=law)) for law in ("wbcf", "tsid")
        )
        assert gauss_cost(state, wbcf.torque) < gauss_cost(state, tsid.torque)
        assert np.linalg.norm(tsid.acceleration) < np.linalg.norm(wbcf.acceleration)


def test_wbcf_is_at_the_minimum_of_the_gauss_cost():
    for seed in SEEDS:
        state, rng = state_of(seed)
        levels = compatible(rng, (3, 2))
        solution = resolve(state, hierarchy_of(levels), NullSpace())
        A = np.vstack([rows for rows, _, _ in levels])
        free = np.linalg.svd(A)[2][5:].T
        slope = free.T @ state.M @ solution.acceleration
        size = 1.0 + np.linalg.norm(state.M @ solution.acceleration)
        assert np.linalg.norm(slope) <= SAME * size, f"seed {seed}"


def test_tsid_is_at_the_minimum_of_the_acceleration():
    for seed in SEEDS:
        state, rng = state_of(seed)
        levels = compatible(rng, (3, 2))
        vdot = resolve(state, hierarchy_of(levels), NullSpace(law="tsid")).acceleration
        A = np.vstack([rows for rows, _, _ in levels])
        free = np.linalg.svd(A)[2][5:].T
        assert np.linalg.norm(free.T @ vdot) <= SAME * (1 + np.linalg.norm(vdot))


# ------------------------------------------------------------- singular, conflicting


@pytest.mark.parametrize("law", ["wbcf", "tsid"])
def test_a_conflicting_task_is_served_as_constrained_least_squares(law):
    for seed in SEEDS:
        state, rng = state_of(seed)
        top, last = compatible(rng, (3, 2))
        A1, b1, _ = top
        A2 = np.vstack([A1[:2] + A1[2], rng.normal(size=(2, N))])
        b2 = 5.0 * rng.normal(size=4)
        clash = (A2, b2, b2.copy())
        vdot = resolve(
            state, hierarchy_of([top, clash, last]), NullSpace(law=law)
        ).acceleration
        # the optimum by Lagrange multipliers
        kkt = np.block([[A2.T @ A2, A1.T], [A1, np.zeros((3, 3))]])
        best = np.linalg.lstsq(kkt, np.concatenate([A2.T @ b2, b1]), rcond=None)[0][:N]
        assert np.linalg.norm(A2 @ best - b2) > 1e-2, "they do conflict"
        assert_allclose(
            np.linalg.norm(A2 @ vdot - b2), np.linalg.norm(A2 @ best - b2), rtol=SAME
        )
        assert missed([top], vdot)[0] <= SAME, "the higher task stays exact"
        assert missed([last], vdot)[0] <= SAME, "the lower task is still met"


def test_a_singular_task_gives_its_lost_direction_to_the_next():
    state, rng = state_of(0)
    row, b = rng.normal(size=N), np.array([2.0, 2.0])
    twice = (np.stack([row, row]), b, b.copy())
    solution = resolve(state, hierarchy_of([twice, full_posture(rng)]), NullSpace())
    assert solution.ranks == (1, N - 1)
    assert solution.certificate().holds(PROOF_OF_EQUALITIES)


@pytest.mark.parametrize("law", ["wbcf", "tsid", "uf"])
def test_an_empty_null_space_is_compensated_for_gravity(law):
    state, rng = state_of(0)
    still = seven_axis().state(state.q)
    A = rng.normal(size=(1, N))
    hierarchy = hierarchy_of([(A, np.zeros(1), np.zeros(1))])
    torque = resolve(still, hierarchy, NullSpace(law=law)).torque
    assert_allclose(torque, still.gravity(), rtol=0, atol=SAME)


# ---------------------------------------------------------------------- inequalities


@pytest.mark.parametrize("law", ["wbcf", "tsid"])
def test_a_bound_is_held_only_while_the_tasks_push_against_it(law):
    state, _ = state_of(0)
    e = np.eye(1, N)
    one = np.ones(1)
    pushed = hierarchy_of([(e, -one, one), (e, 3 * one, 3 * one)])
    pulled = hierarchy_of([(e, -one, one), (e, 0.5 * one, 0.5 * one)])
    for hierarchy, expected in ((pushed, 1.0), (pulled, 0.5)):
        vdot = resolve(state, hierarchy, NullSpace(law=law)).acceleration
        assert vdot[0] == pytest.approx(expected, abs=1e-9)


def test_boxes_on_top_are_resolved_as_by_the_hierarchical_qp():
    agreed = 0
    for seed in SEEDS:
        state, rng = state_of(seed)
        box = (np.eye(N), -rng.uniform(1, 4, N), rng.uniform(1, 4, N))
        task = compatible(rng, (3,))[0]
        hierarchy = hierarchy_of([box, task, full_posture(rng)])
        projected = resolve(state, hierarchy, NullSpace()).acceleration
        strict = resolve(state, hierarchy, HierarchicalQP()).acceleration
        assert (projected <= box[2] + 1e-9).all(), f"seed {seed}"
        assert (projected >= box[1] - 1e-9).all(), f"seed {seed}"
        agreed += np.allclose(projected, strict, atol=1e-8)
    assert agreed == len(SEEDS)


@pytest.mark.parametrize(
    "resolver",
    [NullSpace(law="uf"), NullSpace(damping=DampedInverse())],
    ids=["uf", "damped"],
)
def test_bounds_on_top_are_kept_by_laws_that_are_not_optimal(resolver):
    for seed in SEEDS:
        state, rng = state_of(seed)
        box = (np.eye(N), -rng.uniform(1, 4, N), rng.uniform(1, 4, N))
        hierarchy = hierarchy_of([box, *compatible(rng, (3, 2))])
        solution = resolve(state, hierarchy, resolver)
        assert solution.ok
        assert (solution.acceleration <= box[2] + 1e-8).all(), f"seed {seed}"
        assert (solution.acceleration >= box[1] - 1e-8).all(), f"seed {seed}"


def test_bounds_at_several_levels_are_resolved_as_by_the_hierarchical_qp():
    for seed in SEEDS:
        state, rng = state_of(seed)
        box = (np.eye(N), -rng.uniform(1, 4, N), rng.uniform(1, 4, N))
        task, band = compatible(rng, (2, 2))
        band = (band[0], band[1] - 1.0, band[1] + 1.0)
        hierarchy = hierarchy_of([box, task, band, full_posture(rng)])
        projected = resolve(state, hierarchy, NullSpace())
        strict = resolve(state, hierarchy, HierarchicalQP()).acceleration
        assert_allclose(projected.acceleration, strict, rtol=0, atol=1e-7)
        assert projected.certificate().holds(PROOF_OF_INEQUALITIES), f"seed {seed}"


# ------------------------------------------------------------------------- bad input


def test_an_unknown_law_is_refused_with_those_that_exist():
    with pytest.raises(
        UnknownName, match=r"unknown projection law 'osc'.*wbcf, tsid, uf"
    ):
        NullSpace(law="osc")


@pytest.mark.parametrize("name", ["threshold", "factor", "rate"])
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf, "much"])
def test_damping_that_is_not_positive_is_refused(name, value):
    with pytest.raises(InputError, match=name):
        DampedInverse(**{name: value})
