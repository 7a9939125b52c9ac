"""Robots and their tools: one package a robot, with its model file."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

__all__ = ["assembly", "compose", "lwr4", "racer", "tools"]


def __getattr__(name: str) -> ModuleType:
    """A module of this package, imported when it is first asked for."""
    if name not in __all__:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return import_module(f"{__name__}.{name}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
