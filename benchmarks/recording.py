"""Runs of the simulated cells, kept for a replay without the simulator."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from benchmarks.workers.loop import Instant
from sims.cell import Cell
from sims.run import Decision, Watcher, run
from wbc import Controller, Hierarchy, Robot

__all__ = ["PERIOD", "Recording", "Script", "Stack", "Tape", "play"]

PERIOD = 1e-3
"""Of all cells [s]."""

Script = Callable[[float], None]


@dataclass(frozen=True)
class Stack:
    """What one controller works on.

    Attributes:
        robot: its model.
        hierarchy: the tasks.
        script: moves their targets to a time [s]; called once a tick, in order.
    """

    robot: Robot
    hierarchy: Hierarchy
    script: Script | None = None


@dataclass(frozen=True)
class Recording:
    """A run of a cell, as one of its controllers saw it.

    Attributes:
        make: the stack as it was at the start; a new one for everybody who replays
            the run, for tasks remember.
        instants: of the run, tick by tick.
    """

    make: Callable[[], Stack]
    instants: Sequence[Instant]


@dataclass
class Tape:
    """A watcher that keeps what the controllers of a cell saw and did.

    Attributes:
        tracks: instants of every controller.
    """

    tracks: list[list[Instant]] = field(default_factory=list)

    def __call__(self, cell: Cell, decisions: Sequence[Decision]) -> bool:
        """Keep a tick; the run goes on."""
        del cell
        self.tracks = self.tracks or [[] for _ in decisions]
        for track, (_, seen, solution) in zip(self.tracks, decisions, strict=True):
            felt = {name: wrench.copy() for name, wrench in seen.wrenches.items()}
            state = (seen.t, seen.q.copy(), seen.v.copy())
            track.append(Instant(*state, felt, solution.torque.copy()))
        return True


def play(
    cell: Cell, stack: Stack, ticks: int, watch: Watcher | None = None
) -> list[Instant]:
    """Run one arm's cell from its present state under `hqp`; what the arm saw.

    Args:
        cell: where the arm is.
        stack: to control it with.
        ticks: of the run, at most.
        watch: ends the run earlier.
    """
    tape = Tape()

    def both(cell: Cell, decisions: Sequence[Decision]) -> bool:
        return tape(cell, decisions) and (watch is None or watch(cell, decisions))

    controller = Controller(stack.robot, stack.hierarchy)
    run(cell, controller, ticks * PERIOD, script=stack.script, watch=both)
    return tape.tracks[0]
