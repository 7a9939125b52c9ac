"""What is drawn over a cell at one instant: geometry, errors, forces and words."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol, TypeAlias, final

import mujoco

from sims.run import Decision
from sims.view.caption import Caption, caption
from sims.view.forces import Contacts, felt
from sims.view.geometry import geometry_of
from sims.view.marks import Mark
from sims.wrist import WristSensor
from wbc import Status

__all__ = ["Frame", "Overlay", "Own", "World"]

Own: TypeAlias = Callable[[], Sequence[Mark]]
"""Marks of a cell's own, such as a line that its tasks do not know of."""


class World(Protocol):
    """What a window or a video needs of a cell."""

    @property
    def model(self) -> mujoco.MjModel:
        """What is simulated."""

    @property
    def data(self) -> mujoco.MjData:
        """Its state."""

    @property
    def wrists(self) -> Sequence[WristSensor]:
        """Its force sensors."""


class Frame(NamedTuple):
    """All that is added to one picture."""

    marks: list[Mark]
    words: Caption


@final
class Overlay:
    """Makes it for one cell, the same for whoever shows it.

    Args:
        world: the cell.

    Attributes:
        own: makes marks of the cell's own; None for none.
    """

    own: Own | None

    def __init__(self, world: World) -> None:
        self._world, self.own = world, None
        self._contacts = Contacts(world.model)

    def frame(self, title: str, decisions: Sequence[Decision]) -> Frame:
        """The overlay of this instant, under a title of the run."""
        data = self._world.data
        marks = [] if self.own is None else list(self.own())
        for controller, seen, solution in decisions:
            if solution.status is Status.SENSOR_INVALID:
                continue  # nobody knows where the robot is
            state = controller.robot.state(seen.q, seen.v, seen.t, controller.dt)
            for task in controller.hierarchy.tasks():
                marks += geometry_of(task, state)
            marks += felt(data, self._world.wrists, seen.wrenches)
        marks += self._contacts.marks(data)
        return Frame(marks, caption(title, data.time, decisions))
