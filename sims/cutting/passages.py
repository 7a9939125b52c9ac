"""The knife's work: passage after passage, from guide line to guide line."""

from __future__ import annotations

import math
from typing import Literal, TypeAlias, final

import numpy as np

from sims.cutting.camera import Frame
from sims.cutting.correction import Correction
from sims.cutting.glide import Glide
from sims.cutting.guide import GuideSurface
from sims.cutting.layout import Plan
from sims.cutting.live import LiveGuide
from sims.cutting.polynomial import Polynomial
from sims.cutting.stroke import KnifeTarget, Stroke, heading, knife_target, upright
from sims.cutting.timelaw import Clock, Motion
from wbc.arrays import Array

__all__ = ["Passages", "Phase"]

Phase: TypeAlias = Literal["wait", "over", "down", "stroke", "up", "done"]
SIGHT_LOST = 3.0
"""The line counts as lost when so many frames in a row are missing."""
STANDING = 0.02
"""Share of its pace at which a knife counts as standing."""


@final
class Passages:
    """Makes the knife's target of every tick.

    Each passage: over the meat to its start, down to its depth, along the guide line,
    up again. The line is fitted to the newest frame when the knife sets off for it.
    Where frames stop coming during a stroke, the clock slows the knife to a stop, on
    the last line; it goes on when they come back.

    Args:
        plan: depths and times.
        correction: the local update.
        period: between two frames [s].
        delay: of the frames [s].
        noise: of the points [m].
        p: (3,) where the knife is, at rest [m].
        theta: its heading [rad].

    Attributes:
        phase: what it does.
        index: of the passage, from 0.
        lines: the curve of every passage so far.
        ended: when the stroke of every passage was over [s].
        blind: whether it waits for frames.
        target: what it wants now.
    """

    def __init__(
        self,
        plan: Plan,
        correction: Correction,
        *,
        period: float,
        delay: float,
        noise: float,
        p: Array,
        theta: float,
    ) -> None:
        self.plan, self.correction = plan, correction
        self._patience, self._noise = delay + SIGHT_LOST * period, noise
        self.phase: Phase = "wait"
        self.index, self.blind = 0, False
        self._last, self._closing = len(plan.depths) - 1, False
        self.lines: list[Polynomial] = []
        self.ended: list[float] = []
        self.target = upright(p, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), Motion(theta, 0, 0))
        self._theta, self._clock = theta, Clock()
        self._live = LiveGuide(noise)

    @property
    def depth(self) -> float:
        """Of the passage at hand [m]."""
        return self.plan.depths[self.index]

    @property
    def completed(self) -> int:
        """Passages whose stroke is over."""
        return len(self.ended)

    def tick(self, t: float, dt: float, frame: Frame | None, y: float) -> KnifeTarget:
        """The target at time t [s].

        Args:
            t: [s].
            dt: since the tick before [s].
            frame: the newest from the camera.
            y: of the knife's tip [m].
        """
        self._t = t
        if self.phase == "wait" and t >= self.plan.settling and frame is not None:
            self._set_off(frame)
        if self.phase == "stroke":
            self._cut(t, dt, frame, y)
        elif self.phase in ("over", "down", "up"):
            self._go(dt, frame)
        return self.target

    def finish(self) -> None:
        """Nothing is left to cut: slow down, then up, and done."""
        self._last, self._closing = self.index, True
        if self.phase in ("over", "down"):
            self.stop(self.target.p)

    def stop(self, p: Array) -> None:
        """Stay at p (3,) [m]."""
        self.target = KnifeTarget(p, self.target.R, np.zeros(6), np.zeros(6))
        self.phase = "done"

    def _set_off(self, frame: Frame) -> None:
        """Fit the guide line and leave for its start."""
        plan, surface = self.plan, GuideSurface(frame.points, self._noise)
        low, high = surface.extent
        low, high = low - plan.overrun, high + plan.overrun
        line = surface.fit(self.depth, low, high, plan.order)
        self.lines.append(line)
        self._stroke = Stroke(line, low, high, plan.stroke)
        self._offset = float(surface.line(low, self.depth)[0]) - line.at(low).y
        start = self._entry()
        above = np.array([*start[0][:2], plan.height])
        self._begin("over", above, start[1], plan.travel)

    def _entry(self) -> tuple[Array, float]:
        """Where the stroke begins, and its heading."""
        line, x = self._stroke.curve, self._stroke.start
        theta = math.atan(line.at(x).y1)
        y = line.at(x).y + self.correction.restart(self._offset)
        return np.array([x, y, self.depth]), theta

    def _begin(self, phase: Phase, p: Array, theta: float, duration: float) -> None:
        self.phase = phase
        self._glide = Glide(self.target.p, self._theta, p, theta, duration)
        self._theta = theta
        self._clock.restart()

    def _go(self, dt: float, frame: Frame | None) -> None:
        self._clock.tick(dt, 1.0)
        glide = self._glide
        self.target = glide.at(glide.share(self._clock.time))
        if self._clock.time < glide.duration:
            return
        if self.phase == "over":
            self._begin("down", *self._entry(), self.plan.lift)
        elif self.phase == "down":
            self.phase = "stroke"
            self._clock.restart()
            self._live.forget()
        elif self.index == self._last:
            self.phase = "done"
        elif frame is not None:
            self.index += 1
            self._set_off(frame)

    def _cut(self, t: float, dt: float, frame: Frame | None, y: float) -> None:
        x_now = float(self.target.p[0])
        if frame is not None:
            self._live.see(frame, x_now, self.depth)
        self.blind = self._live.age(t) > self._patience
        self._clock.tick(dt, 0.0 if self.blind or self._closing else 1.0)
        x = self._clock.slowed(self._stroke.at(self._clock.time))
        curve = self._stroke.curve
        bend = curve.at(x.value)
        planned = Motion(bend.y, bend.y1 * x.rate, 0.0)
        seen = None if self._closing else self._live.at(x.value, t)
        side = self.correction.tick(dt, seen, planned, y, x.rate)
        self.target = knife_target(curve, x, self.depth, side)
        stands = self._closing and self._clock.pace < STANDING
        if stands or self._clock.time >= self._stroke.duration:
            self._rise()

    def _rise(self) -> None:
        self.ended.append(self._t)
        x = float(self.target.p[0])
        self._theta = heading(self._stroke.curve, Motion(x, 0.0, 0.0)).value
        up = np.array([*self.target.p[:2], self.plan.height])
        self._begin("up", up, self._theta, self.plan.lift)
