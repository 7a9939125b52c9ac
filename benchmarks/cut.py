"""The stacks of the cutting cell, with the first seconds of a cut."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

from benchmarks.recording import PERIOD, Recording, Script, Stack, Tape
from benchmarks.workers.loop import Array, Instant
from sims.cell import Cell
from sims.cutting.layout import Plan
from sims.cutting.loop import run_job
from sims.cutting.pull import Pull
from sims.cutting.stacks import Stacks, stacks
from sims.cutting.stroke import KnifeTarget
from sims.cutting.trial import Trial
from sims.run import Decision
from wbc import Robot

__all__ = ["cut"]


class Cut(NamedTuple):
    """What is left of a recorded cut.

    The knife's targets come from a camera and a simulated muscle, so they are kept;
    the pull follows the grip's place, as it does in the cell until the muscles part.
    """

    robots: tuple[Robot, ...]
    tracks: list[list[Instant]]
    targets: list[KnifeTarget]
    grip: Array
    plan: Plan


def cut(name: str, ticks: int) -> Recording:
    """The knife arm's, the pulling arm's, or both arms' part of a cut.

    Args:
        name: "knife arm", "pulling arm" or "both arms".
        ticks: of the run.
    """
    whole = _cut(name == "both arms", ticks)
    mine = 1 if name == "pulling arm" else 0
    postures = {
        robot.name: track[0].q
        for robot, track in zip(whole.robots, whole.tracks, strict=True)
    }

    def make() -> Stack:
        made = stacks(whole.robots, postures)
        knife, pull = _knife(made, whole), _pull(made, whole)
        scripts = {"knife arm": [knife], "pulling arm": [pull]}.get(name, [knife, pull])
        return Stack(whole.robots[mine], made.hierarchies[mine], _all(scripts))

    return Recording(make, whole.tracks[mine])


@lru_cache(maxsize=1)
def _cut(combined: bool, ticks: int) -> Cut:
    trial = Trial(combined=combined)
    cell, controllers, job = trial.prepare()
    tape, targets = Tape(), []

    def watch(cell: Cell, decisions: Sequence[Decision]) -> bool:
        targets.append(job.passages.target)
        return tape(cell, decisions)

    done = run_job(cell, controllers, job, ticks * PERIOD, watch=watch)
    robots = tuple(controller.robot for controller in controllers)
    return Cut(robots, tape.tracks, targets, done.record.grip, trial.plan)


def _knife(made: Stacks, whole: Cut) -> Script:
    targets = iter(whole.targets)
    return lambda t: made.knife.set_target(*next(targets))


def _pull(made: Stacks, whole: Cut) -> Script:
    pull = Pull(made.pull, whole.grip[0], whole.plan.pull)
    heights = iter(whole.grip[:, 1].tolist())
    return lambda t: pull.tick(t, next(heights))


def _all(scripts: Sequence[Script]) -> Script:
    def script(t: float) -> None:
        for one in scripts:
            one(t)

    return script
