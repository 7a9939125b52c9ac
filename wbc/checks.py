"""Checks of what is no array: names, choices, counts, switches and kinds of object.

Like those of `wbc.arrays` they are made once, when something is built or set.
"""

from __future__ import annotations

from collections.abc import Iterable
from operator import index
from types import UnionType
from typing import Any, get_args

import numpy as np

from wbc.errors import InputError, UnknownName, shown

__all__ = ["expect", "flag", "known", "named", "names", "text", "whole"]


def expect(kind: type | UnionType, **given: object) -> None:
    """See that arguments, by their names, are of a kind.

    Raises:
        InputError: one is not.
    """
    for what, value in given.items():
        if not isinstance(value, kind):
            kinds = [one.__name__ for one in get_args(kind) or (kind,)]
            wanted = " or ".join(kinds).replace("NoneType", "None")
            article = "an" if wanted[0] in "AEIOU" else "a"
            given_kind = type(value).__name__
            raise InputError(
                f"{what} must be {article} {wanted}, not {given_kind}: {shown(value)}."
            )


def flag(**given: object) -> None:
    """See that arguments, by their names, are True or False.

    Raises:
        InputError: one is not.
    """
    for what, value in given.items():
        if not isinstance(value, bool | np.bool_):
            raise InputError(f"{what} must be True or False, not {shown(value)}.")


def text(value: Any, what: str) -> str:
    """A string that is not empty.

    Raises:
        InputError: something else.
    """
    if not isinstance(value, str) or not value:
        raise InputError(f"{what} must be a string, not empty, {got(value)}")
    return value


def names(values: Any, what: str, *, some: bool = False) -> tuple[str, ...]:
    """Different strings, as a tuple; at least one where `some`.

    Raises:
        InputError: a single string, one twice, or something else.
    """
    listed = None if isinstance(values, str) else _tuple(values)
    if listed is None or not all(isinstance(name, str) and name for name in listed):
        raise InputError(f"{what} must be a list of names, {got(values)}")
    if len(set(listed)) < len(listed) or (some and not listed):
        raise InputError(f"{what} must be a list of different names, {got(values)}")
    return listed


def named(name: Any, default: str) -> str:
    """The name that was given, or the default for None.

    Raises:
        InputError: what was given is no name.
    """
    return default if name is None else text(name, f"name of '{default}'")


def known(kind: str, name: Any, valid: Iterable[str]) -> str:
    """A name that is among the valid ones.

    Raises:
        UnknownName: it is not; the message lists them.
    """
    listed = tuple(valid)
    if not isinstance(name, str) or name not in listed:
        raise UnknownName(kind, name, listed)
    return name


def whole(value: Any, what: str, least: int = 0, most: float = np.inf) -> int:
    """A whole number from the least to the most.

    Raises:
        InputError: something else, a fraction too.
    """
    try:
        number = index(value)
    except TypeError as error:
        raise InputError(f"{what} must be a whole number, {got(value)}") from error
    if number < least:
        raise InputError(f"{what} must be at least {least}, {got(value)}")
    if number > most:
        raise InputError(f"{what} must be at most {most}, {got(value)}")
    return number


def got(value: object) -> str:
    """How a complaint ends."""
    return f"got {shown(value)}."


def _tuple(values: Any) -> tuple[Any, ...] | None:
    try:
        return tuple(values)
    except TypeError:
        return None
