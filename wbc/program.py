"""The compiled tasks of a stack, as numbers that their runner reads."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, final

import numpy as np

from wbc import slots
from wbc.arrays import IntArray
from wbc.errors import InputError
from wbc.frames import Frames
from wbc.kernel import WORLD, Kernel
from wbc.pointers import address_of
from wbc.state import State

__all__ = ["ENTRY", "Place", "Program"]

SCRATCH = 96
ENTRY = 11
"""Numbers that describe a task; read by compiled code (`wbc.compiled`), too."""
NONE, BY_ITSELF = -1, -2
"""In place of a frame's index: there is none; one that moves by itself."""


class Place(NamedTuple):
    """A compiled task in a stack.

    Attributes:
        kernel: how its rows are computed.
        frame: name of the frame that it reads, None for none.
        begin, end: its rows.
        second: name of the frame from which it sees the first, None for the world.
    """

    kernel: Kernel
    frame: str | None
    begin: int
    end: int
    second: str | None = None


@final
class Program:
    """The compiled tasks, bound to one State, whose memory they read.

    Args:
        places: the tasks, all of one catalogue; at least one.
        state: where the robot's quantities lie.
        m: number of rows of the stack.

    Attributes:
        runner: the compiled tick of their catalogue.

    Raises:
        InputError: tasks of several catalogues.
    """

    def __init__(self, places: Sequence[Place], state: State, m: int) -> None:
        robot = state.robot
        self._kernels = [place.kernel for place in places]
        self.runner = self._kernels[0].runner
        if any(kernel.runner is not self.runner for kernel in self._kernels):
            raise InputError("compiled tasks of one stack must share one catalogue.")
        read = [name for p in places for name in (p.frame, p.second) if name]
        names = list(dict.fromkeys(read)) or [WORLD]
        indices = [robot.frame_id(name) for name in names]
        self._frames = Frames(robot.model, state.data, names, indices)
        self._program = np.array([_entry(place, names) for place in places], np.int_)
        self._gains = np.full((2, m), -1.0)
        for kernel, _, begin, end, _ in places:
            if kernel.damping is not None and kernel.stiffness is not None:
                self._gains[0, begin:end] = kernel.stiffness
                self._gains[1, begin:end] = kernel.damping
        self._scratch = np.zeros((4, SCRATCH + 6 * robot.nv))

    def enter(self, table: IntArray) -> None:
        """Enter its addresses into a stack's table (`wbc.slots`)."""
        frames = self._frames
        table[slots.TASKS], table[slots.FRAMES] = len(self._kernels), len(frames.names)
        table[slots.PROGRAM : slots.SCRATCH + 1] = [
            address_of(self._program),
            address_of(self._gains),
            address_of(frames.pointers),
            address_of(frames.constants),
            address_of(frames.blocks),
            frames.jacobian,
            address_of(self._scratch),
        ]


def _entry(place: Place, names: Sequence[str]) -> list[int]:
    """One row of the program."""
    kernel = place.kernel
    moving, law, frames = kernel.moving, kernel.approach, [0, NONE]
    for i, name in enumerate((place.frame, place.second)):
        if name == WORLD and moving is not None:
            frames[i] = BY_ITSELF
        elif name:
            frames[i] = names.index(name)
    p, table = kernel.parameters, kernel.table
    return [
        kernel.code,
        frames[0],
        place.begin,
        place.end,
        address_of(p),
        p.size,
        address_of(table),
        table.size,
        frames[1],
        0 if moving is None else address_of(moving),
        0 if law is None else address_of(law),
    ]
