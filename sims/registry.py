"""The demos that the command line knows, imported when they are asked for."""

from __future__ import annotations

from importlib import import_module

from sims.demo import Demo
from wbc.checks import known

__all__ = ["cell_names", "find_demo"]

MODULES = {
    "cutting": "sims.cutting.demo",
    "welding": "sims.welding.demo",
    "constraints": "sims.constraints.demo",
    "grasping": "sims.grasping.demo",
    "contact": "sims.contact.demo",
}


def cell_names() -> list[str]:
    """Names of all cells."""
    return list(MODULES)


def find_demo(name: str) -> Demo:
    """A demo by name.

    Raises:
        UnknownName: there is no such cell.
    """
    demo: Demo = import_module(MODULES[known("cell", name, MODULES)]).DEMO
    return demo
