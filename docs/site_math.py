"""Formulas as outlines, drawn when the pages are built: no script, no network."""

from __future__ import annotations

from functools import cache
from html import escape

from docutils import nodes
from matplotlib.path import Path
from matplotlib.textpath import TextPath
from sphinx.application import Sphinx

SIZE = 15.0
"""Of the letters, in units of which 16 are an em of the page."""
LETTERS = {Path.MOVETO: "M", Path.LINETO: "L", Path.CURVE3: "Q", Path.CURVE4: "C"}


@cache
def svg(formula: str) -> str:
    """One line of TeX, in matplotlib's subset of it, as an inline SVG."""
    text = " ".join(formula.split())
    path = TextPath((0.0, 0.0), f"${text}$", size=SIZE)
    box = path.get_extents().padded(0.4)
    commands = []
    for vertices, code in path.iter_segments(curves=True, simplify=False):
        letter = LETTERS.get(code, "Z")
        numbers = [] if letter == "Z" else vertices.reshape(-1, 2) * (1.0, -1.0)
        commands.append(letter + " ".join(f"{x:.2f},{y:.2f}" for x, y in numbers))
    return (
        f'<svg class="formula" role="img" aria-label="{escape(text)}" '
        f'viewBox="{box.x0:.2f} {-box.y1:.2f} {box.width:.2f} {box.height:.2f}" '
        f'style="width:{box.width / 16.0:.3f}em;height:{box.height / 16.0:.3f}em;'
        f'vertical-align:{box.y0 / 16.0:.3f}em"><path d="{"".join(commands)}"/></svg>'
    )


def inline(self: object, node: nodes.math) -> None:
    """A formula within a line."""
    self.body.append(svg(node.astext()))
    raise nodes.SkipNode


def display(self: object, node: nodes.math_block) -> None:
    """One formula a line; lines end with two backslashes."""
    lines = (line for line in node.astext().split(r"\\") if line.strip())
    drawn = "".join(f"<div>{svg(line)}</div>" for line in lines)
    self.body.append(f'<div class="formulas">{drawn}</div>')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Known to Sphinx as the math renderer "paths"."""
    app.add_html_math_renderer("paths", (inline, None), (display, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
