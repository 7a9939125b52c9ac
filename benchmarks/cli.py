"""The command line: sections, peers, and the order in which things are printed."""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path

from benchmarks.alone import solver_tables
from benchmarks.breakdown import breakdown_table
from benchmarks.cells import cell_tables
from benchmarks.endurance import endurance_table
from benchmarks.environments import PEERS, NotAvailable, default_cache, prepare
from benchmarks.growth import growth_table
from benchmarks.machine import describe
from benchmarks.pipes import Worker, WorkerError
from benchmarks.start import start_table
from benchmarks.summary import Summary
from benchmarks.ticks import tick_tables
from sims.resolvers import resolver_names

__all__ = ["main"]

LEGEND = """\
Python call to Python return, garbage collector off; medians and 99th percentiles [us].
"off", "worst error": answers against the optimum, which is ours with its certificate
(worst KKT residual of all levels); relative to the size of x. DAQP has no warm start.
A tick goes from (q, v) to the torques; moving the references is timed apart. Peers
weigh pose and posture in one QP, whatever levels we have. "dynamics": tau against
RNEA(q, v, dv). "saturated": ticks with a torque at its limit.
Cells: what the controller saw in a simulated run under hqp is replayed through every
resolver. "off record": torques against those of the run; hqp must repeat its own.
"""
SECTIONS = ("solver", "tick", "cells", "growth", "start", "endurance")
VARIANTS = ("nullspace:tsid", "nullspace:uf")
"""Resolvers that cost what "nullspace" does."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the tables as they are measured; 0."""
    options = _options(arguments)
    with tempfile.TemporaryDirectory() as folder, ExitStack() as cleaning:
        pythons = _peers(options, cleaning)
        workers = [Worker(name, python) for name, python in pythons.items()]
        ours = Worker("ours", sys.executable)
        for worker in (ours, *workers):
            cleaning.callback(worker.stop)
        peers = {w.name: w.ask("about")["versions"] for w in workers}
        print(describe(peers), LEGEND, sep="\n", flush=True)
        summary = Summary()
        for text in _sections(options, ours, workers, pythons, Path(folder), summary):
            print(text, flush=True)
        if summary.rows:
            print(summary.table(), flush=True)
    return 0


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks",
        description="How fast are solver and tick, beside others in the same run?",
    )
    parser.add_argument(
        "--quick", action="store_true", help="everything, short: no figures"
    )
    parser.add_argument("--only", choices=SECTIONS, help="one section")
    parser.add_argument(
        "--peers", default=",".join(PEERS), help=f"none, or some of {','.join(PEERS)}"
    )
    parser.add_argument(
        "--cache", type=Path, default=default_cache(), help="folder of the peers"
    )
    parser.add_argument(
        "--ticks", type=int, default=0, metavar="N", help="of the section endurance"
    )
    options = parser.parse_args(arguments)
    options.peers = [] if options.peers == "none" else options.peers.split(",")
    unknown = [name for name in options.peers if name not in PEERS]
    if unknown:
        parser.error(f"unknown peer '{unknown[0]}': none, or some of {list(PEERS)}")
    return options


def _peers(options: argparse.Namespace, cleaning: ExitStack) -> dict[str, Path]:
    """Interpreters of the peers that can be had and that start."""
    pythons: dict[str, Path] = {}
    needed = options.only in (None, "tick", "start")
    for name in options.peers if needed else []:
        try:
            python = prepare(name, options.cache.expanduser().resolve())
            trial = Worker(name, python)
            cleaning.callback(trial.stop)
            trial.ask("about")
            pythons[name] = python
        except (NotAvailable, WorkerError) as error:
            print(f"not available: {error}", flush=True)
    return pythons


def _sections(
    options: argparse.Namespace,
    ours: Worker,
    workers: Sequence[Worker],
    pythons: dict[str, Path],
    folder: Path,
    summary: Summary,
) -> Iterator[str]:
    wanted = SECTIONS if options.only is None else (options.only,)
    quick = options.quick
    if "solver" in wanted:
        yield from solver_tables(quick, folder, summary)
    if "tick" in wanted:
        names = [name for name in resolver_names() if name not in VARIANTS]
        yield from tick_tables(ours, workers, names, quick, folder, summary)
        yield breakdown_table(quick, folder)
    if "cells" in wanted:
        yield from cell_tables(ours, quick, summary)
    if "growth" in wanted:
        yield growth_table(ours, quick, folder)
    if "start" in wanted:
        yield start_table(pythons, quick, folder)
    if "endurance" in wanted:
        yield endurance_table(options.ticks or (20_000 if quick else 200_000))
