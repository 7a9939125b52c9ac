"""Our controller under one of our resolvers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmarks.jobs import Job
from benchmarks.recording import Script, Stack
from benchmarks.stacks import record
from benchmarks.workers.loop import Array, Failed, Loop, Target, Wrenches
from benchmarks.workers.serve import serve
from sims.resolvers import make_resolver
from tasks import (
    FrameOrientation,
    FramePose,
    FramePosition,
    JointLimits,
    Plane,
    PointOnPlane,
    Posture,
    TorqueLimits,
)
from wbc import Controller, Hierarchy, Level, Robot, State, Task


class Ours:
    """A controller, called as a user calls it."""

    def __init__(
        self, job: Job, robot: Robot, resolver: str, stack: Stack | None = None
    ) -> None:
        self.job, self.t = job, 0.0
        self.poses: list[FramePose] = []
        self.halves: list[tuple[FramePosition, FrameOrientation]] = []
        self.script: Script | None = None if stack is None else stack.script
        hierarchy = self._hierarchy(robot) if stack is None else stack.hierarchy
        self.controller = Controller(robot, hierarchy, make_resolver(resolver), job.dt)

    def _hierarchy(self, robot: Robot) -> Hierarchy:
        job = self.job
        state = robot.state(np.array(job.home))
        torques, joints = TorqueLimits(job.torque_share), JointLimits()
        pose, posture = job.stiffness
        rest = Posture(job.home, stiffness=posture)
        if job.planes:
            return _planes(job, state)
        if job.split:
            F = [(tip, state.frame(tip)) for tip in job.tips]
            at = [FramePosition(tip, f.p, stiffness=pose) for tip, f in F]
            turned = [FrameOrientation(tip, f.R, stiffness=pose) for tip, f in F]
            self.halves = list(zip(at, turned, strict=True))
            return torques >> joints >> _level(at) >> _level(turned) >> rest
        self.poses = [
            FramePose(tip, f.p, f.R, stiffness=pose)
            for tip in job.tips
            for f in (state.frame(tip),)
        ]
        return torques + joints >> _level(self.poses) >> rest

    def aim(self, t: float, targets: list[Target]) -> None:
        """Move the references."""
        self.t = t
        if self.script is not None:
            self.script(t)
        still = np.zeros(3)
        for pose, target in zip(self.poses, targets, strict=False):
            twist = np.concatenate([target.v, still])
            change = np.concatenate([target.a, still])
            pose.set_target(target.p, target.R, twist, change)
        for (position, orientation), target in zip(self.halves, targets, strict=False):
            position.set_target(target.p, target.v, target.a)
            orientation.set_target(target.R)

    def tick(self, q: Array, v: Array, *felt: Wrenches) -> Array:
        """From (q, v), and in a replay what was felt, to the torques."""
        self.solution = self.controller(q, v, self.t, *felt)
        return self.solution.torque

    def acceleration(self) -> Array:
        """Of the last tick."""
        if not self.solution.ok:
            raise Failed(self.solution.message)
        return self.solution.acceleration


def _planes(job: Job, state: State) -> Hierarchy:
    """Links kept at their heights: all on one level, or strictly one by one."""
    links = [f for f in state.robot.frames if "_link" in f and not f.endswith("link1")]
    held = [
        PointOnPlane(link, Plane(state.frame(link).p, [0.0, 0.0, 1.0]), name=link)
        for link in links[-job.planes :]
    ]
    levels = held if job.split else [_level(held)]
    stack = Hierarchy.of(TorqueLimits(job.torque_share) + JointLimits())
    for level in levels:
        stack = stack >> level
    return stack >> Posture(job.home)


def _level(tasks: Sequence[Task]) -> Level:
    level = Level.of(tasks[0])
    for task in tasks[1:]:
        level = level + task
    return level


def open_loop(job: Job, kind: str) -> Loop:
    """The job under one of our resolvers."""
    if job.cell:
        return _cell_loop(job, kind)
    robot = Robot.from_urdf(
        job.urdf, q_home=job.home, acceleration_limit=list(job.acceleration)
    )
    return Loop(job, Ours(job, robot, kind), robot.model)


def _cell_loop(job: Job, kind: str) -> Loop:
    """A cell's stack: through a recorded run, or from its start on an ideal robot."""
    recording = record(job.cell, max(job.recorded, 1))
    stack = recording.make()
    contender = Ours(job, stack.robot, kind, stack)
    instants = recording.instants if job.recorded else ()
    loop = Loop(job, contender, stack.robot.model, instants)
    loop.q = recording.instants[0].q.copy()
    return loop


if __name__ == "__main__":
    serve(open_loop, ("wbc", "pin", "numpy", "scipy", "qpsolvers", "proxsuite"))
