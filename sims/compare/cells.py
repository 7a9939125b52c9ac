"""`wbc compare CELL`: a cell under several resolvers, in numbers, figure and words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from sims.compare.figures import marks
from sims.compare.probe import Sampler
from sims.demo import Demo, Options, Outcome
from sims.metrics import Metric, format_value
from sims.report.datatable import Table
from sims.report.page import write_report
from sims.run import probing

__all__ = ["run_sampled", "side_by_side", "write"]

ROUND_OFF = 1e-16
SOUND = 1e-8
"""A leak or a gap below this is round-off."""
LEAK, GAP = "leak_max_relative", "optimality_gap_max_relative"


def run_sampled(demo: Demo, options: Options) -> Outcome:
    """Run a cell, and add what was sampled along the way to its metrics."""
    sampler = Sampler(options.resolver, options.seed)
    with probing(sampler):
        outcome = demo.run(options)
    return replace(outcome, metrics=[*outcome.metrics, *sampler.metrics()])


def side_by_side(name: str, outcomes: Mapping[str, Outcome]) -> Table:
    """All metrics, a column a resolver."""
    found = {r: {m.name: m for m in o.metrics} for r, o in outcomes.items()}
    names = list(dict.fromkeys(m for metrics in found.values() for m in metrics))
    rows = [["metric", *outcomes, "bound"]]
    for metric in names:
        of = [metrics.get(metric) for metrics in found.values()]
        limit = next((m.limit for m in of if m is not None and m.limit), "")
        rows.append([metric, *map(_mark, of), limit])
    return f"{name} under {', '.join(outcomes)}", rows


def write(demo: Demo, outcomes: Mapping[str, Outcome], folder: Path) -> None:
    """Write report.html of the comparison into a folder."""
    drawn = [] if demo.compared is None else demo.compared(outcomes)
    write_report(
        folder / "report.html",
        title=f"{demo.name}: {demo.about}, under {len(outcomes)} resolvers",
        summary=_words(outcomes),
        metrics=[],
        figures=[*_figures(outcomes), *drawn],
        facts={r: f"{_folder(r)}/report.html" for r in outcomes},
        data=[side_by_side(demo.name, outcomes)],
    )


def _mark(metric: Metric | None) -> str:
    if metric is None:
        return "-"
    return format_value(metric.value) + ("" if metric.holds else " FAIL")


def _folder(resolver: str) -> str:
    return resolver.replace(":", "-")


def _values(outcomes: Mapping[str, Outcome], name: str) -> dict[str, float]:
    return {
        r: m.value for r, o in outcomes.items() for m in o.metrics if m.name == name
    }


def _figures(outcomes: Mapping[str, Outcome]) -> list[tuple[str, str]]:
    leak, gap = _values(outcomes, LEAK), _values(outcomes, GAP)
    if not leak:
        return []
    svg = marks(
        "Sound? Optimal? Along the runs",
        ["leak into higher levels", "distance from the optimum"],
        {name: [leak[name], gap[name]] for name in leak},
        "relative size [1]",
        floor=ROUND_OFF,
        bar=SOUND,
    )
    return [("Worst of all samples. Marks at the bottom are round-off.", svg)]


def _words(outcomes: Mapping[str, Outcome]) -> str:
    leak, gap = _values(outcomes, LEAK), _values(outcomes, GAP)
    if not leak:
        return "No tick was sampled: the runs were too short."
    said = [f"{n}: leak {leak[n]:.0e}, gap {gap[n]:.0e}." for n in leak]
    sound = [n for n in leak if leak[n] < SOUND]
    optimal = [n for n in gap if gap[n] < SOUND]
    failed = {
        r: sum(not metric.holds for metric in o.metrics) for r, o in outcomes.items()
    }
    bounds = ", ".join(f"{r} {count}" for r, count in failed.items())
    return (
        "At states along each run, what lower levels want was changed, to see whether "
        "higher ones notice (leak), and each level's slack was compared with its "
        "proven optimum (gap); both relative to what is asked for.\n"
        + "\n".join(said)
        + f"\n\nSound here: {', '.join(sound) or 'none'}. Optimal here: "
        f"{', '.join(optimal) or 'none'}. Bounds of the cell that do not hold: "
        f"{bounds}. A resolver can miss its optimum and still hold the cell's bounds: "
        "where tasks hardly compete, all of them do the same."
    )
