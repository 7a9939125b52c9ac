"""The grasping demo: all cases, judged and drawn."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import partial

import numpy as np

from robots import racer
from sims import grasping
from sims.cell import ArmCell, Cell
from sims.course import Course
from sims.demo import Demo, Options, Outcome
from sims.grasping.cases import COUNT, Case, seeded_cases
from sims.grasping.figures import figures
from sims.grasping.gallery import camera, replay
from sims.grasping.job import Job
from sims.grasping.metrics import OBJECT, Result, metrics
from sims.grasping.plan import TCP
from sims.grasping.scene import GOAL
from sims.grasping.touch import Touch
from sims.log import shared_metrics
from sims.report.snapshot import Image, render
from sims.resolvers import make_resolver
from sims.run import Decision, run
from sims.view import Display, nearer
from wbc import Controller, Robot

__all__ = ["DEMO", "run_cases"]

LONGEST = 30.0
"""Time after which a job has failed [s]."""


def run_cases(options: Options, count: int = COUNT) -> Outcome:
    """Grasp the first `count` cylinders of the seed, one after another."""
    arm = racer.load("gripper")
    results = []
    close = nearer(camera(), 1.5, [0.68, 0.06, 0.52])
    with Display(view=options.view, video=options.video, camera=close) as display:
        for case in seeded_cases(arm, options.seed, count):
            cell = grasping.cell(
                arm, case.cylinder, mismatch=options.mismatch, seed=options.seed
            )
            display.attach(cell)
            job = partial(_grasp, arm, cell, case, options, display)
            results.append(display.play(f"grasping {case.cylinder.name}", job))
    series = {
        f"{index + 1}/{name}": values
        for index, result in enumerate(results)
        for name, values in result.log.arrays().items()
    }
    logs = [result.log for result in results]
    simulated = sum(log.t.size for log in logs) * 1e-3
    return Outcome(
        metrics=[
            *metrics(results, make_resolver(options.resolver)),
            *shared_metrics(logs),
        ],
        series=series,
        figures=lambda: figures(results),
        replay=lambda: replay(results),
        picture=lambda: _picture(cell),
        facts={"robot": repr(arm), "simulated time": f"{simulated:.1f} s"},
        courses={r.job.cylinder.name: Course.of(r.log) for r in results},
    )


def _grasp(
    arm: Robot, cell: ArmCell, case: Case, options: Options, display: Display
) -> Result:
    cell.reset(case.start)
    job = Job(arm, cell, case.cylinder, GOAL, case.start)

    touch = Touch(cell.model)

    def watch(cell: Cell, decisions: Sequence[Decision]) -> bool:
        touch.see(cell.data)
        return display(cell, decisions) and job.watch(cell, decisions)

    log = run(
        cell,
        Controller(arm, job.rim.hierarchy, make_resolver(options.resolver)),
        min(LONGEST, options.duration or np.inf),
        script=job.script,
        sites=(TCP, OBJECT),
        watch=watch,
        label=f"grasping {case.cylinder.name}",
        quiet=options.quiet,
    )
    if job.failed and options.duration is None:
        sys.stderr.write(f"wbc: {job.report}\n")
    return Result(job, log, touch)


def _picture(cell: ArmCell) -> Image:
    """The cell as it stands at the end."""
    return render(cell.model, cell.data, camera(), 1280, 800)


DEMO = Demo(
    "grasping",
    "a 6-axis arm takes cylinders by the rim, lifts, carries and places them",
    run_cases,
)
