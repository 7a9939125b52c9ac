"""Tools for a flange: one MJCF file each, to be mounted with ``assembly.mount``."""

from __future__ import annotations

from importlib.resources import files

from wbc.checks import known

__all__ = ["mjcf", "names"]


def names() -> list[str]:
    """List the names of the tools, in alphabetical order."""
    found = (entry.name for entry in files(__name__).iterdir())
    return sorted(name.removesuffix(".xml") for name in found if name.endswith(".xml"))


def mjcf(name: str) -> str:
    """Return the MJCF text of one tool.

    Raises:
        UnknownName: there is no tool of that name.
    """
    known("tool", name, names())
    return files(__name__).joinpath(f"{name}.xml").read_text(encoding="utf-8")
