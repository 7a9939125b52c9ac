"""Section (a): the solvers alone, cold, warm, and along a motion."""

from __future__ import annotations

import gc
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from benchmarks.problems import (
    Array,
    Problem,
    arm_motion,
    random_problems,
    smooth_motion,
)
from benchmarks.solvers import BASELINE, OURS, Failed, Solver, contenders
from benchmarks.summary import Summary
from benchmarks.tables import late, median, micro, ratio, table
from wbc import solve_hierarchy

__all__ = ["solver_tables"]

SIZES = (7, 14, 30, 50)
OFF = 1e-6
"""Beyond this relative distance from the optimum, an answer counts as off."""
SLOW = 1.5
"""Time [s] after which a solver sits out further rounds of a size."""


@dataclass
class Times:
    """What was measured of one solver.

    Attributes:
        cold: without memory of the last call [ns].
        warm: the same problem again, or the next one along a motion [ns].
        failed: calls without an answer.
        errors: relative distances from the optimum.
        spent: on timed calls [s].
        checked: on calls whose answers were compared [s].
    """

    cold: list[int] = field(default_factory=list)
    warm: list[int] = field(default_factory=list)
    failed: int = 0
    errors: list[float] = field(default_factory=list)
    spent: float = 0.0
    checked: float = 0.0


def solver_tables(quick: bool, folder: Path, summary: Summary) -> Iterator[str]:
    """Tables of random problems and of motions, one size at a time."""
    sizes = SIZES[:2] if quick else SIZES
    yield _random_table(sizes, quick, summary)
    ticks = 60 if quick else 400
    motions = {"arm, n = 7": arm_motion(1, ticks, folder)}
    if not quick:
        motions["two arms, n = 14"] = arm_motion(2, ticks, folder)
        motions |= {f"smooth, n = {n}": smooth_motion(n, ticks) for n in sizes}
    yield _motion_table(motions, quick, summary)


def _random_table(sizes: tuple[int, ...], quick: bool, summary: Summary) -> str:
    rows = []
    for n in sizes:
        problems = random_problems(n, 8 if quick else 20)
        times, worst = _cold_and_warm(problems, 3 if quick else 60, not quick)
        base = times.get(BASELINE, Times())
        ours, daqp = times[OURS], {"daqp": base.cold}
        summary.add(f"solver, cold, n = {n}", ours.cold, daqp)
        summary.add(f"solver, same problem again, n = {n}", ours.warm, daqp)
        for name, one in times.items():
            rows.append(
                [
                    f"n = {n}: {name}",
                    *_pair(one.cold),
                    ratio(median(one.cold), median(base.cold)),
                    *_pair(one.warm),
                    ratio(median(one.warm), median(base.cold)),
                    *_accuracy(one, worst if name == OURS else None),
                ]
            )
    head = (
        "solver", "cold median us", "p99", "/ DAQP", "warm median us", "p99",
        "/ DAQP", "failed", f"off > {OFF:g}", "worst error", "certificate",
    )  # fmt: skip
    title = "Solver alone: 20 random hierarchies a size, 3 to 6 levels, half conflict"
    return table(title.replace("20", "8") if quick else title, head, rows)


def _motion_table(
    motions: dict[str, list[Problem]], quick: bool, summary: Summary
) -> str:
    rows = []
    for name, problems in motions.items():
        times, worst = _along(problems, 2 if quick else 10, not quick)
        base = times.get(BASELINE, Times())
        summary.add(f"solver along {name}", times[OURS].warm, {"daqp": base.warm})
        for solver, one in times.items():
            rows.append(
                [
                    f"{name}: {solver}",
                    *_pair(one.warm),
                    ratio(median(one.warm), median(base.warm)),
                    *_accuracy(one, worst if solver == OURS else None),
                ]
            )
    head = (
        "solver", "median us", "p99", "/ DAQP", "failed", f"off > {OFF:g}",
        "worst error", "certificate",
    )  # fmt: skip
    ticks = len(next(iter(motions.values())))
    title = f"Solver along motions: {ticks} ticks 5 ms apart, 5 levels, limits switch"
    return table(title, head, rows)


def _pair(times: list[int]) -> tuple[str, str]:
    return micro(median(times)), micro(late(times))


def _accuracy(one: Times, certificate: float | None) -> tuple[str, ...]:
    errors = np.array(one.errors or [np.nan])
    return (
        str(one.failed),
        str(int(np.sum(errors > OFF))),
        f"{np.max(errors):.0e}",
        "" if certificate is None else f"{certificate:.0e}",
    )


def _cold_and_warm(
    problems: list[Problem], rounds: int, cascades: bool
) -> tuple[dict[str, Times], float]:
    """All solvers in turn on every problem, round by round."""
    prepared = [(p, contenders(p, cascades=cascades)) for p in problems]
    times = {solver.name: Times() for solver in prepared[0][1]}
    optima, worst = _optima(problems)
    for (problem, solvers), optimum in zip(prepared, optima, strict=True):
        for solver in solvers:
            _judge(solver, problem, optimum, times[solver.name])
    with _undisturbed():
        for _ in range(rounds):
            for problem, solvers in prepared:
                for solver in solvers:
                    one = times[solver.name]
                    if one.spent < SLOW:
                        solver.reset()
                        # Caches, after the others: with the very work that is timed.
                        _time(solver, problem, one, [])
                        solver.reset()
                        _time(solver, problem, one, one.cold)
                        if solver.remembers:
                            _time(solver, problem, one, one.warm)
    return times, worst


def _along(
    problems: list[Problem], rounds: int, cascades: bool
) -> tuple[dict[str, Times], float]:
    """All solvers in turn through the motion, each with its memory of the last tick."""
    solvers = contenders(problems[0], cascades=cascades)
    times = {solver.name: Times() for solver in solvers}
    optima, worst = _optima(problems)
    for problem, optimum in zip(problems, optima, strict=True):
        for solver in solvers:
            if times[solver.name].checked < SLOW:
                _judge(solver, problem, optimum, times[solver.name])
    with _undisturbed():
        for _ in range(rounds):
            for solver in solvers:
                one = times[solver.name]
                if one.spent < SLOW:
                    _time(solver, problems[0], one, [])  # caches, after the others
                    for problem in problems:
                        _time(solver, problem, one, one.warm)
    return times, worst


def _optima(problems: list[Problem]) -> tuple[list[Array], float]:
    """Certified minimisers, and the worst residual of their certificates."""
    found = [solve_hierarchy(problem.levels()) for problem in problems]
    worst = max(result.certificate().worst for result in found)
    return [result.x for result in found], worst


def _judge(solver: Solver, problem: Problem, optimum: Array, one: Times) -> None:
    """An untimed call, which also warms caches; how far is its answer off?"""
    began = time.perf_counter()
    try:
        x = solver.solve(problem)
        size = 1.0 + float(np.max(np.abs(optimum)))
        one.errors.append(float(np.max(np.abs(x - optimum))) / size)
    except Failed:
        one.failed += 1
    one.checked += time.perf_counter() - began


def _time(solver: Solver, problem: Problem, one: Times, into: list[int]) -> None:
    clock = time.perf_counter_ns
    began = clock()
    try:
        solver.solve(problem)
    except Failed:
        one.spent += 1e-9 * (clock() - began)
        return
    spent = clock() - began
    into.append(spent)
    one.spent += 1e-9 * spent


@contextmanager
def _undisturbed() -> Iterator[None]:
    gc.collect()
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
