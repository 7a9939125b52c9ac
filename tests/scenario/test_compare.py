"""The comparisons of the command line, from the command to the report."""

from __future__ import annotations

import json

import pytest

from sims.cli import main


def test_random_stacks_keep_every_bar(tmp_path, capsys):
    assert main(["compare", "random", "--seed", "0", "--out", str(tmp_path)]) == 0
    printed = capsys.readouterr().out
    assert "all 15 bounds hold" in printed
    metrics = json.loads((tmp_path / "metrics.json").read_text())
    for name in ("nullspace", "nullspace_tsid", "hqp"):
        assert metrics[f"{name}_leak_relative"] < 1e-8
    assert metrics["weighted_leak_relative"] > 1e-3
    assert metrics["nullspace_uf_gap_free_relative"] > 0.1
    assert "<svg" in (tmp_path / "report.html").read_text()


def test_changes_stay_below_the_rate_that_stops_an_arm(tmp_path, capsys):
    assert main(["compare", "transitions", "--out", str(tmp_path)]) == 0
    assert "priorities swapped" in capsys.readouterr().out
    metrics = json.loads((tmp_path / "metrics.json").read_text())
    for family in ("hqp", "nullspace"):
        assert metrics[f"{family}_ramped_torque_rate_max_nm_s"] < 1000.0
        assert metrics[f"{family}_at_once_torque_rate_max_nm_s"] > 10_000.0
    assert "Largest torque rates" in (tmp_path / "report.html").read_text()


@pytest.mark.parametrize("cell", ["welding", "constraints"])
def test_a_cell_is_sampled_along_its_runs(cell, tmp_path, capsys):
    names = "hqp,nullspace:uf"
    short = ["--duration", "0.05", "--quiet", "--out", str(tmp_path)]
    assert main(["compare", cell, "--resolvers", names, *short]) == 0
    printed = capsys.readouterr().out
    leak, gap = (
        next(line.split()[1:3] for line in printed.splitlines() if line.startswith(key))
        for key in ("leak_max_relative", "optimality_gap_max_relative")
    )
    assert float(leak[0]) < 1e-8
    assert float(gap[0]) < 1e-8
    assert float(gap[1]) > 1e-3, "the UF is not optimal on any real stack"
    assert "what strictness cost, mean of the samples under hqp" in printed
    page = (tmp_path / "report.html").read_text()
    assert "leak_max_relative" in page
    assert "what strictness cost, mean of the samples under nullspace:uf" in page
    assert "Optimal here: hqp" in page


def test_an_unknown_study_lists_cells_and_studies(capsys):
    assert main(["compare", "randm"]) == 2
    assert "Did you mean 'random'?" in capsys.readouterr().err
