"""The demo of P4 section III: all cases, judged and drawn."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from itertools import chain

import mujoco
import numpy as np

from robots import racer
from sims import constraints
from sims.cell import ArmCell, Cell
from sims.constraints import hybrid, joint_limit, plane, singular
from sims.constraints.case import Case, Trial
from sims.constraints.compared import compared
from sims.constraints.soundness import soundness
from sims.constraints.surface import TIP
from sims.course import Course
from sims.demo import Demo, Options, Outcome
from sims.log import Log, shared_metrics
from sims.metrics import Metric
from sims.report.replay import Arrow, Replay, Trace
from sims.report.snapshot import Image, render
from sims.resolvers import make_resolver
from sims.run import Decision, run
from sims.view import Display, nearer
from wbc import Controller
from wbc.arrays import Array

__all__ = ["DEMO"]

FAMILIES = (plane, joint_limit, hybrid, singular)
"""Modules of cases: each has `cases`, `metrics` and `figures`."""
PAUSE = 0.5
"""Between two runs in the replay [s]."""
SOUND = 1e-9
COLOURS = ("#D55E00", "#009E73", "#CC79A7", "#56B4E9")


class _Touch:
    """Keeps the true contact force of every tick, and passes the tick on."""

    def __init__(self, display: Display) -> None:
        self.force: list[float] = []
        self._display = display

    def __call__(self, cell: Cell, decisions: Sequence[Decision]) -> bool:
        self.force.append(float(cell.data.sensor("touch").data[0]))
        return self._display(cell, decisions)


def _run(options: Options) -> Outcome:
    """Run every case of every family."""
    arm = racer.load("probe")
    cell = constraints.cell(arm, mismatch=options.mismatch, seed=options.seed)
    trials: dict[str, Trial] = {}
    close = nearer(_camera(), 1.4, [0.78, 0, 0.6])
    with Display(view=options.view, video=options.video, camera=close) as display:
        display.attach(cell)
        for case in chain.from_iterable(family.cases(arm) for family in FAMILIES):
            trials[case.name] = display.play(
                f"constraints: {case.name}",
                partial(_try, cell, case, options, display),
            )
    judged = chain.from_iterable(f.metrics(trials, options.mismatch) for f in FAMILIES)
    logs = {name: trial.log for name, trial in trials.items()}
    return Outcome(
        metrics=[*judged, *_safety(trials), *shared_metrics(list(logs.values()))],
        series=_series(trials),
        figures=lambda: [f for family in FAMILIES for f in family.figures(trials)],
        replay=lambda: _replay(cell.model, trials),
        picture=lambda: _picture(cell),
        facts={"robot": repr(arm), "simulated time": _simulated(logs)},
        courses={name: Course.of(log) for name, log in logs.items()},
    )


def _try(cell: ArmCell, case: Case, options: Options, display: Display) -> Trial:
    off = int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    cell.model.opt.disableflags = 0 if case.contact else off
    if case.start is not None:
        cell.reset(case.start)
    make: Callable[[], object] = case.resolver or (
        lambda: make_resolver(options.resolver)
    )
    resolver = make()
    stack = case.make(cell.observe().q, cell.data.time)
    robot, script = case.robot or cell.robot, stack[1]
    controller, touch = Controller(robot, stack[0], resolver), _Touch(display)
    if display.jogger is not None:
        script = display.jogger.over(stack[0], robot, script, cell.data.time)
    log = run(
        cell,
        controller,
        min(case.duration, options.duration or np.inf),
        script=script,
        sites=(TIP,),
        watch=touch,
        label=f"constraints: {case.name}",
        quiet=options.quiet,
    )
    return Trial(case, stack, log, np.array(touch.force), resolver)


def _safety(trials: dict[str, Trial]) -> list[Metric]:
    """What holds for every case: speeds within limits, higher levels undisturbed."""
    speed = max(
        float((np.abs(t.log.v) / t.log.robot.v_max).max()) for t in trials.values()
    )
    disturbed = max(soundness(trial) for trial in trials.values())
    return [
        Metric("joint_speed_max_fraction", speed, 1.0),
        Metric("soundness_relative", disturbed, SOUND),
    ]


def _series(trials: dict[str, Trial]) -> dict[str, Array]:
    named = {f"{name}/touch": trial.touch for name, trial in trials.items()}
    for name, trial in trials.items():
        named |= {f"{name}/{key}": v for key, v in trial.log.arrays().items()}
    return named


def _simulated(logs: dict[str, Log]) -> str:
    return f"{sum(log.t.size for log in logs.values()) * 1e-3:.1f} s"


def _replay(model: mujoco.MjModel, trials: dict[str, Trial]) -> str:
    """All runs in a row, each with the way of the tip, and what the probe presses."""
    times, traces, chapters, begin = [], [], [], 0.0
    for i, (name, trial) in enumerate(trials.items()):
        log = trial.log
        t = begin + log.t - log.t[0]
        times.append(t)
        chapters.append((name, begin))
        way, colour = log.p[TIP][::20], COLOURS[i % len(COLOURS)]
        traces.append(Trace(f"tip: {name}", way, colour, 0.004, t[::20], listed=False))
        begin = t[-1] + PAUSE
    logs = [trial.log for trial in trials.values()]
    tips = np.concatenate([log.p[TIP] for log in logs])
    forces = np.concatenate([_felt(trial) for trial in trials.values()])
    return Replay(
        model,
        np.concatenate(times),
        np.concatenate([log.qpos for log in logs]),
        traces=traces,
        arrows=[Arrow("probe on plate", tips, forces, ends=True)],
        chapters=chapters,
        camera=_camera(),
    ).html()


def _felt(trial: Trial) -> Array:
    """Force (T, 3) of the probe on the plate [N]; none where it cannot touch it."""
    wrench = trial.log.wrenches["wrist"]
    return wrench[:, :3] * float(trial.case.contact)


def _picture(cell: ArmCell) -> Image:
    """The cell as it stands at the end."""
    return render(cell.model, cell.data, _camera(), 1280, 800)


def _camera() -> mujoco.MjvCamera:
    """From the side, so that the plate's tilt shows."""
    camera = mujoco.MjvCamera()
    camera.azimuth, camera.elevation, camera.distance = 118.0, -16.0, 2.4
    camera.lookat[:] = [0.55, 0.0, 0.55]
    return camera


DEMO = Demo(
    "constraints",
    "planes, joint limits and hybrid force: the paper's constraints, one by one",
    _run,
    compared=compared,
)
