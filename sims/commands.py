"""What the commands do, once their arguments are known."""

from __future__ import annotations

import io
import platform
import sys
import time
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

import numpy as np

from sims.audit import audit
from sims.benchmark import measure
from sims.compare import cells
from sims.compare.studies import STUDIES
from sims.demo import Demo, Options, Outcome
from sims.metrics import table, to_json, verdict
from sims.registry import cell_names, find_demo
from sims.report.datatable import Table, as_text
from sims.report.page import write_report
from sims.report.runs import CAPTION, level_figures
from sims.report.snapshot import Image, NoDisplay, write_png
from sims.resolvers import make_resolver
from sims.usage import refuse_idle
from sims.view import check_video
from sims.writing import check_folder, write
from wbc import InputError, UnknownName

__all__ = ["audit_model", "bench", "compare", "list_cells", "run_cell"]

COMPARED = ("hqp", "nullspace", "weighted")
"""Resolvers of a cell, where none are named."""
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
    refuse_idle(options, name)
    if options.experiment and options.experiment not in demo.experiments:
        raise UnknownName("experiment", options.experiment, demo.experiments)
    folder = None if out is None else _folder(out)
    if options.video is not None:
        check_video(options.video)
    began = time.perf_counter()
    outcome = demo.run(options)
    print(table(outcome.metrics))
    print(f"\n{verdict(outcome.metrics)} ({time.perf_counter() - began:.0f} s)")
    if folder is not None:
        _write(folder, f"{name}: {demo.about}", options, outcome)
    return 0 if all(metric.holds for metric in outcome.metrics) else 1


def compare(name: str, resolvers: list[str], options: Options, out: str | None) -> int:
    """Run a cell, or a study, in several ways, side by side.

    Args:
        name: of a cell, "random" or "transitions".
        resolvers: names; [] for a cell's experiments, or a choice that suits.
        options: for the runs.
        out: folder for reports.

    Returns:
        exit code: 0 for a cell, whose runs are not judged; 1 for a study of which a
            bound does not hold.

    Raises:
        UnknownName: there is no such cell or resolver.
        InputError: an option means nothing here.
    """
    if name not in (*STUDIES, *cell_names()):
        raise UnknownName("cell or study", name, [*cell_names(), *STUDIES])
    for resolver in resolvers:
        make_resolver(resolver)
    refuse_idle(options, name)
    folder = None if out is None else _folder(out)
    if name in STUDIES:
        return STUDIES[name](resolvers, options, folder)
    demo = find_demo(name)
    outcomes: dict[str, Outcome] = {}
    regrets: list[Table] = []
    for way, chosen in _ways(demo, resolvers, options).items():
        outcomes[way], regret = cells.run_sampled(demo, chosen, way)
        regrets.append(regret)
        if folder is not None:
            inner = _folder(str(folder / way.replace(":", "-")))
            _write(inner, f"{name} under {way}", chosen, outcomes[way])
    _, (names, *rows) = cells.side_by_side(name, outcomes)
    print(as_text(("", [names, *rows])).lstrip("\n"))
    print(f"\n{as_text(regrets[0])}")
    if folder is not None:
        cells.write(demo, outcomes, regrets, folder)
        print(f"wrote report.html to {folder}")
    return 0


def _ways(demo: Demo, resolvers: list[str], options: Options) -> dict[str, Options]:
    """What is set side by side: experiments, or resolvers."""
    if not resolvers and demo.experiments:
        return {name: replace(options, experiment=name) for name in demo.experiments}
    names = resolvers or list(COMPARED)
    return {name: replace(options, resolver=name) for name in names}


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
        raise InputError(f"--out {out}: {error.strerror or error}.") from error
    check_folder(folder, f"--out {out}")
    return folder


def _write(folder: Path, title: str, options: Options, outcome: Outcome) -> None:
    write(folder / "metrics.json", to_json(outcome.metrics))
    log = io.BytesIO()
    np.savez_compressed(log, **outcome.series)
    write(folder / "log.npz", log.getvalue())
    facts = {
        "resolver": options.resolver,
        "mismatch": "yes" if options.mismatch else "no",
        "seed": str(options.seed),
        **outcome.facts,
        "versions": ", ".join(f"{p} {version(p)}" for p in PACKAGES),
        "python": platform.python_version(),
    }
    picture = _picture(outcome)
    write_report(
        folder / "report.html",
        title=title,
        summary="Metrics from the simulator's truth, each against its bound.",
        metrics=outcome.metrics,
        figures=outcome.figures(),
        runs=level_figures(outcome.courses),
        how_to_read=CAPTION,
        replay_html=outcome.replay(),
        picture=picture,
        facts=facts,
    )
    written = ["metrics.json", "log.npz", "report.html"]
    if picture is not None:
        write_png(folder / "picture.png", picture)
        written.append("picture.png")
    print(f"wrote {', '.join(written)} to {folder}")


def _picture(outcome: Outcome) -> Image | None:
    """Of the run; none, and a word about it, where nothing can be drawn."""
    try:
        found: Image = outcome.picture()
    except NoDisplay as error:
        sys.stderr.write(f"wbc: {error}\n")
        return None
    return found
