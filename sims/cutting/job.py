"""A whole cut: vision, passages and pull, and when it is over."""

from __future__ import annotations

from typing import final

import numpy as np

from sims.cutting.camera import Camera
from sims.cutting.cell import CuttingCell
from sims.cutting.correction import Correction, Experiment
from sims.cutting.guard import Guard
from sims.cutting.guide import GuideSurface
from sims.cutting.layout import CUTTER, PULLER, TIP, Plan
from sims.cutting.passages import Passages
from sims.cutting.pull import Pull
from sims.cutting.reach import check_reach
from sims.cutting.stacks import Stacks
from wbc import Robot
from wbc.arrays import Array

__all__ = ["Job", "check_plan"]

LETTING_GO = 0.02
"""How fast the pull goes away when nothing holds the muscle any more [s]."""
EASING = 0.5
"""How fast it goes away when the job stops with links left [s]."""
AFTER = 0.8
"""How long the cell is watched after the end [s]."""


@final
class Job:
    """Moves the targets of both arms, tick by tick.

    Args:
        cell: the cell, reset.
        stacks: the arms' tasks.
        plan: depths and times.
        camera: the eye.
        experiment: how the guide line is updated.

    Attributes:
        experiment: how the guide line is updated.
        rocking: whether the knife may turn about the blade's normal.
        passages: what the knife does.
        pull: what the puller does.
        stopped: why the job ended early, None if it did not.
        separated_at: when the last link went [s]; infinite before.
    """

    def __init__(
        self,
        cell: CuttingCell,
        stacks: Stacks,
        plan: Plan,
        camera: Camera,
        experiment: Experiment,
    ) -> None:
        self._cell, self._stacks, self._camera = cell, stacks, camera
        tip = cell.data.site(TIP)
        R = tip.xmat.reshape(3, 3)
        self.passages = Passages(
            plan,
            Correction(experiment),
            period=1.0 / camera.rate,
            delay=camera.delay,
            noise=camera.noise,
            p=tip.xpos.copy(),
            theta=float(np.arctan2(-R[1, 0], -R[0, 0])),
        )
        self.experiment, self.rocking = experiment, stacks.knife.rocking
        self.pull, self._guard = Pull(stacks.pull, cell.grip, plan.pull), Guard()
        self.stopped: str | None = None
        self.separated_at, self._ended = np.inf, np.inf
        self._t = 0.0

    def tick(self, t: float) -> bool:
        """Set the targets of time t [s]; false when all is over."""
        cell, passages = self._cell, self.passages
        tip = cell.tip
        frame = self._camera.look(t, lambda: cell.tissue.interface_points()[0])
        self._watch(t, tip)
        if self.stopped is None:
            target = passages.tick(t, t - self._t, frame, float(tip[1]))
        else:
            target = passages.target
        self._t = t
        self._stacks.knife.set_target(*target)
        self.pull.tick(t, float(cell.grip[1]))
        if passages.phase == "done":
            self._ended = min(self._ended, t)
        return t < self._ended + AFTER

    def _watch(self, t: float, tip: Array) -> None:
        """Stop conditions: separated, a force out of bounds, a knife that is stuck."""
        cell = self._cell
        if self.separated_at == np.inf and cell.tissue.separated:
            self.separated_at = t
            self.pull.release(t, LETTING_GO)
            self.passages.finish()
        if self.stopped is not None:
            return
        felt = cell.wrenches
        holding = self.separated_at == np.inf
        pull = float(felt[PULLER][1]) if holding else self.pull.due
        wanted = self.passages.target.p
        self.stopped = self._guard.check(
            t, tip, wanted, felt[CUTTER], pull, self.pull.due
        )
        if self.stopped is not None:
            self.passages.stop(tip)
            self.pull.release(t, EASING)


def check_plan(robot: Robot, points: Array, plan: Plan) -> None:
    """See that every passage can be reached, from the points of the meat at rest.

    Args:
        robot: the cutting arm, or both.
        points: (N, 3) of the interface [m].
        plan: depths and times.

    Raises:
        InputError: a passage is out of reach; the message has the reachable range.
    """
    surface = GuideSurface(points)
    low, high = surface.extent
    x = np.linspace(low - plan.overrun, high + plan.overrun, 9)
    for number, depth in enumerate(plan.depths, 1):
        y = surface.line(x, depth)
        for z, what in (
            (depth, "the guide line of"),
            (plan.height, "the way back after"),
        ):
            line = np.column_stack([x, y, np.full(x.size, z)])
            check_reach(robot, line, f"{what} passage {number}")
