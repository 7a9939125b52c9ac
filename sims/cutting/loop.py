"""The loop of the cutting cell: one world, one job, one controller a view."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import final

from sims.cutting.cell import CuttingCell
from sims.cutting.job import Job
from sims.cutting.record import Record
from sims.log import Log
from sims.run import CERTIFY_EVERY, Bar, Decision, Watcher, current_probe
from wbc import Controller, Solution

__all__ = ["Run", "run_job"]


@final
class Run:
    """What a cut leaves behind.

    Attributes:
        cell: as it stands at the end.
        logs: one a controller.
        record: what the meat did.
        job: the job, over.
    """

    def __init__(
        self, cell: CuttingCell, logs: list[Log], record: Record, job: Job
    ) -> None:
        self.cell, self.logs, self.record, self.job = cell, logs, record, job


def run_job(
    cell: CuttingCell,
    controllers: Sequence[Controller],
    job: Job,
    longest: float,
    *,
    watch: Watcher | None = None,
    quiet: bool = True,
) -> Run:
    """Run a job to its end, or for `longest` seconds.

    The measurements of `Record` and the certificates are not part of the cell and do
    not count in the time spent.
    """
    dt, probe = cell.model.opt.timestep, current_probe()
    ticks = max(1, round(longest / dt))
    logs = [
        Log(view, controller, ticks, (), world=False)
        for view, controller in zip(cell.views, controllers, strict=True)
    ]
    record, bar, spent = Record(cell, job, ticks), Bar("cutting", ticks, quiet), 0.0
    for tick in range(ticks):
        began = time.process_time()
        goes_on = job.tick(cell.data.time)
        solutions: list[Solution] = []
        times: list[float] = []
        seen = cell.observe()
        for view, controller in zip(seen, controllers, strict=True):
            before = time.perf_counter()
            solutions.append(controller(view.q, view.v, view.t, view.wrenches))
            times.append(time.perf_counter() - before)
        cell.apply([solution.torque for solution in solutions])
        spent += time.process_time() - began
        record.take()
        began = time.process_time()
        for log, view, solution, taken in zip(
            logs, seen, solutions, times, strict=True
        ):
            log.record(tick, view, solution, taken)
        cell.step()
        spent += time.process_time() - began
        if tick % CERTIFY_EVERY == 0:
            _certify(logs, controllers, solutions)
        if probe is not None:
            for view, controller, solution in zip(
                seen, controllers, solutions, strict=True
            ):
                probe(tick, controller, solution, view.q, view.v)
        decisions = list(map(Decision, controllers, seen, solutions))
        if watch is not None and not watch(cell, decisions):
            break
        if not goes_on:
            break
        bar.show(tick + 1)
    bar.close()
    for log in logs:
        log.spent = spent
    record.finish()
    return Run(cell, [log.trimmed() for log in logs], record, job)


def _certify(
    logs: list[Log], controllers: Sequence[Controller], solutions: list[Solution]
) -> None:
    for log, controller, solution in zip(logs, controllers, solutions, strict=True):
        if controller.resolver.name.startswith("hqp") and solution.ok:
            worst = solution.certificate().worst
            log.worst_certificate = max(log.worst_certificate, worst)
