"""What is kept of a cut besides joints and torques: forces, opening, guide lines."""

from __future__ import annotations

from typing import final

import numpy as np

from sims.cutting.camera import Frame
from sims.cutting.cell import CuttingCell
from sims.cutting.guide import GuideSurface
from sims.cutting.job import Job
from sims.cutting.layout import CUTTER, PULLER
from sims.cutting.live import LiveGuide
from sims.cutting.polynomial import Polynomial
from wbc.arrays import Array

__all__ = ["Record"]

EVERY = 10
"""Ticks between two samples of what takes long to measure."""
SAMPLES = 41


@final
class Record:
    """Time series of one cut; sample i belongs to t[i], sample j to coarse_t[j].

    All of it is the simulator's truth; controllers see none of it.

    Attributes:
        initial: (passages, k, 3) guide lines of the meat at rest, before any cut [m].
        lines: the curve of every passage.
        spans: (x from, x to) of every passage [m].
        t: (T,) [s].
        stroke: (T,) index of the passage that is being cut, -1 between passages.
        tip, grip: (T, 3) positions [m].
        wanted: (T, 3) target of the tip [m].
        heading_error: (T,) angle between the knife's orientation and its target, or
            between the blade's normals where it may rock [rad].
        knife: (T, 3) force of the knife on the meat [N].
        pull, due: (T,) force along +y of the puller on the meat, and as wanted [N].
        coarse_t: (C,) [s].
        guide: (C, 2) x and y of the guide line where the knife is; NaN between strokes,
            and when nothing is left of it.
        interface: (C, nu, nw, 3) middles of the links, along the seam and down [m].
        opening, cut: (C,) mean opening [m] and share of links cut.
        qpos: (C, nq) of the world.
    """

    def __init__(self, cell: CuttingCell, job: Job, ticks: int) -> None:
        self._cell, self._job, self._count, self._coarse = cell, job, 0, 0
        self._misaligned = _normals if job.rocking else _angle
        points = cell.tissue.interface_points()[0]
        surface = GuideSurface(points)
        x = np.linspace(*surface.extent, SAMPLES)
        depths = job.passages.plan.depths
        self.initial = np.array(
            [
                np.column_stack([x, surface.line(x, z), np.full(x.size, z)])
                for z in depths
            ]
        )
        self.low, self.high = surface.extent
        self.lines: list[Polynomial] = job.passages.lines
        self.stroke = np.full(ticks, -1)
        self.t, self.heading_error, self.pull, self.due = np.zeros((4, ticks))
        self.tip, self.grip, self.wanted, self.knife = np.zeros((4, ticks, 3))
        coarse = ticks // EVERY + 1
        self.coarse_t, self.opening, self.cut = np.zeros((3, coarse))
        self.guide = np.full((coarse, 2), np.nan)
        self.qpos = np.zeros((coarse, cell.model.nq))
        grid = cell.tissue.meat.links.grid
        self.interface = np.zeros((coarse, *grid, 3), dtype=np.float32)

    def take(self) -> None:
        """Keep this instant, before the cell moves on."""
        cell, passages, i = self._cell, self._job.passages, self._count
        self._count += 1
        self.t[i] = cell.data.time
        self.tip[i], self.grip[i] = cell.tip, cell.grip
        self.wanted[i] = passages.target.p
        R, R_d = cell.knife_orientation, passages.target.R
        self.heading_error[i] = self._misaligned(R, R_d)
        self.knife[i] = cell.wrenches[CUTTER][:3]
        self.pull[i], self.due[i] = cell.wrenches[PULLER][1], self._job.pull.due
        if passages.phase == "stroke":
            self.stroke[i] = passages.index
        if i % EVERY == 0:
            self._measure(i)

    def _measure(self, i: int) -> None:
        """Opening, links, and the true guide line where the knife is."""
        cell, j = self._cell, self._coarse
        self._coarse += 1
        self.coarse_t[j], self.qpos[j] = self.t[i], cell.data.qpos
        self.opening[j] = cell.tissue.opening()
        self.cut[j] = cell.tissue.links_cut_fraction
        points = cell.tissue.interface_points()[0]
        self.interface[j] = points.reshape(self.interface[j].shape)
        x, _, z = self.tip[i]
        if self.stroke[i] >= 0 and self.low <= x <= self.high:
            live = LiveGuide()
            live.see(Frame(0.0, points), x, z)
            sight = live.at(x, 0.0)
            if sight is not None:
                self.guide[j] = x, sight.y

    def finish(self) -> None:
        """Drop what was not used."""
        k, c = self._count, self._coarse
        for name in ("stroke", "t", "heading_error", "pull", "due"):
            setattr(self, name, getattr(self, name)[:k])
        for name in ("tip", "grip", "wanted", "knife"):
            setattr(self, name, getattr(self, name)[:k])
        for name in ("coarse_t", "opening", "cut", "guide", "qpos", "interface"):
            setattr(self, name, getattr(self, name)[:c])
        self.guide[self.coarse_t >= self._job.separated_at] = np.nan

    @property
    def guide_error(self) -> Array:
        """Knife less guide line along y, (C,) [m]; NaN where there is none."""
        return self.tip[::EVERY, 1][: len(self.guide)] - self.guide[:, 1]

    def arrays(self) -> dict[str, Array]:
        """Everything by name, for a file."""
        names = ("t", "stroke", "tip", "grip", "wanted", "knife", "pull", "due")
        names += ("coarse_t", "guide", "opening", "cut", "initial", "heading_error")
        return {name: np.asarray(getattr(self, name)) for name in names}


def _normals(R: Array, R_d: Array) -> float:
    """Angle between the blade's normals [rad]."""
    return float(np.arccos(min(R[:, 1] @ R_d[:, 1], 1.0)))


def _angle(R: Array, R_d: Array) -> float:
    """Angle of R R_d^T [rad], exact for small ones."""
    E = R @ R_d.T
    sine = np.array([E[2, 1] - E[1, 2], E[0, 2] - E[2, 0], E[1, 0] - E[0, 1]])
    return float(np.arctan2(np.linalg.norm(sine), np.trace(E) - 1.0))
