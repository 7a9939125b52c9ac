"""The benchmark runs and prints every section; how fast anything is, it may say."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks.arm import arms_urdf
from benchmarks.endurance import drifting_ticks, endure, welding_ticks
from benchmarks.problems import arm_motion, random_problems, smooth_motion
from benchmarks.solvers import Daqp, Native
from benchmarks.tables import table
from sims.resolvers import resolver_names
from tests.tolerances import PROOF
from wbc import Robot, solve_hierarchy

ROOT = Path(__file__).parents[2]
GROWTH_MB = 8.0


def run(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "benchmarks", *arguments],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
    )


def test_quick_run_without_peers_prints_every_section():
    done = run("--quick", "--peers", "none")
    assert done.returncode == 0, done.stderr
    titles = [line[4:] for line in done.stdout.splitlines() if line.startswith("### ")]
    starts = ("Solver alone", "Solver along", "Tick: one arm", "Tick: welding")
    starts += ("Breakdown", "Growth", "Start", "Endurance")
    assert all(any(t.startswith(start) for t in titles) for start in starts)
    assert "processor: " in done.stdout
    untold = {"nullspace:tsid", "nullspace:uf"}
    names = set(resolver_names()) - untold
    assert all(f"| wbc {name} " in done.stdout for name in names)
    assert "failed at tick" not in done.stdout
    assert str(ROOT) not in done.stdout


@pytest.mark.parametrize("ticks_of", [welding_ticks, drifting_ticks])
def test_thousands_of_warm_ticks_neither_fail_nor_grow(ticks_of):
    found = endure(ticks_of(8000), 8000)
    assert found.ticks == 8000
    assert found.failures == 0
    assert found.worst <= PROOF
    assert found.late_mb - found.early_mb < GROWTH_MB


@pytest.mark.parametrize(
    "arguments", [["--peers", "nobody"], ["--only", "lunch"], ["--ticks"]]
)
def test_bad_usage_exits_2(arguments):
    done = run(*arguments)
    assert done.returncode == 2
    assert "usage" in done.stderr


@pytest.mark.parametrize("n", [7, 14])
def test_random_problems_are_the_same_every_time_and_have_unit_rows(n):
    first, again = random_problems(n), random_problems(n)
    for a, b in zip(first, again, strict=True):
        np.testing.assert_array_equal(a.A, b.A)
        np.testing.assert_array_equal(a.upper, b.upper)
        np.testing.assert_allclose(np.linalg.norm(a.A, axis=1), 1.0, atol=1e-12)
    assert {len(problem.sizes) for problem in first} == {3, 4, 5, 6}


def test_half_of_the_random_problems_conflict():
    slack = [
        max(np.abs(s).max() for s in solve_hierarchy(p.levels()).slacks[1:-1])
        for p in random_problems(14)
    ]
    assert max(slack[:10]) < 1e-9 < 1e-3 < min(slack[10:])


def test_limits_come_and_go_along_the_motions(tmp_path):
    for motion in (smooth_motion(7, 200), arm_motion(1, 200, tmp_path)):
        active = [int(solve_hierarchy(p.levels()).active[0].sum()) for p in motion]
        assert min(active) < max(active)


def test_adapters_agree_on_a_problem_that_both_solve():
    problem = random_problems(7)[0]
    np.testing.assert_allclose(
        Native(problem).solve(problem), Daqp(problem).solve(problem), atol=1e-5
    )


@pytest.mark.parametrize("count", [1, 2])
def test_the_arms_are_one_robot_that_can_hold_itself(count, tmp_path):
    arm = arms_urdf(count)
    (tmp_path / "arms.urdf").write_text(arm.urdf)
    robot = Robot.from_urdf(tmp_path / "arms.urdf", q_home=arm.home)
    assert robot.nv == 7 * count
    assert set(arm.tips) <= set(robot.frames)
    assert (np.abs(robot.state(robot.q_home).gravity()) < 0.3 * robot.tau_max).all()


def test_a_table_keeps_its_columns():
    text = table("Title", ("a", "long head"), [("x", "1"), ("yy", "22")])
    assert text.splitlines()[2:] == [
        "| a  | long head |",
        "|:---|----------:|",
        "| x  |         1 |",
        "| yy |        22 |",
    ]
