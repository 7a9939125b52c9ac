"""One cold start: imports, loading, building, first tick, memory. Prints JSON."""

from __future__ import annotations

import importlib
import json
import resource
import sys
import time
from pathlib import Path

from benchmarks.jobs import Job

__all__ = ["measure"]

IMPORTS = {
    "ours": ("wbc", "tasks"),
    "placo": ("placo",),
    "tsid": ("pinocchio", "tsid.tsid_pywrap"),
}


def measure(name: str, job: Job, kind: str) -> dict[str, float]:
    """Times [s] and memory [MB] of a fresh process."""
    found = {"bare_mb": _memory()}
    began = time.perf_counter()
    for module in IMPORTS[name]:
        importlib.import_module(module)
    found["import_s"] = time.perf_counter() - began
    found["imported_mb"] = _memory()
    worker = importlib.import_module(f"benchmarks.workers.{name}")
    began = time.perf_counter()
    loop = worker.open_loop(job, kind)
    found["build_s"] = time.perf_counter() - began
    ticks, _ = loop.run(200)
    found["first_s"], found["second_s"] = ticks[0] * 1e-9, ticks[1] * 1e-9
    found["ran_mb"] = _memory()
    return found


def _memory() -> float:
    """Resident memory of this process [MB]; NaN where the system does not tell."""
    pages = Path("/proc/self/statm")
    if not pages.is_file():
        return float("nan")
    return int(pages.read_text().split()[1]) * resource.getpagesize() / 2**20


if __name__ == "__main__":
    name, kind, fields = sys.argv[1:]
    print(json.dumps(measure(name, Job.from_dict(json.loads(fields)), kind)))
