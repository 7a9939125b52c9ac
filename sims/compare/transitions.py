"""Tasks added, replaced, re-ranked and removed at run time: how fast torques change."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias, final

import numpy as np

from robots import racer
from sims import welding
from sims.log import Log
from sims.metrics import Metric
from sims.resolvers import make_resolver
from sims.run import run
from sims.welding.parts import READY, TIP
from tasks import (
    Damping,
    FrameOrientation,
    FramePosition,
    JointLimits,
    Posture,
    TorqueLimits,
    TorqueRateLimits,
)
from wbc import Controller, Hierarchy, Robot
from wbc.arrays import Array

__all__ = ["LIMIT", "MODES", "Passage", "bars", "passages"]

LIMIT = 1000.0
"""Torque rate at which industrial arms stop [Nm/s]."""
OVER = 0.3
"""Duration of a ramp [s]."""
BEGIN, EVERY = 0.4, 0.7
"""When the first change comes, and the time between two [s]."""
HURRY = 0.05
"""Between changes that come while another one is under way [s]."""
Show: TypeAlias = Callable[[str], None]
Event: TypeAlias = tuple[str, float, Hierarchy]


@final
@dataclass(frozen=True, slots=True)
class Mode:
    """How a change is made.

    Attributes:
        name: of the mode.
        over: duration of its ramp [s].
        limited: whether a `TorqueRateLimits` stands in the hierarchies.
    """

    name: str
    over: float
    limited: bool


MODES = (
    Mode("ramped", OVER, limited=False),
    Mode("at once", 0.0, limited=False),
    Mode("at once, rate limited", 0.0, limited=True),
)


@final
@dataclass(frozen=True, slots=True, eq=False)
class Passage:
    """A run through all changes.

    Attributes:
        resolver, mode: names.
        log: of the run.
        rate: (T - 1,) largest torque rate of any joint, from tick to tick [Nm/s].
        worst: (event, rate) largest rate from one change to the next [Nm/s].
    """

    resolver: str
    mode: str
    log: Log
    rate: Array
    worst: tuple[tuple[str, float], ...]


def passages(
    resolvers: Sequence[str], seed: int = 0, show: Show = lambda _: None
) -> list[Passage]:
    """Run the welding arm through all changes, by every resolver in every mode."""
    arm = racer.load()
    found = []
    for name in resolvers:
        for mode in MODES:
            show(f"{name}, {mode.name}")
            found.append(_pass(arm, name, mode, seed))
    return found


def bars(found: Sequence[Passage]) -> list[Metric]:
    """Largest torque rates; ramped and rate-limited ones below what stops an arm."""
    judged = []
    for passage in found:
        key = f"{passage.resolver}_{passage.mode}".replace(":", "_").replace(",", "")
        bound = None if passage.mode == "at once" else LIMIT * (1.0 + 1e-9)
        name = f"{key.replace(' ', '_')}_torque_rate_max_nm_s"
        judged.append(Metric(name, float(passage.rate.max()), bound))
    failures = sum(passage.log.failures for passage in found)
    return [*judged, Metric("solver_failures", failures, 0, "==")]


def events(robot: Robot, limited: bool) -> list[Event]:
    """(name, time [s], hierarchy) of every change, the first one in force from 0."""
    top = TorqueLimits() >> JointLimits(margin=0.02)
    if limited:
        top = top >> TorqueRateLimits(LIMIT)
    F = robot.state(READY).frame(TIP)
    posture, rest = Posture(READY, stiffness=100.0), Damping()
    near = FramePosition(TIP, F.p + np.array([0.04, 0.06, 0.02]), name="near")
    far = FramePosition(TIP, F.p + np.array([-0.05, -0.08, 0.05]), name="far")
    aim = FrameOrientation(TIP, F.R, name="aim")
    stacks = [
        ("start", top >> posture),
        ("task added above", top >> near >> posture),
        ("task replaced", top >> far >> posture),
        ("priorities swapped", top >> posture >> far),
        ("swapped back", top >> far >> posture),
        ("level added below", top >> far >> aim >> posture),
        ("levels swapped", top >> aim >> far >> posture),
        ("level removed", top >> aim >> posture),
        ("hurry: replaced", top >> near >> posture),
        ("hurry: swapped", top >> posture >> near),
        ("hurry: removed", top >> rest),
    ]
    listed, t = [], BEGIN
    for name, stack in stacks:
        listed.append((name, 0.0 if name == "start" else t, stack))
        hurried = name.startswith("hurry")
        t += 0.0 if name == "start" else HURRY if hurried else EVERY
    return listed


def _pass(arm: Robot, resolver: str, mode: Mode, seed: int) -> Passage:
    cell = welding.cell(arm, seed=seed)
    cell.reset(READY)
    (_, _, first), *rest = listed = events(arm, mode.limited)
    controller = Controller(arm, first, make_resolver(resolver))
    due = list(rest)

    def script(t: float) -> None:
        if due and t >= due[0][1] - 1e-9:
            controller.change(due.pop(0)[2], mode.over)

    end = listed[-1][1] + EVERY
    log = run(cell, controller, end, script=script, sites=(TIP,))
    rate = np.abs(np.diff(log.torque, axis=0)).max(axis=1) / controller.dt
    return Passage(resolver, mode.name, log, rate, _worst(listed, log.t[1:], rate))


def _worst(listed: list[Event], t: Array, rate: Array) -> tuple[tuple[str, float], ...]:
    """Largest rate between a change and the next one."""
    ends = [begin for _, begin, _ in listed[1:]] + [np.inf]
    found = []
    for (name, begin, _), end in zip(listed, ends, strict=True):
        during = rate[(t >= begin - 1e-9) & (t < end - 1e-9)]
        found.append((name, float(during.max())))
    return tuple(found)
