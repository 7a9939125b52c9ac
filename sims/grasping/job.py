"""One job: take a cylinder by the rim, lift it, carry it, put it down, let go."""

from __future__ import annotations

from collections.abc import Sequence
from typing import final

import numpy as np

from sims.cell import Cell
from sims.grasping.cylinder import Cylinder
from sims.grasping.gripper import Grip, Gripper
from sims.grasping.motion import Motion, Phase, Straight, Timeline, Transfer
from sims.grasping.plan import TCP, Plan, make_plan
from sims.grasping.reach import Reached
from sims.grasping.rim import RimGrasp
from sims.run import Decision
from wbc import Robot
from wbc.arrays import Array

__all__ = ["Job"]

DOWN, UP = 0.8, 0.8
"""Between hovering over the rim and the rim [s]."""
CLOSING, LIFTING, OPENING, RESTING = 0.5, 1.0, 0.5, 0.3
"""[s]"""
CALM = 0.12
"""Share of the acceleration limits in carrying. The engine's friction holds velocities,
not positions: what slips within the steps of time grows with the speed of turning."""


@final
class Job:
    """Plans at construction, then moves references and fingers, tick by tick.

    Args:
        robot: the arm.
        cell: where it works, reset to `start`.
        cylinder: what it believes to stand there.
        goal: (3,) where the cylinder's base is to stand [m].
        start: (n,) the arm's posture [rad].
        force: of each finger [N].

    Raises:
        InputError: the cylinder or the goal is out of reach; nothing has moved yet.

    Attributes:
        cylinder: as given.
        model: of the cell's world.
        plan: the postures of the job.
        timeline: the phases, as they were in the end.
        rim: the stack to control the arm with.
        grip: what the fingers held at the end of the closing; None before.
    """

    def __init__(
        self,
        robot: Robot,
        cell: Cell,
        cylinder: Cylinder,
        goal: Array,
        start: Array,
        force: float = 50.0,
    ) -> None:
        self.cylinder, self.model = cylinder, cell.model
        self.plan = make_plan(robot, cylinder, goal, start)
        self.timeline = Timeline(_phases(robot, self.plan, start))
        self.rim = RimGrasp(
            self.timeline.at(0.0), cylinder.rim, flipped=self.plan.flipped
        )
        self.gripper = Gripper(cell, force)
        self.grip: Grip | None = None
        self._phase = ""

    def script(self, t: float) -> None:
        """Called before every tick: fingers and references of time t [s]."""
        phase = self.timeline.phase(t).name
        if phase != self._phase:
            self._enter(phase)
        self.gripper.update()
        self.rim.follow(self.timeline.at(t))

    def watch(self, cell: Cell, decisions: Sequence[Decision]) -> bool:
        """False once the job is over."""
        del decisions
        return bool(cell.data.time < self.timeline.duration)

    @property
    def failed(self) -> bool:
        """Whether nothing is in the grip, or nothing was yet."""
        return self.grip is not Grip.HOLDING

    @property
    def report(self) -> str:
        """What became of the grasp, in a sentence."""
        if self.grip is Grip.EMPTY:
            return (
                f"the gripper closed on nothing at '{self.cylinder.name}': opened "
                "again and withdrew. Is the object where it should be?"
            )
        if self.failed:
            return f"'{self.cylinder.name}' was not grasped before the end of the run."
        return f"'{self.cylinder.name}' was grasped."

    def _enter(self, phase: str) -> None:
        if self._phase == "close":
            self.grip = self.gripper.grip
            if self.failed:
                self.timeline = self.timeline.after("close", _retreat(self.plan))
                phase = "let go"
        if phase == "close":
            self.gripper.close()
        if phase in ("open", "let go"):
            self.gripper.open()
        self._phase = phase


def _phases(robot: Robot, plan: Plan, start: Array) -> list[Phase]:
    return [
        Phase("reach", Transfer(robot, TCP, start, plan.above.q)),
        Phase("approach", _line(plan.above, plan.grasp, DOWN)),
        Phase("close", _rest(plan.grasp, CLOSING)),
        Phase("lift", _line(plan.grasp, plan.lifted, LIFTING)),
        Phase("carry", Transfer(robot, TCP, plan.lifted.q, plan.over.q, push=CALM)),
        Phase("lower", _line(plan.over, plan.placed, DOWN)),
        Phase("settle", _rest(plan.placed, RESTING)),
        Phase("open", _rest(plan.placed, OPENING)),
        Phase("retreat", _line(plan.placed, plan.away, UP)),
        Phase("rest", _rest(plan.away, RESTING)),
    ]


def _retreat(plan: Plan) -> list[Phase]:
    """What follows when the fingers met nothing."""
    return [
        Phase("let go", _rest(plan.grasp, OPENING)),
        Phase("withdraw", _line(plan.grasp, plan.above, UP)),
    ]


def _line(start: Reached, end: Reached, duration: float) -> Motion:
    return Straight(start.X, end.X, np.array([start.q, end.q]), duration)


def _rest(at: Reached, duration: float) -> Motion:
    return _line(at, at, duration)
