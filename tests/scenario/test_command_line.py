"""The command line: what it writes, and how it ends."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import numpy as np
import pytest

from robots import racer
from sims.cli import main
from sims.demo import Options
from sims.registry import cell_names, find_demo
from sims.resolvers import resolver_names

SHARED = (
    "ticks",
    "tick_median_us",
    "tick_p99_us",
    "realtime_factor",
    "solver_failures",
    "torque_limit_violation_nm",
    "joint_limit_violation_rad",
)
SHORT = ["--duration", "0.05", "--quiet"]


def test_list_names_every_cell_with_a_line_about_it(capsys):
    assert main(["list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == cell_names()
    assert all(len(line.split()) > 3 for line in lines)


@pytest.mark.parametrize("mismatch", [False, True], ids=["nominal", "mismatch"])
@pytest.mark.parametrize("resolver", ["hqp", "nullspace"])
def test_welding_keeps_every_bound(resolver, mismatch):
    options = Options(resolver=resolver, mismatch=mismatch, quiet=True)
    metrics = find_demo("welding").run(options).metrics
    timed = {"realtime_factor"}  # the machine's, not the process's
    failed = [m for m in metrics if not m.holds and m.name not in timed]
    assert failed == []
    assert set(SHARED) <= {m.name for m in metrics}


@pytest.mark.parametrize("resolver", resolver_names())
@pytest.mark.parametrize("cell", cell_names())
def test_every_cell_runs_under_every_resolver(cell, resolver, capsys):
    assert main(["run", cell, "--resolver", resolver, *SHORT]) in (0, 1)
    printed = capsys.readouterr().out
    assert "solver_failures" in printed
    assert "worst_certificate_residual" in printed or not resolver.startswith("hqp")


def test_run_writes_metrics_log_and_a_self_contained_report(tmp_path, capsys):
    code = main(["run", "welding", "--out", str(tmp_path / "out"), *SHORT])
    assert code == 1  # so short a run leaves no seam to measure
    written = tmp_path / "out"
    metrics = json.loads((written / "metrics.json").read_text())
    assert set(SHARED) <= set(metrics)
    assert metrics["seam_speed_rms_error_m_s"] is None
    with np.load(written / "log.npz") as log:
        assert log["point/q"].shape == (50, 6)
        assert np.isfinite(log["seam/torque"]).all()
    page = (written / "report.html").read_text()
    assert "seam_lateral_error_max_m" in page
    printed = capsys.readouterr().out
    (line,) = (x for x in printed.splitlines() if "seam_speed_rms_error_m_s" in x)
    assert line.split()[1] == "-"
    assert line.endswith("not measured")
    assert "nan" not in printed
    assert "not measured" in page


def test_the_same_seed_gives_the_same_run():
    options = Options(duration=0.05, mismatch=True, seed=5, quiet=True)
    runs = [find_demo("welding").run(options).series for _ in range(2)]
    assert all(np.array_equal(runs[0][k], runs[1][k]) for k in runs[0] if "/q" in k)


def test_compare_prints_the_resolvers_side_by_side(capsys):
    assert main(["compare", "welding", "--resolvers", "hqp,nullspace", *SHORT]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["metric", "hqp", "nullspace", "bound"]
    assert any(line.startswith("point_tip_error_max_m") for line in lines)


def test_bench_prints_a_row_for_every_resolver(capsys):
    assert main(["bench", "--ticks", "3"]) == 0
    printed = capsys.readouterr().out
    assert all(f" {name} " in printed for name in resolver_names())


def test_audit_of_the_racer_finds_agreement(tmp_path, capsys):
    path = tmp_path / "racer.xml"
    path.write_text(racer.mjcf())
    assert main(["audit", str(path)]) == 0
    assert "joint-space inertia" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["run", "wielding"], "Did you mean 'welding'?"),
        (["run", "welding", "--resolver", "hpq"], "Did you mean 'hqp'?"),
        (["run", "welding", "--resolver", "hqp:nothing"], "Valid names"),
        (["compare", "welding", "--resolvers", "hqp,none"], "unknown resolver 'none'"),
        (["audit", "no/such/file.xml"], "no/such/file.xml"),
        (["run", "welding", "--out", "/dev/null/x", *SHORT], "--out /dev/null/x"),
        (["run", "welding", "--combined"], "--combined has no effect on 'welding'"),
        (["compare", "contact", "--combined"], "only on: cutting."),
        (["run", "contact", "--experiment", "local"], "only on: cutting."),
        (["run", "cutting", "--experiment", "global"], "unknown experiment 'global'"),
        (["compare", "random", "--duration", "1"], "--duration has no effect on"),
        (["compare", "transitions", "--mismatch"], "only on: cutting, welding, cons"),
        (["compare", "random", "--combined"], "--combined has no effect on 'random'"),
    ],
)
def test_bad_usage_is_one_line_and_exit_code_2(arguments, word, capsys):
    assert main(arguments) == 2
    error = capsys.readouterr().err
    assert word in error
    assert len(error.splitlines()) == 1


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["run"],
        ["fly"],
        ["run", "welding", "--duration", "-1"],
        ["bench", "--ticks", "x"],
    ],
)
def test_a_malformed_command_line_exits_2(arguments, capsys):
    with pytest.raises(SystemExit) as ended:
        main(arguments)
    assert ended.value.code == 2
    assert "usage" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("command", "word"),
    [("run", "1 if one does not"), ("compare", "0 once all runs are done")],
)
def test_help_says_what_the_exit_code_means(command, word, capsys):
    with pytest.raises(SystemExit):
        main([command, "--help"])
    printed = " ".join(capsys.readouterr().out.split())
    assert f"Exit code: {'' if command == 'run' else 'for a cell '}0" in printed
    assert word in printed


def test_view_without_a_display_says_so_and_goes_on(monkeypatch, capsys):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert main(["run", "welding", "--view", *SHORT]) == 1
    assert "headless" in capsys.readouterr().err


def test_nobody_reading_ends_a_command_without_a_trace():
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        [sys.executable, "-m", "sims.cli", "list"],
        stdout=write,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    os.close(write)
    assert (done.returncode, done.stderr) == (141, "")
