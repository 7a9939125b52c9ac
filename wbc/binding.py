"""Tasks in use: which stacks read them, and what becomes of changes at run time.

A stack reads gains and settings of compiled tasks once. So a change of a task in use
must either reach the stacks that it stands in, or be refused (`wbc.settled`).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING
from weakref import WeakSet

if TYPE_CHECKING:
    from wbc.stack import Stack
    from wbc.task import Task

__all__ = ["announce", "register"]

_STACKS: WeakSet[Stack] = WeakSet()


def register(stack: Stack) -> None:
    """Let a new stack hear of changes of its tasks, as long as it lives."""
    _STACKS.add(stack)


def announce(task: Task) -> None:
    """Let the stacks of a task read it afresh at their next tick.

    Raises:
        InputError: what it is now does not fit a robot that it is in use for.
    """
    stacks = list(_users(task))
    for stack in stacks:
        task.check(stack.robot)
    for stack in stacks:
        stack.read_afresh()


def _users(task: Task) -> Iterator[Stack]:
    return (s for s in list(_STACKS) if any(term.task is task for term in s.terms))
