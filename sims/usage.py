"""Options that would have no effect on what is asked for are refused, not ignored."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from sims.demo import Demo, Options
from sims.registry import cell_names, find_demo
from wbc import InputError

__all__ = ["refuse_idle"]


def refuse_idle(options: Options, name: str) -> None:
    """See that what was asked for on the command line has an effect.

    Args:
        options: what the user asked for.
        name: of a cell, or of a study of `wbc compare`.

    Raises:
        InputError: an option has no effect there; the message says where it has.
    """
    cell = find_demo(name) if name in cell_names() else None
    for option, given, means in (
        ("--duration", options.duration is not None, lambda _: True),
        ("--mismatch", options.mismatch, lambda _: True),
        ("--experiment", bool(options.experiment), lambda demo: demo.experiments),
        ("--combined", options.combined, lambda demo: demo.combined),
    ):
        if given and not (cell and means(cell)):
            where = ", ".join(_cells(means))
            raise InputError(
                f"{option} has no effect on '{name}', only on: {where or '(nothing)'}."
            )


def _cells(means: Callable[[Demo], object]) -> Iterable[str]:
    return (name for name in cell_names() if means(find_demo(name)))
