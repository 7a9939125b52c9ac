"""A table of data in a report: one heading, one row of column names, plain cells."""

from __future__ import annotations

import html
from collections.abc import Sequence
from itertools import zip_longest

__all__ = ["Table", "as_html", "as_text"]

Table = tuple[str, Sequence[Sequence[str]]]
"""Heading, and rows of cells; the first row names the columns."""


def as_html(table: Table) -> str:
    """A section of a report."""
    heading, (names, *rows) = table
    head = "".join(f'<th class="number">{html.escape(name)}' for name in names[1:])
    body = "\n".join(
        f"<tr><th scope=row>{html.escape(first)}</th>"
        + "".join(f'<td class="number">{html.escape(cell)}</td>' for cell in cells)
        + "</tr>"
        for first, *cells in rows
    )
    return (
        f"<section><h2>{html.escape(heading)}</h2>"
        f'<div class="card scroll"><table><thead><tr><th>{html.escape(names[0])}'
        f"{head}</tr></thead>\n<tbody>\n{body}\n</tbody></table></div></section>\n"
    )


def as_text(table: Table) -> str:
    """The same for a terminal, columns aligned."""
    heading, rows = table
    columns = zip_longest(*rows, fillvalue="")
    widths = [max(len(cell) for cell in column) for column in columns]
    lines = (
        "  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=False)).rstrip()
        for row in rows
    )
    return "\n".join([heading, *lines])
