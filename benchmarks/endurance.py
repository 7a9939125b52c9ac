"""Millions of ticks: does any fail, does memory grow, do proofs stay exact?

Half of the ticks are the welding cell's stacks in closed loop, from a new start every
`ROUND` ticks; the other half the solver alone on hierarchies that drift, with the
working set kept from tick to tick.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.jobs import Job
from benchmarks.problems import Array
from benchmarks.tables import table
from benchmarks.workers.ours import open_loop
from wbc.certificate import certify
from wbc.lexicographic import Lexicographic

__all__ = ["Endurance", "endurance_table", "endure"]

ROUND = 5000
"""Ticks from a start until the next."""
PROVEN_EVERY = 500
PAGE_MB = 4096 / 2**20


@dataclass
class Endurance:
    """What happened.

    Attributes:
        ticks: calls so far.
        failures: calls without an answer, or with one that is not finite.
        worst: residual of the worst certificate.
        early_mb: memory of the process after the first twentieth.
        late_mb: at the end.
    """

    ticks: int = 0
    failures: int = 0
    worst: float = 0.0
    early_mb: float = 0.0
    late_mb: float = 0.0


def endurance_table(ticks: int) -> str:
    """Run and report."""
    parts = {
        "welding stacks, closed loop": welding_ticks(ticks // 2),
        "random hierarchies, drifting": drifting_ticks(ticks - ticks // 2),
    }
    rows = []
    for name, steps in parts.items():
        found = endure(steps, ticks // 2)
        rows.append(
            [
                name,
                str(found.ticks),
                str(found.failures),
                f"{found.worst:.0e}",
                f"{found.early_mb:.1f}",
                f"{found.late_mb:.1f}",
            ]
        )
    head = ("ticks in a row", "number", "failed", "worst proof", "MB early", "MB end")
    return table("Endurance: warm-started, one process", head, rows)


def endure(steps: Iterator[tuple[bool, float]], ticks: int) -> Endurance:
    """Run all steps: (whether it went well, residual of its certificate or 0)."""
    found = Endurance()
    for good, proof in steps:
        found.ticks += 1
        found.failures += not good
        found.worst = max(found.worst, proof)
        if found.ticks == ticks // 20:
            found.early_mb = _memory()
        if found.ticks % 100_000 == 0:
            sys.stderr.write(f"\r{found.ticks} of {ticks} ticks ")
            sys.stderr.flush()
    sys.stderr.write("\r" + " " * 40 + "\r")
    found.late_mb = _memory()
    return found


def welding_ticks(ticks: int) -> Iterator[tuple[bool, float]]:
    """The cell's stacks in turn, on an ideal robot."""
    cells = ("welding: seam", "welding: curve")
    loops = [open_loop(Job(cell, cell=cell), "hqp") for cell in cells]
    starts = [loop.q.copy() for loop in loops]
    done = 0
    while done < ticks:
        turn = done // ROUND % len(loops)
        loop = loops[turn]
        loop.q, loop.v = starts[turn].copy(), np.zeros_like(loop.v)
        loop.done, loop.failure = 0, ""
        for _ in range(min(ROUND, ticks - done)):
            loop.run(1)
            done += 1
            solution = loop.contender.solution  # type: ignore[attr-defined]
            proven = done % PROVEN_EVERY == 0
            yield (
                solution.status.name == "SOLVED",
                solution.certificate().worst if proven else 0.0,
            )


def drifting_ticks(ticks: int) -> Iterator[tuple[bool, float]]:
    """Limits, equalities, inequalities and a posture whose bounds swing."""
    done, seed = 0, 0
    while done < ticks:
        rng = np.random.default_rng(seed)
        n = int(rng.integers(3, 15))
        sizes, A, middle, width = _drifting_rows(rng, n)
        swing, phase = rng.normal(size=middle.size), rng.uniform(0, 6.3, middle.size)
        solver, seed = Lexicographic(sizes, n), seed + 1
        for tick in range(min(ROUND, ticks - done)):
            now = middle + swing * np.sin(0.01 * tick + phase)
            lower, upper = now - width, now + width
            good = solver.solve(A, lower, upper) and bool(np.isfinite(solver.x).all())
            done += 1
            proof = 0.0
            if done % PROVEN_EVERY == 0:
                ends = np.cumsum(sizes)[:-1]
                parts = (np.split(part, ends) for part in (A, lower, upper))
                levels = list(zip(*parts, strict=True))
                proof = certify(levels, solver.x.copy()).worst
            yield good, proof


def _drifting_rows(
    rng: np.random.Generator, n: int
) -> tuple[list[int], Array, Array, Array]:
    """Sizes, unit rows, middles and half widths of five levels."""
    m = int(rng.integers(1, n + 1))
    sizes = [n, m, int(rng.integers(1, n + 1)), int(rng.integers(1, 4)), n]
    blocks = [rng.normal(size=(size, n)) for size in sizes]
    blocks[0] = np.eye(n)
    A = np.concatenate(blocks)
    width = np.concatenate(
        [np.full(n, 2.0), np.zeros(m), np.full(sizes[2], 0.2), np.zeros(sizes[3] + n)]
    )
    A = np.ascontiguousarray(A / np.linalg.norm(A, axis=1, keepdims=True))
    return sizes, A, rng.normal(size=width.size), width


def _memory() -> float:
    """Resident memory of this process [MB]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * PAGE_MB
