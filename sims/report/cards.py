"""Figures as cards of a page; long rows of like ones are folded after the first few."""

from __future__ import annotations

import html
import re
from collections.abc import Sequence
from typing import Final, TypeAlias

from wbc.errors import InputError

__all__ = ["Drawing", "cards", "folded"]

Drawing: TypeAlias = tuple[str, str]
"""Caption, and an `<svg>` element."""
_OPEN: Final = 4  # cards before the fold
_WIDE: Final = 600.0  # [pt], wider figures take the whole width of the page


def cards(heading: str, figures: Sequence[Drawing]) -> str:
    """A section of the page; nothing where there are no figures.

    Raises:
        InputError: a figure is not one SVG element, or holds a script.
    """
    if not figures:
        return ""
    return f"<h2>{html.escape(heading)}</h2>\n{_grid(figures)}"


def folded(heading: str, note: str, figures: Sequence[Drawing]) -> str:
    """The same for figures that are alike, with a note on how to read them."""
    if not figures:
        return ""
    begin = f"<h2>{html.escape(heading)}</h2>\n<p>{html.escape(note)}</p>\n"
    shown, more = figures[:_OPEN], figures[_OPEN:]
    if not more:
        return begin + _grid(shown)
    return (
        f"{begin}{_grid(shown)}<details><summary>{len(more)} more like these</summary>"
        f"\n{_grid(more)}</details>"
    )


def _grid(figures: Sequence[Drawing]) -> str:
    inside = "\n".join(_card(caption, svg) for caption, svg in figures)
    return f'<div class="figures">\n{inside}\n</div>\n'


def _card(caption: str, svg: str) -> str:
    element = svg.strip()
    if not (element.startswith("<svg") and element.endswith("</svg>")):
        raise InputError(f"the figure '{caption}' is not one <svg> element.")
    if "<script" in element.lower():
        raise InputError(f"the figure '{caption}' holds a script.")
    look = "card wide" if _width(element) > _WIDE else "card"
    text = html.escape(caption)
    return f'<figure class="{look}">{element}<figcaption>{text}</figcaption></figure>'


def _width(element: str) -> float:
    """Of an element's drawing, in its own units; 0 where it does not say."""
    box = re.match(r'<svg[^>]*viewBox="\S+ \S+ (\S+) ', element)
    return 0.0 if box is None else float(box[1])
