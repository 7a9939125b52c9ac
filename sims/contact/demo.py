"""The contact demo: pegs and cranks, judged and drawn."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import partial
from typing import Final, Protocol

import mujoco
import numpy as np

from robots import racer
from sims import contact
from sims.cell import ArmCell, Cell
from sims.constraints.case import READY
from sims.contact.compared import compared
from sims.contact.crank import SUNK, Belief, Turning, believed_cranks, handle
from sims.contact.figures import figures
from sims.contact.peg import ABOVE, DOWN, Insertion, Search, Stay, believed_holes
from sims.contact.results import Attempt, Crank, metrics
from sims.contact.scene import CRANK_JOINT, TIP
from sims.course import Course
from sims.demo import Demo, Options, Outcome
from sims.log import Log, shared_metrics
from sims.report.replay import Arrow, Replay, Trace
from sims.report.snapshot import render
from sims.resolvers import make_resolver
from sims.run import Decision, run
from sims.view import Display, nearer
from tasks import FramePose
from wbc import Controller, Hierarchy, InputError, Robot, solve_pose
from wbc.arrays import Array

__all__ = ["DEMO", "run_jobs"]

PEGS: Final = 20
CRANKS: Final = 3
SHOWN: Final = 4
"""Attempts that the replay shows."""
PAUSE: Final = 0.5
"""Between two runs in the replay [s]."""
UP: Final = np.array([0.0, 0.0, 1.0])
MARGIN: Final = 0.05
"""Kept from the joint limits at the start [rad]."""


class Phase(Protocol):
    """A stack with what moves its targets."""

    hierarchy: Hierarchy
    duration: float

    def script(self, t: float) -> None:
        """Move the targets to time t [s]."""

    def watch(self, cell: Cell, decisions: Sequence[Decision]) -> bool:
        """False once the phase is over."""


def run_jobs(options: Options, pegs: int = PEGS, cranks: int = CRANKS) -> Outcome:
    """Search for the hole `pegs` times and turn the crank `cranks` times.

    Each time with another belief of where it is.
    """
    arm = racer.load("peg")
    cell = contact.cell(arm, mismatch=options.mismatch, seed=options.seed)
    close = nearer(_camera(), 1.0, [0.82, 0, 0.5])
    with Display(view=options.view, video=options.video, camera=close) as display:
        display.attach(cell)
        attempts = [
            display.play(
                f"contact: peg {i}", partial(_attempt, cell, hole, options, display)
            )
            for i, hole in enumerate(believed_holes(options.seed, pegs), 1)
        ]
        turned = [
            display.play(
                f"contact: crank {i}", partial(_turn, cell, belief, options, display)
            )
            for i, belief in enumerate(believed_cranks(options.seed, cranks), 1)
        ]
    logs = _named(attempts, turned)
    simulated = sum(log.t.size for log in logs.values()) * 1e-3
    return Outcome(
        metrics=[
            *metrics(attempts, turned),
            *shared_metrics(list(logs.values())),
        ],
        series={
            f"{job}/{name}": values
            for job, log in logs.items()
            for name, values in log.arrays().items()
        },
        figures=lambda: figures(attempts, turned),
        replay=lambda: _replay(cell.model, attempts, turned),
        picture=lambda: render(cell.model, cell.data, _camera(), 1280, 800),
        facts={"robot": repr(arm), "simulated time": f"{simulated:.1f} s"},
        courses=_courses(attempts, turned),
    )


def _attempt(cell: ArmCell, hole: Array, options: Options, display: Display) -> Attempt:
    cell.reset(posture_at(cell.robot, hole + ABOVE * UP))
    search = Search(hole)
    logs = [_run(cell, search, options, display, "search")]
    if not search.sunk:
        if options.duration is None:
            sys.stderr.write(f"wbc: {search.report}\n")
        return Attempt(hole, search, None, tuple(logs))
    insertion = Insertion(search.surface)
    logs.append(_run(cell, insertion, options, display, "insert"))
    logs.append(_run(cell, Stay(insertion.end), options, display, "stay"))
    return Attempt(hole, search, insertion, tuple(logs))


def _turn(cell: ArmCell, belief: Belief, options: Options, display: Display) -> Crank:
    start = handle() - SUNK * UP
    cell.reset(posture_at(cell.robot, start))
    turning = Turning(belief, start)
    log = _run(cell, turning, options, display, "crank")
    place = cell.model.jnt_qposadr[cell.model.joint(CRANK_JOINT).id]
    return Crank(turning, log, log.qpos[:, place])


def _run(
    cell: ArmCell, phase: Phase, options: Options, display: Display, label: str
) -> Log:
    def watch(cell: Cell, decisions: Sequence[Decision]) -> bool:
        return display(cell, decisions) and phase.watch(cell, decisions)

    return run(
        cell,
        Controller(cell.robot, phase.hierarchy, make_resolver(options.resolver)),
        min(phase.duration, options.duration or np.inf),
        script=phase.script,
        sites=(TIP,),
        watch=watch,
        label=f"contact: {label}",
        quiet=options.quiet,
    )


def posture_at(robot: Robot, p: Array) -> Array:
    """A posture (n,) with the peg's end at p (3,) and the peg upright.

    Raises:
        InputError: out of reach.
    """
    found = solve_pose(robot, FramePose(TIP, p, DOWN), READY, margin=MARGIN, quick=True)
    if not found.ok:
        raise InputError(f"the peg does not get to {p}: {found}")
    return found.q


def _named(attempts: list[Attempt], cranks: list[Crank]) -> dict[str, Log]:
    named = {f"crank {i + 1}": crank.log for i, crank in enumerate(cranks)}
    for i, attempt in enumerate(attempts):
        phases = zip(("search", "insertion", "stay"), attempt.logs, strict=False)
        named |= {f"peg {i + 1} {phase}": log for phase, log in phases}
    return named


def _courses(attempts: list[Attempt], cranks: list[Crank]) -> dict[str, Course]:
    """Of every attempt, its phases in a row, and of every crank."""
    courses = {f"peg {i + 1}": Course.of(*a.logs) for i, a in enumerate(attempts)}
    return courses | {
        f"crank {i + 1}": Course.of(crank.log) for i, crank in enumerate(cranks)
    }


def _replay(model: mujoco.MjModel, attempts: list[Attempt], cranks: list[Crank]) -> str:
    """Some attempts and a crank in a row, each with the way of the peg's end."""
    shown = _named(attempts[:SHOWN], [])
    shown |= _named([], cranks[:1])
    times, traces, chapters, begin = [], [], [], 0.0
    for name, log in shown.items():
        t = begin + log.t - log.t[0]
        times.append(t)
        chapters.append((name, begin))
        turns = name.startswith("crank")
        way, colour = log.p[TIP][::20], "#0072B2" if turns else "#D55E00"
        traces.append(Trace(name, way, colour, 0.0015, t[::20], listed=False))
        begin = t[-1] + (PAUSE if turns or name.endswith("stay") else 0.01)
    states, tips, wrenches = (
        np.concatenate(parts)
        for parts in zip(
            *((g.qpos, g.p[TIP], g.wrenches["wrist"]) for g in shown.values()),
            strict=True,
        )
    )
    push = Arrow("peg on block and crank", tips, wrenches[:, :3], ends=True)
    return Replay(
        model,
        np.concatenate(times),
        states,
        traces=traces,
        arrows=[push],
        chapters=chapters,
        camera=_camera(),
    ).html()


def _camera() -> mujoco.MjvCamera:
    """From the operator's side, near enough to see both holes."""
    camera = mujoco.MjvCamera()
    camera.azimuth, camera.elevation, camera.distance = 58.0, -24.0, 1.7
    camera.lookat[:] = [0.72, 0.0, 0.52]
    return camera


DEMO = Demo(
    "contact",
    "a peg finds its hole by force, and a crank is turned that is hardly known",
    run_jobs,
    compared=compared,
)
