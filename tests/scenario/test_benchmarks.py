"""The benchmark runs and prints every section; how fast anything is, it may say."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks.arm import arms_urdf
from benchmarks.cells import cell_resolvers
from benchmarks.endurance import drifting_ticks, endure, welding_ticks
from benchmarks.jobs import Job
from benchmarks.problems import arm_motion, random_problems, smooth_motion
from benchmarks.solvers import Daqp, Native
from benchmarks.stacks import STACKS
from benchmarks.tables import table
from benchmarks.workers.ours import open_loop
from sims.registry import cell_names
from sims.resolvers import resolver_names
from tests.tolerances import PROOF
from wbc import Robot, solve_hierarchy

ROOT = Path(__file__).parents[2]
GROWTH_MB = 8.0
RECORDED = 1500
"""Ticks: every probe and peg has touched by then."""
REPEATED = 1e-9
"""Torques of a replay against those of its run [Nm]: the same arithmetic twice."""


def run(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "benchmarks", *arguments],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
    )


@pytest.fixture(scope="module")
def quick():
    done = run("--quick", "--peers", "none")
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_quick_run_without_peers_prints_every_section(quick):
    titles = [line[4:] for line in quick.splitlines() if line.startswith("### ")]
    starts = ("Solver alone", "Solver along", "Tick: one arm")
    starts += tuple(f"Tick: {cell} cell" for cell in cell_names())
    starts += ("Breakdown", "Growth", "Start", "Endurance")
    assert all(any(t.startswith(start) for t in titles) for start in starts)
    assert "processor: " in quick
    assert all(f"| wbc {name} " in quick for name in resolver_names())
    assert "failed at tick" not in quick
    assert str(ROOT) not in quick


def test_every_resolver_gets_through_every_stack_of_every_cell(quick):
    tables = {
        title: [[cell.strip() for cell in row.split("|")] for row in rows]
        for title, *rows in map(str.splitlines, quick.split("### ")[1:])
    }
    for stack, size in STACKS.items():
        rows = tables[f"Tick: {stack.replace(':', ' cell,')}: {size}"]
        found = {row[1]: row for row in rows if row[1:] and row[1].startswith("wbc ")}
        assert set(found) == {f"wbc {name}" for name in cell_resolvers()}
        for row in found.values():
            assert 0.0 < float(row[2]) <= float(row[3])
            assert row[-2] == ""
    assert {stack.partition(":")[0] for stack in STACKS} == set(cell_names())


def test_every_stack_of_a_cell_has_its_line_in_the_summary(quick):
    summary = quick.partition("### Summary")[2]
    for stack, size in STACKS.items():
        assert f"| tick, {stack.replace(':', ' cell,')}: {size} " in summary


@pytest.mark.parametrize("stack", STACKS)
def test_the_replay_of_a_cell_is_the_run_that_was_recorded(stack):
    job = Job(stack, cell=stack, recorded=RECORDED)
    loop = open_loop(job, "hqp")
    axes, levels = map(int, re.findall(r"\d+", STACKS[stack]))
    controller = loop.contender.controller
    assert (controller.robot.nv, len(controller.hierarchy)) == (axes, levels)
    ticks, _ = loop.run(RECORDED + 1)
    report = loop.report()
    assert len(ticks) == report["ticks"] == len(loop.recorded) > 0
    assert report["failure"] == ""
    assert report["off_record_nm"] <= REPEATED


@pytest.mark.parametrize("stack", ["cutting: both arms", "contact: peg, insertion"])
def test_a_replay_without_its_wrenches_is_off_the_record(stack):
    loop = open_loop(Job(stack, cell=stack, recorded=RECORDED), "hqp")
    loop.recorded = [
        instant._replace(wrenches={name: np.zeros(6) for name in instant.wrenches})
        for instant in loop.recorded
    ]
    loop.run(RECORDED)
    assert loop.report()["off_record_nm"] > 1e-2


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
