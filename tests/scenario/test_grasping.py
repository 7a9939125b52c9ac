"""Grasping as a whole, on two of its cylinders; `wbc run grasping` tries twelve."""

from __future__ import annotations

import pytest

from sims.demo import Options
from sims.grasping.demo import run_cases


@pytest.fixture(scope="module")
def outcome():
    return run_cases(Options(quiet=True, seed=1), count=3)


def failed(metrics):
    timed = {"realtime_factor"}  # the machine's, not the process's
    return [m for m in metrics if not m.holds and m.name not in timed]


def test_three_cylinders_are_grasped_carried_and_placed_within_every_bound(outcome):
    assert failed(outcome.metrics) == []


def test_so_they_are_by_projection_with_an_arm_that_differs_from_its_model():
    options = Options(resolver="nullspace", mismatch=True, quiet=True)
    assert failed(run_cases(options, count=2).metrics) == []


def test_the_report_draws_every_figure_and_the_replay_shows_every_cylinder(outcome):
    figures = outcome.figures()
    assert len(figures) >= 6
    assert all(svg.startswith("<svg") for _, svg in figures)
    page = outcome.replay()
    assert all(f"cylinder {index}" in page for index in range(3))
