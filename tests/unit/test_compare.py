"""Resolvers compared: problems, indicators, tables and words."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.image import imread
from numpy.testing import assert_allclose

from sims.compare import page
from sims.compare.figures import marks
from sims.compare.indicators import measure, reference
from sims.compare.locking import PlainLocking
from sims.compare.problems import FAMILIES, Family, Problem, problems
from sims.compare.study import LOCKING, study
from sims.compare.switching import limit_jump, task_jump
from sims.compare.words import explain
from sims.report.datatable import as_html, as_text
from sims.resolvers import FIXED
from tests.tolerances import SAME
from wbc import (
    HierarchicalQP,
    NullSpace,
    Resolver,
    SolverError,
    Status,
    UnknownName,
    WeightedQP,
    resolve,
)
from wbc.resolver import Answer, Solver

SOUND = [NullSpace(), NullSpace("tsid"), HierarchicalQP()]
LIMITS = Family("limits", limits=0.5)
CONFLICT = Family("conflict", levels=4, conflict=0.8)


def some(family: Family, count: int = 5) -> list[Problem]:
    return list(problems(family, count, seed=3))


def judged(problem: Problem, resolver: Resolver):
    return measure(problem, resolver, reference(problem)[0], np.random.default_rng(0))


class Fixed(Resolver):
    """Always answers the same acceleration; None fails."""

    name = "fixed"

    def __init__(self, vdot, status: Status = Status.SOLVED) -> None:
        self.vdot, self.status = vdot, status

    def start(self, stack) -> Solver:
        fixed = self

        class Answering(Solver):
            def solve(self) -> Answer:
                if fixed.vdot is None:
                    raise SolverError("no")
                return Answer(fixed.vdot, np.zeros(len(stack.levels)), fixed.status)

        return Answering()


# --------------------------------------------------------------------------- problems


@pytest.mark.parametrize("family", FAMILIES, ids=[f.name for f in FAMILIES])
def test_problems_are_the_same_for_a_seed_and_others_for_another(family):
    one, same = (next(problems(family, 1, 7)) for _ in range(2))
    other = next(problems(family, 1, 8))
    for (A, lower, upper), (B, low, high) in zip(one.levels, same.levels, strict=True):
        np.testing.assert_array_equal(A, B)
        np.testing.assert_array_equal([lower, upper], [low, high])
    assert not np.array_equal(one.levels[-1][0], other.levels[-1][0])
    assert one.levels[-1][0].shape == (family.rows, family.axes)
    assert len(one.levels) == family.levels + (family.limits > 0.0)


def test_families_are_what_their_parameters_say():
    for problem in some(LIMITS):
        vdot, _ = reference(problem)
        assert np.isclose(np.abs(vdot), problem.levels[0][2]).any(), "limits are active"
    lost = conflicts = 0
    for problem in some(Family("singular", rows=3, singular=1.0)):
        lost += all(np.linalg.matrix_rank(A) == 2 for A, _, _ in problem.levels)
    for problem in some(CONFLICT):
        vdot, _ = reference(problem)
        missed = [np.linalg.norm(A @ vdot - b) for A, b, _ in problem.levels]
        conflicts += max(missed) > 0.1
    assert (lost, conflicts) == (5, 5)


def test_scaling_moves_targets_and_leaves_bounds():
    problem = some(LIMITS, 1)[0]
    half = problem.scaled(0.5)
    np.testing.assert_array_equal(half.levels[0][1], problem.levels[0][1])
    np.testing.assert_array_equal(half.levels[1][1], 0.5 * problem.levels[1][1])


def test_what_a_controller_resolved_is_a_problem_with_the_same_optimum():
    for problem in some(LIMITS, 2):
        solution = resolve(problem.state, problem.hierarchy())
        again = Problem.of(solution, problem.state)
        found = resolve(again.state, again.hierarchy()).acceleration
        assert_allclose(found, solution.acceleration, rtol=0, atol=SAME)


# ------------------------------------------------------------------------- indicators


@pytest.mark.parametrize("resolver", SOUND, ids=lambda r: r.name)
@pytest.mark.parametrize("family", [LIMITS, CONFLICT], ids=lambda f: f.name)
def test_sound_and_optimal_resolvers_are_found_to_be(resolver, family):
    for problem in some(family):
        found = judged(problem, resolver)
        assert found.leak <= SAME
        assert found.gap <= SAME
        assert found.violation <= SAME
        assert not found.failed
        assert found.seconds > 0.0


def test_a_weighted_sum_leaks_as_its_weights_say():
    leaks = [
        max(judged(p, WeightedQP(ratio)).leak for p in some(CONFLICT))
        for ratio in (1e2, 1e4)
    ]
    assert 1e-6 < leaks[1] < 0.1 * leaks[0]


def test_the_uf_is_sound_and_not_optimal_without_limits():
    for problem in some(Family("compatible")):
        found = judged(problem, NullSpace("uf"))
        assert found.leak <= SAME
        assert found.gap > 0.01


def test_plain_locking_keeps_limits_at_the_cost_of_optimality():
    found = [judged(problem, PlainLocking()) for problem in some(LIMITS)]
    assert max(f.violation for f in found) <= SAME
    assert max(f.gap for f in found) > 0.01
    free = [judged(problem, PlainLocking()) for problem in some(CONFLICT)]
    assert max(f.gap for f in free) <= SAME, "without limits it is WBCF"


def test_what_exceeds_limits_is_measured_against_them():
    problem = some(LIMITS, 1)[0]
    bound = problem.levels[0][2][0]
    found = judged(problem, Fixed(np.full(7, 2.0 * bound)))
    assert found.violation == pytest.approx(bound / (1.0 + 2.0 * bound))
    assert found.leak == 0.0


def test_efforts_are_those_of_the_answer():
    problem = some(LIMITS, 1)[0]
    vdot = np.arange(7.0)
    found = judged(problem, Fixed(vdot))
    M, h = problem.state.M, problem.state.h
    torque = M @ vdot - 0.0
    assert found.gauss == pytest.approx(torque @ np.linalg.solve(M, torque))
    assert found.acceleration == pytest.approx(np.linalg.norm(vdot))
    assert found.torque == pytest.approx(np.linalg.norm(M @ vdot + h))


def test_failures_are_counted_not_raised():
    problem = some(LIMITS, 1)[0]
    assert judged(problem, Fixed(None)).failed
    assert np.isnan(judged(problem, Fixed(None)).gap)
    assert judged(problem, Fixed(np.zeros(7), Status.INCOMPLETE)).failed


def test_the_optimum_is_continuous_at_limits_and_plain_locking_is_not():
    swept = some(LIMITS, 3)
    assert max(limit_jump(p, HierarchicalQP()) for p in swept) < 1e-6
    assert max(limit_jump(p, PlainLocking()) for p in swept) > 0.01


def test_a_level_that_does_nothing_goes_without_a_jump():
    problem = some(Family("compatible"), 1)[0]
    twice = Problem(problem.state, (*problem.levels, problem.levels[-1]))
    assert task_jump(twice, HierarchicalQP()) < SAME
    assert task_jump(problem, HierarchicalQP()) > 0.01


# -------------------------------------------------------------------- study and report


@pytest.fixture(scope="module")
def found():
    return study(seed=5, count=3, families=[Family("compatible"), LIMITS])


def test_a_study_has_a_finding_for_every_pair(found):
    assert found.resolvers == (*FIXED, LOCKING)
    assert len(found.findings) == 2 * len(found.resolvers)
    assert found.proof < SAME
    for finding in found.findings:
        assert np.isnan(finding.limit_jump) == (finding.family == "compatible")


def test_the_bars_hold_and_name_every_resolver(found):
    metrics = page.bars(found)
    assert [m.name for m in metrics if not m.holds] == [
        m.name for m in metrics if m.name == "weighted_gap_free_relative"
    ], "compatible tasks are all met by weights, too"
    names = " ".join(m.name for m in metrics)
    assert all(r.replace(":", "_") in names for r in found.resolvers)


def test_the_words_take_their_numbers_from_the_data(found):
    text = explain(found)
    assert f"{found.count} random stacks" in text
    assert f"locking {found.worst('gap', LOCKING, limits=True):.0e}" in text
    assert f"weighted {found.worst('leak', 'weighted'):.0e}" in text
    only = study(seed=5, count=2, names=["weighted"], families=[CONFLICT])
    assert "Optimal, limits active" not in explain(only)
    assert all("limits" not in metric.name for metric in page.bars(only))


def test_tables_have_a_row_a_resolver(found):
    for _, (head, *rows) in page.tables(found):
        assert [row[0] for row in rows] == list(found.resolvers)
        assert {len(row) for row in rows} == {len(head)}


def test_a_report_is_written(found, tmp_path):
    page.write(found, tmp_path)
    picture = imread(tmp_path / "picture.png")
    assert picture.shape[0] > 300
    assert picture.std() > 0.05  # [1], of a white sheet 0
    text = (tmp_path / "report.html").read_text()
    assert text.count("<svg") == 3
    assert "limits: 7 axes" in text
    assert (tmp_path / "metrics.json").exists()


def test_an_unknown_resolver_is_refused():
    with pytest.raises(UnknownName, match="Did you mean 'hqp'"):
        study(names=["hpq"])


def test_a_table_is_escaped_and_aligned():
    table = ("a < b", [["name", "x"], ["<i>", "1"], ["longer", "22"]])
    html = as_html(table)
    assert "a &lt; b" in html
    assert "&lt;i&gt;" in html
    assert "<i>" not in html
    lines = as_text(table).splitlines()
    assert lines == ["a < b", "name    x", "<i>     1", "longer  22"]


def test_marks_stand_on_the_floor_and_leave_gaps():
    svg = marks("t", ["a", "b"], {"one": [0.0, np.nan]}, "y [1]", floor=1e-9, bar=1e-3)
    assert svg.startswith("<svg")
    assert "bound 0.001" in svg
