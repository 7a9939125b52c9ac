"""The welding demo: all jobs, judged and drawn."""

from __future__ import annotations

from functools import partial

import mujoco
import numpy as np

from robots import racer
from sims import welding
from sims.cell import ArmCell
from sims.course import Course
from sims.demo import Demo, Options, Outcome
from sims.log import Log, shared_metrics
from sims.report.replay import Arrow, Replay, Trace
from sims.report.snapshot import Image, render
from sims.resolvers import make_resolver
from sims.run import run
from sims.view import Display, nearer
from sims.welding.figures import figures
from sims.welding.metrics import metrics
from sims.welding.parts import TIP, Part, parts
from sims.welding.workpiece import CURVE, SEAM
from wbc import Controller

__all__ = ["DEMO"]

PAUSE = 0.5
"""Between two jobs in the replay [s]."""
MILLI = 1e3


def _run(options: Options) -> Outcome:
    """Weld a spot, a seam with and without jogging, and a saddle."""
    arm = racer.load()
    cell = welding.cell(arm, mismatch=options.mismatch, seed=options.seed)
    logs: dict[str, Log] = {}
    close = nearer(_camera(), 1.2, [0.78, 0.06, 0.50])
    with Display(view=options.view, video=options.video, camera=close) as display:
        display.attach(cell)
        for part in parts(arm, display.jogger):
            logs[part.name] = display.play(
                f"welding: {part.name}", partial(_weld, cell, part, options, display)
            )
    series = {
        f"{part}/{name}": values
        for part, log in logs.items()
        for name, values in log.arrays().items()
    }
    shown = {name: log for name, log in logs.items() if name != "seam_still"}
    return Outcome(
        metrics=[
            *metrics(logs, options.mismatch),
            *shared_metrics(list(logs.values())),
        ],
        series=series,
        figures=lambda: figures(logs),
        replay=lambda: _replay(cell.model, shown),
        picture=lambda: _picture(cell),
        facts={"robot": repr(arm), "simulated time": _simulated(logs)},
        courses={name: Course.of(log) for name, log in logs.items()},
    )


def _weld(cell: ArmCell, part: Part, options: Options, display: Display) -> Log:
    cell.reset(part.start)
    controller = Controller(cell.robot, part.hierarchy, make_resolver(options.resolver))
    duration = min(part.duration, options.duration or np.inf)
    return run(
        cell,
        controller,
        duration,
        script=part.script,
        sites=(TIP,),
        watch=display,
        label=f"welding: {part.name}",
        quiet=options.quiet,
    )


def _simulated(logs: dict[str, Log]) -> str:
    return f"{sum(log.t.size for log in logs.values()) * 1e-3:.1f} s"


def _replay(model: mujoco.MjModel, logs: dict[str, Log]) -> str:
    """All jobs in a row, with what the tip has welded growing as it goes."""
    times, traces, chapters, begin = [], [], [], 0.0
    for name, log in logs.items():
        t = begin + log.t - log.t[0]
        times.append(t)
        chapters.append((name, begin))
        bead = log.p[TIP][::20]
        way = "way of the tip" if not begin else f"tip: {name}"
        traces.append(Trace(way, bead, "#D55E00", 0.006, t[::20], listed=not begin))
        begin = t[-1] + PAUSE
    lines = [np.array([SEAM.at(s).c[0] for s in (0.0, SEAM.length)])]
    lines.append(np.array([CURVE.at(s).c[0] for s in np.linspace(0, CURVE.length, 60)]))
    for name, line in zip(("seam", "saddle"), lines, strict=True):
        traces.append(Trace(name, line, "#0072B2", 0.003))
    tips = [log.p[TIP] for log in logs.values()]
    dt = model.opt.timestep
    speeds = [np.diff(p, axis=0, prepend=p[:1]) / dt * MILLI for p in tips]
    drawn = np.concatenate(tips), np.concatenate(speeds)
    return Replay(
        model,
        np.concatenate(times),
        np.concatenate([log.qpos for log in logs.values()]),
        traces=traces,
        arrows=[Arrow("speed of the tip", *drawn, "mm/s")],
        chapters=chapters,
        camera=_camera(),
    ).html()


def _picture(cell: ArmCell) -> Image:
    """The cell as it stands at the end."""
    return render(cell.model, cell.data, _camera(), 1280, 800)


def _camera() -> mujoco.MjvCamera:
    """From the operator's side, where seam and saddle can be seen."""
    camera = mujoco.MjvCamera()
    camera.azimuth, camera.elevation, camera.distance = 62.0, -22.0, 2.5
    camera.lookat[:] = [0.55, 0.08, 0.55]
    return camera


DEMO = Demo(
    "welding",
    "a 6-axis arm welds a spot, a straight seam and a pipe saddle",
    _run,
)
