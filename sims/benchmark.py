"""How long a tick takes, resolver by resolver, on the cells' own stacks."""

from __future__ import annotations

import time

import numpy as np

from robots import racer
from sims.resolvers import make_resolver, resolver_names
from sims.welding.parts import Part, parts
from wbc import Controller, Robot
from wbc.arrays import Array

__all__ = ["measure", "tick_times"]

WARM_UP = 50


def measure(ticks: int) -> str:
    """A table of median and 99th percentile of one tick, Python call to return [us]."""
    arm = racer.load()
    jobs = parts(arm)
    lines = [f"{'stack':<28} {'resolver':<18} {'median us':>10} {'p99 us':>10}"]
    for part in jobs:
        size = f"{len(part.hierarchy)} levels, {arm.nv} axes"
        for name in resolver_names():
            spent = tick_times(arm, part, name, ticks) * 1e6
            median, late = np.median(spent), np.percentile(spent, 99)
            stack = f"{part.name}: {size}"
            lines.append(f"{stack:<28} {name:<18} {median:>10.0f} {late:>10.0f}")
    return "\n".join(lines)


def tick_times(robot: Robot, part: Part, resolver: str, ticks: int) -> Array:
    """Time (ticks,) of each controller call along the job's own motion [s]."""
    controller = Controller(robot, part.hierarchy, make_resolver(resolver))
    q, v = part.start.copy(), np.zeros(robot.nv)
    spent = np.zeros(ticks + WARM_UP)
    for tick in range(spent.size):
        t = tick * controller.dt
        if part.script is not None:
            part.script(t)
        began = time.perf_counter()
        solution = controller(q, v, t)
        spent[tick] = time.perf_counter() - began
        v = v + controller.dt * solution.acceleration
        q = q + controller.dt * v
    return spent[WARM_UP:]
