"""A task's compiled half: which kernel computes its rows, and from which numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from wbc.arrays import Array, IntArray

__all__ = ["NO_TABLE", "WORLD", "Kernel"]

NO_TABLE = np.zeros(1)
WORLD = "universe"
"""Pinocchio's name of the frame that does not move."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Kernel:
    """How to compute a task's rows without Python.

    Attributes:
        runner: compiled function that writes the rows of all tasks of a catalogue and
            then calls `wbc.tick.conclude`; arguments as `wbc.tick.without_kernels`.
        code: which kernel of that catalogue.
        parameters: numbers that the kernel reads at every tick; the task may change
            them in place, as a moving target does.
        table: more of them, such as the pieces of a curve.
        stiffness, damping: (m,) of a PD law; None for rows that are bounds.
        approach: (4,) gains of `wbc.approach`, for a law that bounds its speed.
        joints: (m,) for rows that are 1 at one joint and 0 elsewhere: its index.
        moving: (26,) a frame that moves by itself, for `wbc.relative.moved`; it takes
            the place of the world among the task's two frames.
    """

    runner: Callable[..., Any]
    code: int
    parameters: Array
    table: Array = field(default_factory=lambda: NO_TABLE)
    stiffness: Array | None = None
    damping: Array | None = None
    approach: Array | None = None
    joints: IntArray | None = None
    moving: Array | None = None
