"""Where the time of our tick goes: Pinocchio, rows, solver, the rest."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from benchmarks.jobs import Job
from benchmarks.tables import late, median, micro, ratio, table
from benchmarks.ticks import arm_job
from benchmarks.workers.loop import Loop
from benchmarks.workers.ours import open_loop

__all__ = ["breakdown_table"]

Call = Callable[[], object]


def breakdown_table(quick: bool, folder: Path) -> str:
    """Parts of a tick of `hqp`, each timed alone in the middle of a motion."""
    jobs = {
        "one arm": arm_job("breakdown", 1, folder),
        "two arms": arm_job("breakdown", 2, folder),
        "five levels": arm_job("breakdown", 1, folder, split=True),
    }
    rows = []
    for name, job in list(jobs.items())[: 1 if quick else 3]:
        rows += _rows(name, job, 50 if quick else 3000)
    head = ("part of a tick", "median us", "p99", "share")
    return table("Breakdown of our tick (hqp), in the middle of a motion", head, rows)


def _rows(name: str, job: Job, repeats: int) -> list[list[str]]:
    loop = open_loop(job, "hqp")
    loop.run(300)
    targets = loop.targets(loop.done * job.dt)
    loop.contender.aim(loop.done * job.dt, targets)
    whole = {"whole tick": lambda: loop.contender.tick(loop.q, loop.v)}
    times = _interleaved({**whole, **_parts(loop)}, repeats)
    total = median(times["whole tick"])
    rows = [
        [f"{name}: {part}", micro(median(t)), micro(late(t)), ratio(median(t), total)]
        for part, t in times.items()
    ]
    inside = [median(t) for part, t in times.items() if part.startswith("- ")]
    rest = total - sum(inside) if inside else float("nan")
    floor = {"of Pinocchio's part, its own calls": _floor(loop)}
    alone = median(_interleaved(floor, repeats)[next(iter(floor))])
    rows.append([f"{name}: - the rest: Python", micro(rest), "", ratio(rest, total)])
    rows.append([f"{name}: ({next(iter(floor))})", micro(alone), "", ""])
    return rows


def _parts(loop: Loop) -> dict[str, Call]:
    """The steps of `Controller.__call__`; the one place that knows its inside."""
    contender: Any = loop.contender
    controller = contender.controller
    try:
        state, stack = controller._state, controller._stack
        q, v, t = loop.q, loop.v, contender.t
        found = np.empty(stack.parts.ranks.stop)
        return {
            "- pin: State.refresh": lambda: state.refresh(q, v, t),
            "- compiled: rows, solver, torque": lambda: stack.run(state, found),
        }
    except AttributeError:
        return {}


def _floor(loop: Loop) -> Call:
    """What no controller can do without: M, h, and every tip's pose, J and drift."""
    model, data, q, v = loop.model, loop.model.createData(), loop.q, loop.v
    zero, world = np.zeros(model.nv), pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    tips = [model.getFrameId(tip) for tip in loop.job.tips]

    def calls() -> None:
        pin.crba(model, data, q)
        pin.nonLinearEffects(model, data, q, v)
        pin.forwardKinematics(model, data, q, v, zero)
        pin.computeJointJacobians(model, data, q)
        for tip in tips:
            pin.updateFramePlacement(model, data, tip)
            pin.getFrameJacobian(model, data, tip, world)
            pin.getFrameClassicalAcceleration(model, data, tip, world)

    return calls


def _interleaved(calls: dict[str, Call], repeats: int) -> dict[str, list[int]]:
    """Time of every call, all in turn [ns]."""
    times: dict[str, list[int]] = {name: [] for name in calls}
    clock = time.perf_counter_ns
    gc.collect()
    gc.disable()
    try:
        for _ in range(repeats):
            for name, call in calls.items():
                began = clock()
                call()
                times[name].append(clock() - began)
    finally:
        gc.enable()
    return times
