"""The loop that joins a cell and a controller, and what it keeps."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import NamedTuple, Protocol

from sims.cell import Cell, Observation
from sims.log import Log
from wbc import Controller, InputError, Solution
from wbc.arrays import Array, positive
from wbc.checks import expect, flag, names
from wbc.errors import shown

__all__ = [
    "CERTIFY_EVERY",
    "Bar",
    "Decision",
    "Probe",
    "Watcher",
    "current_probe",
    "probing",
    "run",
]

CERTIFY_EVERY = 50
"""Ticks between two certificates, which cost more than a tick."""


class Decision(NamedTuple):
    """What a controller saw at a tick, and what it made of it."""

    controller: Controller
    seen: Observation
    solution: Solution


class Watcher(Protocol):
    """Something that looks at every tick, such as a viewer."""

    def __call__(self, cell: Cell, decisions: Sequence[Decision]) -> bool:
        """See a tick after its time step, a decision a controller; false ends the run.

        What it raises ends the run, too.
        """


class Probe(Protocol):
    """Something that studies the ticks of all runs, whoever starts them."""

    def __call__(
        self, tick: int, controller: Controller, solution: Solution, q: Array, v: Array
    ) -> None:
        """See a tick, at the measured q (n,) and v (n,)."""


_PROBE: ContextVar[Probe | None] = ContextVar("probe", default=None)


def current_probe() -> Probe | None:
    """Who wants to see the present run, for cells with a loop of their own."""
    return _PROBE.get()


@contextmanager
def probing(probe: Probe) -> Iterator[None]:
    """Let a probe see every tick of the runs within."""
    token = _PROBE.set(probe)
    try:
        yield
    finally:
        _PROBE.reset(token)


def run(
    cell: Cell,
    controller: Controller,
    duration: float,
    *,
    script: Callable[[float], None] | None = None,
    sites: tuple[str, ...] = (),
    watch: Watcher | None = None,
    label: str = "",
    quiet: bool = True,
) -> Log:
    """Run a cell under control from its present state.

    Args:
        cell: the cell.
        controller: made for the cell's robot.
        duration: simulated time [s].
        script: called with the time before every tick; may move targets.
        sites: names of sites whose true poses are kept.
        watch: looks at every tick; the run ends when it says so.
        label: what the progress bar says.
        quiet: no progress bar; there is none either where output is no terminal.

    Raises:
        InputError: a duration that is no positive number, or a controller whose
            period is not the cell's time step; an argument of the wrong kind.
        UnknownName: there is no such site.
    """
    expect(Cell, cell=cell)
    expect(Controller, controller=controller)
    expect(str, label=label)
    flag(quiet=quiet)
    for what, called in (("script", script), ("watch", watch)):
        if called is not None and not callable(called):
            raise InputError(f"{what} must be a function, not {shown(called)}.")
    dt, duration = cell.model.opt.timestep, positive(duration, "duration [s]")
    if abs(dt - controller.dt) > 1e-12:
        raise InputError(
            f"the cell steps by {dt} s and the controller by {controller.dt} s: "
            "make them equal."
        )
    ticks = max(1, round(duration / dt))
    log = Log(cell, controller, ticks, names(sites, "sites"))
    bar, probe = Bar(label, ticks, quiet), current_probe()
    certify = controller.resolver.name.startswith("hqp")
    for tick in range(ticks):
        began = time.process_time()  # of the processor, whatever else it runs
        seen = cell.observe()
        if script is not None:
            script(seen.t)
        before = time.perf_counter()
        solution = controller(seen.q, seen.v, seen.t, seen.wrenches)
        after = time.perf_counter()
        cell.apply(solution.torque)
        log.record(tick, seen, solution, after - before)
        cell.step()
        log.spent += time.process_time() - began
        settled = solution.ok and solution.share == 1.0
        if certify and tick % CERTIFY_EVERY == 0 and settled:
            log.worst_certificate = max(
                log.worst_certificate, solution.certificate().worst
            )
        if probe is not None:
            probe(tick, controller, solution, seen.q, seen.v)
        decision = Decision(controller, seen, solution)
        if watch is not None and not watch(cell, (decision,)):
            break
        bar.show(tick + 1)
    bar.close()
    return log.trimmed()


class Bar:
    """A progress bar on a terminal; silent anywhere else."""

    def __init__(self, label: str, ticks: int, quiet: bool) -> None:
        self._label, self._ticks = label, ticks
        self._on = not quiet and sys.stderr.isatty()
        self._stride = max(1, ticks // 100)

    def show(self, tick: int) -> None:
        """Draw it after so many ticks."""
        if self._on and (tick % self._stride == 0 or tick == self._ticks):
            share = tick / self._ticks
            filled = "█" * round(30 * share)
            sys.stderr.write(f"\r{self._label:<24} {filled:<30} {share:4.0%}")
            sys.stderr.flush()

    def close(self) -> None:
        """End its line."""
        if self._on:
            sys.stderr.write("\n")
