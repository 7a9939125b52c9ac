"""Peg and crank as a whole, with few tries; `wbc run contact` makes many."""

from __future__ import annotations

import pytest

from sims.contact.demo import run_jobs
from sims.demo import Options


@pytest.fixture(scope="module")
def outcome():
    return run_jobs(Options(quiet=True), pegs=2, cranks=1)


def failed(metrics):
    timed = {"realtime_factor"}  # the machine's, not the process's
    return [m for m in metrics if not m.holds and m.name not in timed]


def test_pegs_find_their_holes_and_a_crank_turns_within_every_bound(outcome):
    assert failed(outcome.metrics) == []


def test_pegs_do_so_by_projection_with_an_arm_that_differs_from_its_model():
    options = Options(resolver="nullspace", mismatch=True, quiet=True, seed=4)
    assert failed(run_jobs(options, pegs=2, cranks=0).metrics) == []


def test_the_report_draws_every_figure_and_the_replay_every_phase(outcome):
    figures = outcome.figures()
    assert len(figures) == 5
    assert all(svg.startswith("<svg") for _, svg in figures)
    page = outcome.replay()
    assert "peg 1 insertion" in page
    assert "crank 1" in page
