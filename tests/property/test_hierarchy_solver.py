"""The strict solver proves itself on levels that hypothesis makes up."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from tests.tolerances import PROOF, SOUND
from wbc import Status, solve_hierarchy
from wbc.certificate import slack_of

settings.register_profile("core", derandomize=True, deadline=None, max_examples=250)
proven = settings(settings.get_profile("core"))

KINDS = ("plain", "deficient", "redundant", "conflicting", "zero")
SIDES = ("equal", "both", "lower", "upper", "none")
# Small whole numbers meet bounds exactly and tie often: the degenerate cases.
coefficients = st.integers(-3, 3).map(float)
scales = st.floats(-6.0, 6.0).map(lambda exponent: 10.0**exponent)


@st.composite
def matrices(draw, n: int, above: list[np.ndarray]):
    m = draw(st.integers(1, 4))
    cells = draw(st.lists(coefficients, min_size=m * n, max_size=m * n))
    A = np.array(cells).reshape(m, n)
    kind = draw(st.sampled_from(KINDS))
    if kind == "deficient":
        A = np.outer(A[:, 0], A[0])
    elif kind == "redundant":
        A[-1] = A[0]
    elif kind == "conflicting" and above:
        A[0] = above[draw(st.integers(0, len(above) - 1))][0]
    elif kind == "zero":
        A[draw(st.integers(0, m - 1))] = 0.0
    return A


@st.composite
def hierarchies(draw, sides=SIDES):
    n = draw(st.integers(1, 6))
    above: list[np.ndarray] = []
    levels = []
    for _ in range(draw(st.integers(1, 4))):
        A = draw(matrices(n, above))
        above.append(A)
        m = A.shape[0]
        lower = np.array(draw(st.lists(coefficients, min_size=m, max_size=m)))
        width = np.array(draw(st.lists(st.integers(1, 4), min_size=m, max_size=m)))
        side = np.array(draw(st.lists(st.sampled_from(sides), min_size=m, max_size=m)))
        upper = np.where(side == "equal", lower, lower + width)
        lower = np.where((side == "upper") | (side == "none"), -np.inf, lower)
        upper = np.where((side == "lower") | (side == "none"), np.inf, upper)
        scale = draw(scales)
        levels.append((scale * A, scale * lower, scale * upper))
    return levels


@proven
@given(hierarchies())
def test_the_certificate_holds_on_anything(levels):
    result = solve_hierarchy(levels)
    assert result.status is Status.SOLVED
    proof = result.certificate()
    assert proof.holds(PROOF), proof


@proven
@given(hierarchies(sides=("equal",)))
def test_the_certificate_holds_tightly_on_equalities(levels):
    proof = solve_hierarchy(levels).certificate()
    assert proof.holds(PROOF), proof


@proven
@given(hierarchies())
def test_the_slacks_are_what_the_point_leaves(levels):
    result = solve_hierarchy(levels)
    for (A, lower, upper), slack in zip(levels, result.slacks, strict=True):
        size = np.linalg.norm(A) * (1.0 + np.linalg.norm(result.x))
        expected = slack_of(A, result.x, lower, upper)
        assert_allclose(slack, expected, rtol=0, atol=1e-8 * (size + 1e-3))


@proven
@given(hierarchies())
def test_a_level_below_does_not_disturb_those_above(levels):
    result = solve_hierarchy(levels)
    for k in range(1, len(levels)):
        alone = solve_hierarchy(levels[:k])
        for (A, *_), one, two in zip(
            levels[:k], alone.slacks, result.slacks[:k], strict=True
        ):
            size = np.linalg.norm(A) * (1.0 + np.linalg.norm(result.x)) + 1e-9
            assert_allclose(one, two, rtol=0, atol=10 * SOUND * size)


@proven
@given(hierarchies(), scales)
def test_the_point_does_not_depend_on_the_scale_of_a_level(levels, scale):
    A, lower, upper = levels[0]
    scaled = [(scale * A, scale * lower, scale * upper), *levels[1:]]
    x, y = solve_hierarchy(levels).x, solve_hierarchy(scaled).x
    assert_allclose(x, y, rtol=0, atol=1e-6 * (1.0 + np.abs(x).max()))


@proven
@given(hierarchies())
def test_an_active_row_is_at_a_bound_or_beyond(levels):
    result = solve_hierarchy(levels)
    for (A, lower, upper), active in zip(levels, result.active, strict=True):
        value = A @ result.x
        near = 1e-6 * (np.linalg.norm(A, axis=1) + np.abs(value))
        at = (value >= upper - near) | (value <= lower + near)
        assert (at | ~active).all()
