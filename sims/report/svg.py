"""A matplotlib figure as an SVG element that can stand in an HTML page."""

from __future__ import annotations

import functools
import hashlib
import html
import io
import re
from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

import matplotlib as mpl
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

__all__ = ["styled", "to_svg"]

P = ParamSpec("P")
R = TypeVar("R")

_STYLE: Any = {
    "svg.fonttype": "none",  # text stays text: small, sharp, searchable
    "svg.hashsalt": "wbc",
    "font.family": "DejaVu Sans",  # in every matplotlib; browsers fall back
    "font.size": 9.0,
    "axes.titlesize": 10.5,
    "axes.titleweight": "bold",
    "axes.labelcolor": "#3C4043",
    "xtick.color": "#3C4043",
    "ytick.color": "#3C4043",
    "axes.edgecolor": "#80868B",
}
_FONTS = "'DejaVu Sans', Verdana, Arial, sans-serif"


def styled(function: Callable[P, R]) -> Callable[P, R]:
    """The decorated function builds its figure in the report's style."""

    @functools.wraps(function)
    def wrapped(*args: P.args, **kwargs: P.kwargs) -> R:
        with mpl.rc_context(_STYLE):
            return function(*args, **kwargs)

    return wrapped


def to_svg(figure: Figure, label: str) -> str:
    """`<svg>...</svg>`, the same text for the same figure, sized by its container.

    `label` is what a screen reader says. Call it where `styled` is in force.
    """
    buffer = io.StringIO()
    FigureCanvasSVG(figure).print_svg(buffer, metadata={"Date": None})
    return _embeddable(buffer.getvalue(), label)


def _embeddable(document: str, label: str) -> str:
    """Only the element, without metadata, fixed size, or names others could have."""
    head, body = document[document.index("<svg") :].split(">", 1)
    for unwanted in ("<metadata>.*?</metadata>", "<style.*?</style>", "<!--.*?-->"):
        body = re.sub(rf"\s*{unwanted}", "", body, flags=re.DOTALL)
    body = body.replace("'DejaVu Sans'", _FONTS)
    prefix = "f" + hashlib.sha256(body.encode()).hexdigest()[:8] + "-"
    used = set(re.findall(r'(?:url\(#|href="#)([^)"]+)', body))
    body = re.sub(r' id="([^"]+)"', lambda m: _identity(m[1], used, prefix), body)
    body = re.sub(r'(url\(#|href="#)', rf"\g<1>{prefix}", body)
    box = re.search(r'viewBox="[^"]+"', head)
    attributes = [
        'xmlns="http://www.w3.org/2000/svg"',
        'xmlns:xlink="http://www.w3.org/1999/xlink"',
        box[0] if box else "",
        'stroke-linejoin="round" role="img"',
        f'aria-label="{html.escape(label)}"',
    ]
    return f"<svg {' '.join(attributes)}>{body.strip()}"


def _identity(name: str, used: set[str], prefix: str) -> str:
    return f' id="{prefix}{name}"' if name in used else ""
