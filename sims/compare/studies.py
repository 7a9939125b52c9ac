"""`wbc compare random` and `wbc compare transitions`: run, print, write."""

from __future__ import annotations

import platform
from collections.abc import Callable, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TypeAlias

from sims.compare import page
from sims.compare.study import study
from sims.compare.transitions import (
    HURRY,
    LIMIT,
    MODES,
    OVER,
    Passage,
    bars,
    passages,
)
from sims.course import Course
from sims.demo import Options
from sims.metrics import Metric, table, to_json, verdict
from sims.report.datatable import Table, as_text
from sims.report.figures import time_series
from sims.report.page import write_report
from sims.report.runs import CAPTION, compared_figures
from sims.writing import write

__all__ = ["STUDIES"]

FAMILIES = ("hqp", "nullspace")
"""Resolvers of the transitions, where none are named."""
PACKAGES = ("wbc", "pin", "mujoco")
Study: TypeAlias = Callable[[Sequence[str], Options, Path | None], int]


def compare_random(
    resolvers: Sequence[str], options: Options, folder: Path | None
) -> int:
    """Random stacks under all resolvers; 0 if every bar holds, else 1."""
    found = study(options.seed, names=resolvers)
    judged = page.bars(found)
    print("\n\n".join(map(as_text, page.tables(found))))
    _conclude(judged)
    if folder is not None:
        page.write(found, folder)
        print(f"wrote metrics.json, report.html, picture.png to {folder}")
    return 0 if all(metric.holds for metric in judged) else 1


def compare_transitions(
    resolvers: Sequence[str], options: Options, folder: Path | None
) -> int:
    """Torque rates through changes; 0 if every bar holds, else 1."""
    found = passages(resolvers or FAMILIES, options.seed)
    judged = bars(found)
    print(as_text(rates(found)))
    _conclude(judged)
    if folder is not None:
        _write(found, judged, options, folder)
        print(f"wrote metrics.json, report.html to {folder}")
    return 0 if all(metric.holds for metric in judged) else 1


STUDIES: dict[str, Study] = {
    "random": compare_random,
    "transitions": compare_transitions,
}


def rates(found: Sequence[Passage]) -> Table:
    """Largest torque rate after each change, a column a run."""
    head = ["change", *(f"{p.resolver}, {p.mode}" for p in found)]
    columns = [dict(p.worst) for p in found]
    rows = [[name, *(f"{c[name]:.0f}" for c in columns)] for name in columns[0]]
    return "largest torque rate of any joint after each change [Nm/s]", [head, *rows]


def _conclude(judged: Sequence[Metric]) -> None:
    print(f"\n{table(judged)}\n\n{verdict(judged)}")


def _write(
    found: Sequence[Passage], judged: Sequence[Metric], options: Options, folder: Path
) -> None:
    write(folder / "metrics.json", to_json(judged))
    write_report(
        folder / "report.html",
        title="Changing hierarchies at run time",
        summary=_words(found),
        metrics=judged,
        figures=_figures(found),
        runs=compared_figures(_courses(found)),
        how_to_read=CAPTION,
        facts={
            "seed": str(options.seed),
            "ramp": f"{OVER} s, changes in a hurry {HURRY} s apart",
            "versions": ", ".join(
                f"{p} {version(p)}" for p in ("wbc", "pin", "mujoco")
            ),
            "python": platform.python_version(),
        },
        data=[rates(found)],
    )


def _courses(found: Sequence[Passage]) -> dict[str, dict[str, Course]]:
    """Resolver -> mode -> its course."""
    courses: dict[str, dict[str, Course]] = {}
    for passage in found:
        courses.setdefault(passage.resolver, {})[passage.mode] = Course.of(passage.log)
    return courses


def _words(found: Sequence[Passage]) -> str:
    said = [
        f"{p.resolver}, {p.mode}: {p.rate.max():.3g} Nm/s, after "
        f"'{max(p.worst, key=lambda pair: pair[1])[0]}'."
        for p in found
    ]
    return (
        f"The welding arm holds a posture; then tasks are added, replaced, re-ranked "
        f"and removed, the last ones while a change is still under way. Industrial "
        f"arms stop at {LIMIT:g} Nm/s per joint. Largest torque rates:\n"
        + "\n".join(said)
        + "\n\nA ramp blends what the old and the new hierarchy want, and takes longer "
        "where they differ much; it asks nothing of the resolver, so both families "
        "gain alike. A torque-rate limit in the hierarchy bounds the rate whatever "
        "happens, but it says nothing of the way: tasks that ask at once for what "
        "comes late overshoot, as its figures show. So ramp changes, and keep the "
        "limit for what nobody foresaw."
    )


def _figures(found: Sequence[Passage]) -> list[tuple[str, str]]:
    drawn = []
    for passage in found:
        log = passage.log
        joints = dict(zip(log.robot.joint_names, log.torque.T, strict=True))
        title = f"{passage.resolver}, {passage.mode}: torques"
        svg = time_series(title, log.t, joints, "torque [Nm]")
        drawn.append((f"Largest rate {passage.rate.max():.3g} Nm/s.", svg))
    for mode in MODES[::2]:
        shown = [p for p in found if p.mode == mode.name]
        series = {p.resolver: p.rate for p in shown}
        svg = time_series(
            f"{mode.name}: largest torque rate of any joint",
            shown[0].log.t[1:],
            series,
            "torque rate [Nm/s]",
            bounds={"industrial arms stop": LIMIT},
        )
        drawn.append(("From tick to tick.", svg))
    return drawn
