"""The report of a run: one HTML file that needs nothing else, on or off line."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path

from sims.metrics import Metric, format_value, to_json, verdict
from sims.report.cards import Drawing, cards, folded
from sims.report.datatable import Table, as_html
from sims.report.snapshot import Image, data_url
from sims.writing import write

__all__ = ["write_report"]

_PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
{style}</style>
</head>
<body>
<main>
<h1>{title}</h1>
<p class="summary">{summary}</p>
{verdict}
{body}
</main>
</body>
</html>
"""
_MARKS = {
    "ok": ("good", "✓ ok"),
    "FAIL": ("bad", "✗ FAIL"),
    "not measured": ("bad", "not measured"),
    "": ("", ""),
}


def write_report(
    path: str | Path,
    *,
    title: str,
    summary: str,
    metrics: Sequence[Metric],
    figures: Sequence[Drawing] = (),
    runs: Sequence[Drawing] = (),
    how_to_read: str = "",
    replay_html: str | None = None,
    picture: Image | None = None,
    facts: Mapping[str, str] | None = None,
    data: Sequence[Table] = (),
    annex: Sequence[Table] = (),
) -> None:
    """Write one self-contained page.

    Args:
        path: the file to write; its folder must exist.
        title: heading of the page.
        summary: plain text below the heading; line breaks are kept.
        metrics: the run's numbers, each with its bound.
        figures: (caption, `<svg>` element) pairs, in order.
        runs: the same of single runs, alike; all but the first few are folded.
        how_to_read: what to know about them.
        replay_html: a complete document, shown in a frame of its own.
        picture: (height, width, 3), which stands for the replay on paper.
        facts: what the run was made with, such as resolver, versions and seed.
        data: tables of numbers that are not judged, each under its heading.
        annex: more of them, below the figures.

    Raises:
        InputError: metrics of the same name, or a figure that is not one SVG element.
        NotWritten: there is no room for the page, or no right to write it.
    """
    to_json(metrics)  # refuses names that occur twice
    tables = _metrics(metrics) + _facts(facts or {})
    body = _replay(replay_html, picture) + f'<div class="tables">{tables}</div>\n'
    page = _PAGE.format(
        title=html.escape(title),
        summary=html.escape(summary),
        style=files("sims.report").joinpath("page.css").read_text(encoding="utf-8"),
        verdict=_verdict(metrics),
        body=body
        + "".join(map(as_html, data))
        + cards("Figures", figures)
        + folded("Runs, level by level", how_to_read, runs)
        + "".join(map(as_html, annex)),
    )
    write(path, page)


def _verdict(metrics: Sequence[Metric]) -> str:
    if not metrics:
        return ""
    held = all(metric.holds for metric in metrics)
    look, sign = ("good", "✓") if held else ("bad", "✗")
    return f'<p class="verdict {look}">{sign} {verdict(metrics)}</p>'


def _metrics(metrics: Sequence[Metric]) -> str:
    if not metrics:
        return ""
    rows = "\n".join(_metric(metric) for metric in metrics)
    head = '<th>metric<th class="number">value<th class="number">bound<th>verdict'
    return (
        '<section><h2>Metrics</h2><div class="card scroll"><table class="metrics">'
        f"<thead><tr>{head}</tr></thead>\n<tbody>\n{rows}\n</tbody></table></div>"
        "</section>"
    )


def _metric(metric: Metric) -> str:
    look, mark = _MARKS[metric.mark]
    return (
        f"<tr{'' if metric.holds else ' class=failed'}>"
        f"<th scope=row><code>{html.escape(metric.name)}</code></th>"
        f'<td class="number">{format_value(metric.value)}</td>'
        f'<td class="number">{html.escape(metric.limit)}</td>'
        f'<td class="mark {look}">{mark}</td></tr>'
    )


def _facts(facts: Mapping[str, str]) -> str:
    if not facts:
        return ""
    rows = "\n".join(
        f"<tr><th scope=row>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>"
        for name, value in facts.items()
    )
    return (
        '<section><h2>Run</h2><div class="card scroll"><table class="facts">'
        f"<tbody>\n{rows}\n</tbody></table></div></section>"
    )


def _replay(document: str | None, picture: Image | None) -> str:
    if document is None:
        return ""
    still = ""
    if picture is not None:
        still = f'<img class="printed" alt="The run" src="{data_url(picture)}">'
    return (
        '<section class="card"><iframe title="Replay in three dimensions" '
        f'srcdoc="{html.escape(document)}"></iframe>{still}'
        '<p class="printed">The replay moves: open this page in a browser to see it.'
        "</p></section>\n"
    )
