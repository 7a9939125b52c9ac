"""Tasks whose attributes stand once they are made, but for those with a setter.

A stack reads gains and settings of tasks once, when it is built. So what is set later
must either reach the stacks that a task stands in, which setters and methods see to, or
be refused: it would be ignored in silence.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, NoReturn

from wbc.errors import InputError

__all__ = ["Settled"]


class Settled:
    """Refuses to set public attributes that have no setter, after construction.

    For the tasks of a catalogue. What a class remembers from tick to tick is private,
    with a leading underscore, and stays free.
    """

    name: str
    _made = False

    def __init_subclass__(cls, **given: Any) -> None:
        super().__init_subclass__(**given)
        if "__init__" in vars(cls):
            setattr(cls, "__init__", _closing(vars(cls)["__init__"]))  # noqa: B010

    def __setattr__(self, name: str, value: object) -> None:
        """Set an attribute.

        Raises:
            InputError: it is public, and settled.
        """
        if name[0] != "_" and self._made and not _free(self, name):
            _refuse(self, name)
        object.__setattr__(self, name, value)


def _closing(make: Callable[..., None]) -> Callable[..., None]:
    """A constructor after which nothing is set any more, where it is the last one."""

    @wraps(make)
    def constructor(self: Settled, *given: Any, **named: Any) -> None:
        make(self, *given, **named)
        if type(self).__init__ is constructor:
            self._made = True

    return constructor


def _free(task: Settled, name: str) -> bool:
    """Whether an attribute may be set at any time."""
    found = getattr(type(task), name, None)
    return isinstance(found, property) and found.fset is not None


def _refuse(task: Settled, name: str) -> NoReturn:
    known = dir(type(task))
    ways = [f"{n}()" for n in known if n.startswith("set_")]
    ways += [n for n in known if _free(task, n)]
    free = ", ".join(ways) or "(nothing)"
    what = "is read when a controller is built" if hasattr(task, name) else "is unknown"
    raise InputError(
        f"'{name}' of task '{task.name}' {what}, so setting it would have no effect. "
        f"What may change at any time: {free}. For anything else make a new task, and "
        "hand the new hierarchy to Controller.change()."
    )
