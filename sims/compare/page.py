"""The tables, the bars and the report of a study of random stacks."""

from __future__ import annotations

import platform
from importlib.metadata import version
from pathlib import Path

import numpy as np

from sims.compare.figures import marks
from sims.compare.picture import write_picture
from sims.compare.study import LOCKING, Study
from sims.compare.words import explain
from sims.metrics import Metric, to_json
from sims.report.datatable import Table
from sims.report.page import write_report
from sims.writing import write as write_file

__all__ = ["SOUND", "bars", "figures", "is_strict", "key_of", "tables", "write"]

SOUND = 1e-8
"""A leak or a gap below this is round-off."""
SHORT = 1e-3
"""A law counts as not optimal from this gap on."""
STRICT = ("nullspace", "nullspace:tsid", "hqp")
COLUMNS = {
    "leak": "leak",
    "gap": "gap, worst",
    "typical_gap": "gap, median",
    "violation": "violation",
    "gauss": "Gauss effort",
    "acceleration": "|vdot|",
    "torque": "|tau|",
    "limit_jump": "jump at limits",
    "task_jump": "jump at a switch",
    "microseconds": "time [us]",
    "failures": "failures",
}
SMALL = ("leak", "gap", "typical_gap", "violation", "limit_jump", "task_jump")


def bars(study: Study) -> list[Metric]:
    """What the laws promise, held against what was measured."""
    judged = []
    for name in study.resolvers:
        leak, bound = study.worst("leak", name), SOUND if is_strict(name) else None
        judged.append(Metric(f"{key_of(name)}_leak_relative", leak, bound))
    for name in study.resolvers:
        key = key_of(name)
        for limits, when in ((False, "free"), (True, "limits")):
            if not study.of(name, limits=limits):
                continue
            gap = study.worst("gap", name, limits=limits)
            metric = f"{key}_gap_{when}_relative"
            if is_strict(name):
                judged.append(Metric(metric, gap, SOUND))
            elif (name in ("nullspace:uf", "weighted")) or (name == LOCKING and limits):
                judged.append(Metric(metric, gap, SHORT, ">="))
            else:
                judged.append(Metric(metric, gap))
    judged.append(Metric("worst_certificate_residual", study.proof, SOUND))
    return judged


def tables(study: Study) -> list[Table]:
    """One of each family, and one over all."""
    found: list[Table] = []
    for family in study.families:
        rows = [["resolver", *COLUMNS.values()]]
        for finding in study.findings:
            if finding.family == family.name:
                numbers = [_cell(c, getattr(finding, c)) for c in COLUMNS]
                rows.append([finding.resolver, *numbers])
        found.append((f"{family.name}: {family.text}", rows))
    return found


def figures(study: Study) -> list[tuple[str, str]]:
    """(caption, svg) pairs."""
    names = [family.name for family in study.families]
    drawn = []
    for indicator, title, caption, bar in (
        (
            "leak",
            "Sound? What changes above when a lower level changes",
            "Relative change of what a level gets. Marks at the bottom are round-off.",
            SOUND,
        ),
        (
            "gap",
            "Optimal? Largest distance of a level from its optimum",
            "Relative to what the level asks for; optima are proven by certificates.",
            SOUND,
        ),
        ("microseconds", "Time of a solver that starts cold", "Median.", None),
    ):
        series = {
            resolver: [getattr(study.of(resolver, n)[0], indicator) for n in names]
            for resolver in study.resolvers
        }
        unit = "time [us]" if indicator == "microseconds" else f"{indicator} [1]"
        floor = 1.0 if indicator == "microseconds" else 1e-16
        svg = marks(title, names, series, unit, floor=floor, bar=bar)
        drawn.append((caption, svg))
    return drawn


def write(study: Study, folder: Path) -> None:
    """Write metrics.json, picture.png and report.html into a folder."""
    write_picture(study, folder / "picture.png")
    judged = bars(study)
    write_file(folder / "metrics.json", to_json(judged))
    write_report(
        folder / "report.html",
        title="Projection, weights and strict QP on random stacks",
        summary=explain(study),
        metrics=judged,
        figures=figures(study),
        facts={
            "seed": str(study.seed),
            "problems of each family": str(study.count),
            "versions": ", ".join(f"{p} {version(p)}" for p in ("wbc", "pin", "numpy")),
            "python": platform.python_version(),
        },
        data=tables(study),
    )


def is_strict(name: str) -> bool:
    """Whether a resolver promises to be sound, limits or not."""
    return name in STRICT or name.startswith("hqp")


def key_of(name: str) -> str:
    """A resolver's name as part of a metric's."""
    return name.replace(":", "_").replace(" ", "_")


def _cell(column: str, value: float) -> str:
    if np.isnan(value):
        return "-"
    if column in SMALL:
        return f"{value:.1e}"
    return f"{value:.3g}" if column != "failures" else f"{value:.0f}"
