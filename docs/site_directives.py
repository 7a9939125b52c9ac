"""What pages take from the code: tables, pictures and the reference of public names."""

from __future__ import annotations

import importlib
import inspect
import re
from typing import ClassVar

import site_pictures
import site_tables
from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

ALIASES = (
    (r"TypeAliasForwardRef\('(\w+)'\)", r"\1"),
    (r"~?pinocchio\.pinocchio_pywrap_default\.", "pin."),
)


class Exported(SphinxDirective):
    """Everything that a module lists in ``__all__``, with its docstrings."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Hand it to autodoc."""
        module = importlib.import_module(self.arguments[0])
        lines: list[str] = []
        for name in sorted(module.__all__, key=str.lower):
            item = getattr(module, name)
            if inspect.isclass(item):
                lines += [f".. autoclass:: {module.__name__}.{name}", "   :members:"]
            elif inspect.isfunction(item):
                lines += [f".. autofunction:: {module.__name__}.{name}"]
            lines += [""]
        return self.parse_text_to_nodes(StringList(lines, source=module.__name__))


class Picture(SphinxDirective):
    """A task: its picture, its rows, and what of a free frame it holds."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Draw it."""
        drawing, caption = site_pictures.of(self.arguments[0])
        html = f'<div class="task">{drawing}<p>{caption}</p></div>'
        return [nodes.raw("", html, format="html")]


class Table(SphinxDirective):
    """A table that a function of ``site_tables`` makes, as Markdown."""

    required_arguments = 1
    makers: ClassVar = site_tables.TABLES

    def run(self) -> list[nodes.Node]:
        """Parse what it makes."""
        text = self.makers[self.arguments[0]]()
        return self.parse_text_to_nodes(text)


def plain(app, what, name, item, options, lines: list[str]) -> None:
    """Docstrings speak Markdown: literals in single backticks, bars that are bars."""
    del app, what, name, item, options
    for i, line in enumerate(lines):
        parts = re.split(r"(`[^`]*`)", line)
        parts = [
            f"`{part}`" if part.startswith("`") and part != "``"
            else re.sub(r"([|*]|(?<=\w)_(?!\w))", r"\\\1", part)
            for part in parts
        ]  # fmt: skip
        lines[i] = "".join(parts)


def short(app, what, name, item, options, signature, returns):
    """Signatures name an alias of a type as the source does."""
    del app, what, name, item, options
    if signature is None:  # a property, or data
        return None
    parts = [signature, returns or ""]
    for pattern, word in ALIASES:
        parts = [re.sub(pattern, word, text) for text in parts]
    return parts[0], parts[1] or None


def counted(app, what, name: str, item, skip: bool, options) -> bool | None:
    """Fields of a named tuple are described by its class, not by their number."""
    del app, what, name, skip, options
    return (getattr(item, "__doc__", "") or "").startswith("Alias for field") or None


def setup(app: Sphinx) -> dict[str, bool]:
    """Directives ``exported``, ``picture`` and ``table``."""
    app.add_directive("exported", Exported)
    app.add_directive("picture", Picture)
    app.add_directive("table", Table)
    app.connect("autodoc-process-docstring", plain, priority=100)
    app.connect("autodoc-process-signature", short)
    app.connect("autodoc-skip-member", counted)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
