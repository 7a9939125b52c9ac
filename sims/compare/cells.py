"""`wbc compare CELL`: runs of a cell side by side, in numbers, figure and words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from sims.compare.figures import marks
from sims.compare.page import SOUND, is_strict, key_of
from sims.compare.probe import Sampler
from sims.demo import Demo, Options, Outcome
from sims.metrics import Metric, format_value
from sims.report.datatable import Table
from sims.report.page import write_report
from sims.report.runs import CAPTION, compared_figures
from sims.run import probing

__all__ = ["run_sampled", "side_by_side", "write"]

ROUND_OFF = 1e-16
LEAK, GAP = "leak_max_relative", "optimality_gap_max_relative"


def run_sampled(demo: Demo, options: Options, way: str) -> tuple[Outcome, Table]:
    """Run a cell, and add what was sampled along the way to its metrics.

    Args:
        demo: the cell.
        options: of the run.
        way: what the run is called, a resolver or an experiment.

    Returns:
        the outcome, and what strictness cost along the way.
    """
    sampler = Sampler(options.resolver, options.seed)
    with probing(sampler):
        outcome = demo.run(options)
    outcome = replace(outcome, metrics=[*outcome.metrics, *sampler.metrics()])
    return outcome, sampler.regrets.table(way)


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


def write(
    demo: Demo,
    outcomes: Mapping[str, Outcome],
    regrets: Sequence[Table],
    folder: Path,
) -> None:
    """Write report.html of the comparison into a folder."""
    drawn = [] if demo.compared is None else demo.compared(outcomes)
    write_report(
        folder / "report.html",
        title=f"{demo.name}: {demo.about}, side by side",
        summary=_words(outcomes),
        metrics=_judged(outcomes),
        figures=[*_figures(outcomes), *drawn],
        runs=compared_figures({way: o.courses for way, o in outcomes.items()}),
        how_to_read=CAPTION,
        facts={r: f"{_folder(r)}/report.html" for r in outcomes},
        data=[side_by_side(demo.name, outcomes)],
        annex=regrets,
    )


def _judged(outcomes: Mapping[str, Outcome]) -> list[Metric]:
    """Soundness, held against those that promise it."""
    return [
        Metric(f"{key_of(name)}_{LEAK}", leak, SOUND if is_strict(name) else None)
        for name, leak in _values(outcomes, LEAK).items()
    ]


def _mark(metric: Metric | None) -> str:
    if metric is None:
        return "-"
    if not metric.measured:
        return metric.mark
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
        "where tasks hardly compete, all of them do the same. What each level paid for "
        "those above is in the tables of what strictness cost: alone is what it would "
        "miss with none above it, got what it missed."
    )
