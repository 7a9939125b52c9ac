"""One trial, from an animal's seed to what its cut left behind."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import final

import mujoco
import numpy as np

from sims.cutting.camera import Camera
from sims.cutting.cell import CuttingCell
from sims.cutting.correction import Experiment
from sims.cutting.guide import GuideSurface
from sims.cutting.job import Job, check_plan
from sims.cutting.layout import CUTTER, GRIP, PULLER, TIP, Plan, robot_of
from sims.cutting.loop import Run, run_job
from sims.cutting.meat import Meat, Tissue
from sims.cutting.scene import LEANING, PLACE, UPRIGHT, scene
from sims.cutting.stacks import posture_at, stacks
from sims.mismatch import Mismatch
from sims.resolvers import make_resolver
from sims.run import Watcher
from wbc import Controller, Robot
from wbc.arrays import Array

__all__ = ["Trial"]

PATIENCE = 2.0
"""Time beyond the plan's own after which a trial is given up, relative to it."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Trial:
    """What is cut, and how.

    Attributes:
        meat: the animal; seed 0 by default.
        experiment: how the guide line is updated.
        resolver: name of a resolver.
        combined: one hierarchy of 14 axes instead of one of 7 for each arm.
        rocking: leave the knife's rotation about the blade's normal free.
        plan: depths and times.
        camera: the eye.
        mismatch: how the simulated arms differ from the models.
    """

    meat: Meat = field(default_factory=lambda: Meat.generate(0, place=PLACE))
    experiment: Experiment = "local"
    resolver: str = "hqp"
    combined: bool = False
    rocking: bool = False
    plan: Plan = field(default_factory=Plan)
    camera: Camera = field(default_factory=Camera)
    mismatch: Mismatch | None = None

    def robots(self) -> tuple[Robot, ...]:
        """The controllers' models: two arms, or one robot of both."""
        if self.combined:
            return (robot_of(CUTTER, PULLER),)
        return robot_of(CUTTER), robot_of(PULLER)

    def cell(self) -> CuttingCell:
        """The world, for `start`."""
        return CuttingCell(
            scene(self.meat), self.robots(), self._tissue, mismatch=self.mismatch
        )

    def prepare(self) -> tuple[CuttingCell, list[Controller], Job]:
        """Cell, controllers and job, ready to run.

        Raises:
            InputError: a passage is out of reach.
        """
        cell = self.cell()
        return cell, *self.start(cell)

    def start(self, cell: CuttingCell) -> tuple[list[Controller], Job]:
        """Put a cell of this trial at its beginning: controllers and job for it.

        Raises:
            InputError: a passage is out of reach.
        """
        robots = tuple(view.robot for view in cell.views)
        points = self.meat.links.ends[0]
        check_plan(robots[0], points, self.plan)
        postures = self._postures(points)
        both = np.concatenate([postures[CUTTER], postures[PULLER]])
        postures[f"{CUTTER}_{PULLER}"] = both
        cell.reset(postures)
        made = stacks(robots, postures, rocking=self.rocking)
        controllers = [
            Controller(robot, hierarchy, make_resolver(self.resolver))
            for robot, hierarchy in zip(robots, made.hierarchies, strict=True)
        ]
        self.camera.reset()
        return controllers, Job(cell, made, self.plan, self.camera, self.experiment)

    def run(
        self,
        longest: float | None = None,
        *,
        watch: Watcher | None = None,
        quiet: bool = True,
    ) -> Run:
        """Prepare and run, to the end or for `longest` seconds."""
        limit = longest or self.longest
        return run_job(*self.prepare(), limit, watch=watch, quiet=quiet)

    @property
    def longest(self) -> float:
        """Time after which it is given up [s]."""
        return PATIENCE * self.plan.duration

    def _tissue(self, model: mujoco.MjModel, data: mujoco.MjData) -> Tissue:
        return Tissue(self.meat, model, data, knife=TIP)

    def _postures(self, points: Array) -> dict[str, Array]:
        """The knife above the meat's near end, the bracket at the muscle."""
        surface = GuideSurface(points)
        x = surface.extent[0] - self.plan.overrun
        above = np.array([x, float(surface.line(x, self.plan.depths[0])[0]), 0.0])
        above[2] = self.plan.height
        return {
            CUTTER: posture_at(robot_of(CUTTER), TIP, above, UPRIGHT),
            PULLER: posture_at(robot_of(PULLER), GRIP, self.meat.grip, LEANING),
        }
