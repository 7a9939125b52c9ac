"""The cells' own stacks, each with a short run of its cell under `hqp`.

Scripts are the cells' own: they go by time and by what tasks felt, which a replay
repeats.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from itertools import chain

import mujoco
import numpy as np

from benchmarks.cut import cut
from benchmarks.recording import PERIOD, Recording, Stack, play
from robots import racer
from sims import constraints, contact, grasping, welding
from sims.cell import ArmCell
from sims.constraints import hybrid, joint_limit, plane, singular
from sims.contact.crank import SUNK, Turning, believed_cranks, handle
from sims.contact.demo import PEGS, UP, Phase, posture_at
from sims.contact.peg import ABOVE, Insertion, Search, believed_holes
from sims.contact.scene import HOLE
from sims.grasping.cases import seeded_cases
from sims.grasping.job import Job
from sims.grasping.rim import RimGrasp
from sims.welding.parts import parts

__all__ = ["STACKS", "record"]

STACKS = {
    "welding: seam": "6 axes, 6 levels",
    "welding: curve": "6 axes, 6 levels",
    "cutting: knife arm": "7 axes, 4 levels",
    "cutting: pulling arm": "7 axes, 4 levels",
    "cutting: both arms": "14 axes, 5 levels",
    "constraints: plane_reach": "6 axes, 5 levels",
    "constraints: on_plane": "6 axes, 6 levels",
    "constraints: joint_limit_qp": "6 axes, 4 levels",
    "constraints: singular_elbow": "6 axes, 4 levels",
    "constraints: hybrid": "6 axes, 5 levels",
    "grasping: rim": "6 axes, 4 levels",
    "contact: peg, search": "6 axes, 4 levels",
    "contact: peg, insertion": "6 axes, 4 levels",
    "contact: crank": "6 axes, 4 levels",
}
"""Names of the stacks, and their size."""


@lru_cache(maxsize=1)
def record(name: str, ticks: int) -> Recording:
    """A run of the cell from its start, of so many ticks at most.

    Args:
        name: of a stack in `STACKS`.
        ticks: at most.
    """
    cell, _, stack = name.partition(": ")
    return RECORDERS[cell](stack, ticks)


def _weld(name: str, ticks: int) -> Recording:
    arm = racer.load()
    part = next(part for part in parts(arm) if part.name == name)

    def make() -> Stack:
        anew = next(part for part in parts(arm) if part.name == name)
        return Stack(arm, anew.hierarchy, anew.script)

    cell = welding.cell(arm)
    cell.reset(part.start)
    return Recording(make, play(cell, make(), ticks))


def _constrain(name: str, ticks: int) -> Recording:
    arm = racer.load("probe")
    families = (plane, joint_limit, hybrid, singular)
    cases = chain.from_iterable(family.cases(arm) for family in families)
    case = next(case for case in cases if case.name == name)
    cell = constraints.cell(arm)
    off = int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    cell.model.opt.disableflags = 0 if case.contact else off
    cell.reset(case.start)
    q = cell.observe().q
    ticks = min(ticks, round(case.duration / PERIOD))

    def make() -> Stack:
        return Stack(case.robot or arm, *case.make(q, 0.0))

    return Recording(make, play(cell, make(), ticks))


def _grasp(name: str, ticks: int) -> Recording:
    """The first cylinder; fingers move in the recorded run alone."""
    del name
    arm = racer.load("gripper")
    (case,) = seeded_cases(arm, 0, 1)
    cell = grasping.cell(arm, case.cylinder)
    cell.reset(case.start)
    job = Job(arm, cell, case.cylinder, grasping.GOAL, case.start)

    def make() -> Stack:
        line, flipped = job.timeline, job.plan.flipped
        rim = RimGrasp(line.at(0.0), case.cylinder.rim, flipped=flipped)
        return Stack(arm, rim.hierarchy, lambda t: rim.follow(line.at(t)))

    own = Stack(arm, job.rim.hierarchy, job.script)
    return Recording(make, play(cell, own, ticks, job.watch))


def _contact(name: str, ticks: int) -> Recording:
    """The peg that must search longest, or the first crank."""
    arm = racer.load("peg")
    cell = contact.cell(arm)
    if name == "crank":
        (belief,) = believed_cranks(0, 1)
        start = handle() - SUNK * UP
        cell.reset(posture_at(arm, start))
        return _phase(cell, lambda: Turning(belief, start), ticks)
    hole = max(believed_holes(0, PEGS), key=lambda p: float(np.linalg.norm(p - HOLE)))
    cell.reset(posture_at(arm, hole + ABOVE * UP))
    if name == "peg, search":
        return _phase(cell, lambda: Search(hole), ticks)
    search = Search(hole)
    stack = Stack(arm, search.hierarchy, search.script)
    play(cell, stack, round(search.duration / PERIOD), search.watch)
    return _phase(cell, lambda: Insertion(search.surface), ticks)


def _phase(cell: ArmCell, phase: Callable[[], Phase], ticks: int) -> Recording:
    def stack(of: Phase) -> Stack:
        return Stack(cell.robot, of.hierarchy, of.script)

    own = phase()
    ticks = min(ticks, round(own.duration / PERIOD))
    return Recording(lambda: stack(phase()), play(cell, stack(own), ticks, own.watch))


RECORDERS: dict[str, Callable[[str, int], Recording]] = {
    "welding": _weld,
    "cutting": cut,
    "constraints": _constrain,
    "grasping": _grasp,
    "contact": _contact,
}
"""From a stack's name and the longest run [ticks] to its recording."""
