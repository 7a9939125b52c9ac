"""The cutting demo: one animal cut apart, judged and drawn."""

from __future__ import annotations

import sys
from dataclasses import replace
from functools import partial
from typing import get_args

from sims.course import Course
from sims.cutting.cell import CuttingCell
from sims.cutting.compared import compared
from sims.cutting.correction import Experiment
from sims.cutting.figures import figures
from sims.cutting.loop import Run, run_job
from sims.cutting.meat import Meat
from sims.cutting.metrics import metrics
from sims.cutting.pictures import camera, describe, guide_line, picture
from sims.cutting.playback import replay
from sims.cutting.scene import PLACE
from sims.cutting.trial import Trial
from sims.demo import Demo, Options, Outcome
from sims.log import shared_metrics
from sims.metrics import Metric
from sims.mismatch import Mismatch
from sims.view import Display, nearer
from wbc import UnknownName
from wbc.arrays import Array

__all__ = ["DEMO", "EXPERIMENTS", "trial_of"]

FASTER = 1.5
"""Than real time, on one core."""
EXPERIMENTS: tuple[Experiment, ...] = get_args(Experiment)


def trial_of(options: Options) -> Trial:
    """The trial that the user asked for.

    Raises:
        UnknownName: no such experiment.
    """
    chosen = options.experiment or EXPERIMENTS[0]
    if chosen not in EXPERIMENTS:
        raise UnknownName("experiment", chosen, EXPERIMENTS)
    return Trial(
        Meat.generate(options.seed, place=PLACE),
        experiment=chosen,
        resolver=options.resolver,
        combined=options.combined,
        mismatch=Mismatch(seed=options.seed) if options.mismatch else None,
    )


def _run(options: Options) -> Outcome:
    """Cut one animal apart."""
    trial = trial_of(options)
    cell = trial.cell()
    close = nearer(camera(), 1.1, [0.45, 0.20, 0.40])
    with Display(view=options.view, video=options.video, camera=close) as display:
        display.attach(cell)
        run = display.play("cutting", partial(_cut, trial, cell, options, display))
    if run.job.stopped is not None:
        sys.stderr.write(f"wbc: the cut was stopped: {run.job.stopped}\n")
    own = metrics(run, trial.experiment, len(trial.plan.depths))
    return Outcome(
        metrics=[*own, *map(_in_time, shared_metrics(run.logs))],
        series=_series(run),
        figures=lambda: figures(run),
        replay=lambda: replay(run),
        picture=lambda: picture(run),
        facts=_facts(run, trial),
        courses={log.robot.name: Course.of(log) for log in run.logs},
    )


def _cut(trial: Trial, cell: CuttingCell, options: Options, display: Display) -> Run:
    controllers, job = trial.start(cell)
    display.add(partial(guide_line, job, trial.meat))
    longest = options.duration or trial.longest
    return run_job(cell, controllers, job, longest, watch=display, quiet=options.quiet)


def _in_time(metric: Metric) -> Metric:
    """The cell's own bound on the real-time factor."""
    if metric.name != "realtime_factor":
        return metric
    return replace(metric, bound=FASTER)


def _series(run: Run) -> dict[str, Array]:
    joints = {
        f"{log.robot.name}/{name}": values
        for log in run.logs
        for name, values in log.arrays().items()
    }
    return joints | run.record.arrays()


def _facts(run: Run, trial: Trial) -> dict[str, str]:
    return {
        "experiment": trial.experiment,
        "robots": ", ".join(log.robot.name for log in run.logs),
        "world": describe(run.cell),
        "simulated time": f"{run.record.t[-1]:.1f} s",
        "ended": run.job.stopped or _ending(run),
    }


def _ending(run: Run) -> str:
    done = run.job.passages.completed
    how = "separated" if run.cell.tissue.separated else "not separated"
    return f"{how}, {done} passages"


DEMO = Demo(
    "cutting",
    "two 7-axis arms cut deformable meat apart along a guide line",
    _run,
    EXPERIMENTS,
    compared=compared,
    combined=True,
)
