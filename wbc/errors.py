"""The exceptions of the library: one base class, one per kind of mistake."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from typing import final

__all__ = [
    "InputError",
    "ModelError",
    "SolverError",
    "StaleError",
    "UnknownName",
    "WbcError",
    "shown",
]

LONGEST = 100
"""Characters of an unusable value that a message shows."""


class WbcError(Exception):
    """Base of every exception that this library raises on purpose."""


@final
class InputError(WbcError, ValueError):
    """A value that cannot be used: wrong shape, sign, order, or not finite."""


@final
class ModelError(WbcError, ValueError):
    """A robot model that would be read differently from what its author meant."""


@final
class UnknownName(WbcError, LookupError):
    """A name that does not exist; the message lists those that do.

    Attributes:
        kind: what was looked up, such as "frame" or "joint".
        name: the name that was not found.
        valid: the names that exist.
    """

    def __init__(self, kind: str, name: str, valid: Iterable[str]) -> None:
        self.kind, self.name, self.valid = kind, name, tuple(valid)
        close: list[str] = []
        if isinstance(name, str):
            close = get_close_matches(name, self.valid, n=1)
        hint = f" Did you mean '{close[0]}'?" if close else ""
        names = ", ".join(self.valid) or "(none)"
        super().__init__(f"unknown {kind} {shown(name)}.{hint} Valid names: {names}.")


@final
class SolverError(WbcError, RuntimeError):
    """A resolver that found no solution; the evidence travels along.

    Attributes:
        level: index of the level that failed, from 0 at the top.
    """

    def __init__(self, message: str, level: int = -1) -> None:
        self.level = level
        super().__init__(message)


@final
class StaleError(WbcError, RuntimeError):
    """A view of a tick that a later tick has overwritten."""


def shown(value: object) -> str:
    """An unusable value in one line of a message, cut where it is long."""
    try:
        text = " ".join(repr(value).split())
    except (
        Exception
    ):  # whatever its author's repr raises, or a number too long to print
        return f"a value of type {type(value).__name__}"
    return text if len(text) <= LONGEST else f"{text[:LONGEST]} ..."
