"""Section (d): import time, first tick, memory; a fresh process each time."""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

from benchmarks.jobs import Job
from benchmarks.pipes import ROOT, environment
from benchmarks.tables import table
from benchmarks.ticks import arm_job

__all__ = ["start_table"]

COLUMNS = {
    "import s": ("import_s", 1, 2),
    "build ms": ("build_s", 1e3, 1),
    "first tick ms": ("first_s", 1e3, 2),
    "second tick ms": ("second_s", 1e3, 3),
    "bare Python MB": ("bare_mb", 1, 0),
    "imported MB": ("imported_mb", 1, 0),
    "after 200 ticks MB": ("ran_mb", 1, 0),
}


def start_table(pythons: Mapping[str, Path], quick: bool, folder: Path) -> str:
    """Medians over fresh processes, contenders in turn."""
    job = arm_job("start", 1, folder)
    everyone = {"ours": Path(sys.executable), **pythons}
    found: dict[str, list[dict[str, float]]] = {name: [] for name in everyone}
    for _ in range(1 if quick else 5):
        for name, python in everyone.items():
            found[name] += _fresh(name, python, job, environment())
    rows = [
        _row("wbc hqp" if name == "ours" else name, times)
        for name, times in found.items()
    ]
    if not quick:
        rows.insert(1, _row("wbc hqp, very first use", _very_first(job)))
    title = "Start: fresh processes, one arm (very first use: nothing compiled yet)"
    return table(title, ("contender", *COLUMNS), rows)


def _very_first(job: Job) -> list[dict[str, float]]:
    """With an empty cache of compiled code, as right after an installation."""
    with tempfile.TemporaryDirectory() as empty:
        variables = environment() | {"NUMBA_CACHE_DIR": empty}
        return _fresh("ours", Path(sys.executable), job, variables)


def _fresh(
    name: str, python: Path, job: Job, variables: Mapping[str, str]
) -> list[dict[str, float]]:
    """What one fresh process measured; nothing, and a word why, if it failed."""
    command = [str(python), "-m", "benchmarks.workers.start", name, "hqp"]
    done = subprocess.run(
        [*command, job.to_json()],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env=dict(variables),
    )
    if done.returncode:
        print(f"{name}: {done.stderr.strip().splitlines()[-1]}", file=sys.stderr)
        return []
    return [json.loads(done.stdout.splitlines()[-1])]


def _row(name: str, times: list[dict[str, float]]) -> list[str]:
    if not times:
        return [name, "failed", *[""] * (len(COLUMNS) - 1)]
    cells = [
        f"{scale * statistics.median(one[key] for one in times):.{digits}f}"
        for key, scale, digits in COLUMNS.values()
    ]
    return [name, *cells]
