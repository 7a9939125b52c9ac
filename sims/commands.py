"""What the commands do, once their arguments are known."""

from __future__ import annotations

import platform
import sys
import time
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

import numpy as np

from sims.audit import audit
from sims.benchmark import measure
from sims.demo import Demo, Options, Outcome
from sims.metrics import Metric, format_value, table, to_json, verdict
from sims.registry import cell_names, find_demo
from sims.report.page import write_report
from sims.report.snapshot import NoDisplay, write_png
from sims.resolvers import make_resolver
from wbc import InputError, UnknownName

__all__ = ["audit_model", "bench", "compare", "list_cells", "run_cell"]

RESOLVERS = ("hqp", "nullspace", "weighted")
"""What is compared where nothing is named."""
PACKAGES = ("wbc", "pin", "mujoco", "numba", "proxsuite", "qpsolvers", "numpy", "scipy")


def list_cells() -> int:
    """Print every cell with one line about it."""
    for name in cell_names():
        print(f"{name:<12} {find_demo(name).about}")
    return 0


def run_cell(name: str, options: Options, out: str | None) -> int:
    """Run a cell, print its metrics, and write them where asked."""
    demo = find_demo(name)
    make_resolver(options.resolver)
    if options.experiment and options.experiment not in demo.experiments:
        raise UnknownName("experiment", options.experiment, demo.experiments)
    folder = None if out is None else _folder(out)
    began = time.perf_counter()
    outcome = demo.run(options)
    print(table(outcome.metrics))
    print(f"\n{verdict(outcome.metrics)} ({time.perf_counter() - began:.0f} s)")
    if folder is not None:
        _write(folder, f"{name}: {demo.about}", options, outcome)
    return 0 if all(metric.holds for metric in outcome.metrics) else 1


def compare(
    name: str, resolvers: list[str] | None, options: Options, out: str | None
) -> int:
    """Run a cell in several ways and print their metrics side by side.

    The ways are resolvers; without any named, a cell's experiments if it has some.
    """
    demo = find_demo(name)
    ways = _ways(demo, resolvers, options)
    folder = None if out is None else _folder(out)
    outcomes: dict[str, Outcome] = {}
    for way, chosen in ways.items():
        outcomes[way] = demo.run(chosen)
        if folder is not None:
            inner = _folder(str(folder / way.replace(":", "-")))
            _write(inner, f"{name} under {way}", chosen, outcomes[way])
    print(_side_by_side({way: o.metrics for way, o in outcomes.items()}))
    return 0


def _ways(
    demo: Demo, resolvers: list[str] | None, options: Options
) -> dict[str, Options]:
    if resolvers is None and demo.experiments:
        return {name: replace(options, experiment=name) for name in demo.experiments}
    names = list(RESOLVERS) if resolvers is None else resolvers
    for name in names:
        make_resolver(name)
    return {name: replace(options, resolver=name) for name in names}


def _side_by_side(columns: dict[str, list[Metric]]) -> str:
    names = list(dict.fromkeys(m.name for metrics in columns.values() for m in metrics))
    found = {r: {m.name: m for m in metrics} for r, metrics in columns.items()}
    rows = [["metric", *columns, "bound"]]
    for name in names:
        cells, limit = [], ""
        for metrics in found.values():
            metric = metrics.get(name)
            cells.append("-" if metric is None else _mark(metric))
            limit = limit or ("" if metric is None else metric.limit)
        rows.append([name, *cells, limit])
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return "\n".join(
        "  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)).rstrip()
        for row in rows
    )


def _mark(metric: Metric) -> str:
    return format_value(metric.value) + ("" if metric.holds else " FAIL")


def bench(ticks: int) -> int:
    """Print the speed table."""
    print(measure(ticks))
    return 0


def audit_model(path: str) -> int:
    """Print where Pinocchio and MuJoCo disagree about a model."""
    result = audit(path)
    print(result.text())
    return 0 if result.agrees else 1


def _folder(out: str) -> Path:
    folder = Path(out)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"--out {out}: {error.strerror or error}") from error
    return folder


def _write(folder: Path, title: str, options: Options, outcome: Outcome) -> None:
    (folder / "metrics.json").write_text(to_json(outcome.metrics), encoding="utf-8")
    np.savez_compressed(folder / "log.npz", **outcome.series)
    facts = {
        "resolver": options.resolver,
        "mismatch": "yes" if options.mismatch else "no",
        "seed": str(options.seed),
        **outcome.facts,
        "versions": ", ".join(f"{p} {version(p)}" for p in PACKAGES),
        "python": platform.python_version(),
    }
    write_report(
        folder / "report.html",
        title=title,
        summary="Metrics from the simulator's truth, each against its bound.",
        metrics=outcome.metrics,
        figures=outcome.figures(),
        replay_html=outcome.replay(),
        facts=facts,
    )
    written = ["metrics.json", "log.npz", "report.html"]
    try:
        write_png(folder / "picture.png", outcome.picture())
        written.append("picture.png")
    except NoDisplay as error:
        sys.stderr.write(f"wbc: {error}\n")
    print(f"wrote {', '.join(written)} to {folder}")
