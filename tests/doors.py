"""Public functions of wbc and sims, each with arguments that it takes."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import numpy as np

import sims
import tasks
import wbc
from robots import assembly, compose, lwr4, racer, tools
from sims import constraints, contact, grasping, welding
from sims.cell import ArmCell
from sims.mismatch import Mismatch
from sims.registry import find_demo
from sims.resolvers import make_resolver
from sims.sensors import Encoders
from sims.welding.workpiece import scene
from sims.wrist import WristSensor

__all__ = ["ARM", "DOORS", "HERE", "STATE", "TIP", "UP", "UPRIGHT", "Door", "position"]

ARM = racer.load()
TIP = "torch_tip"
STATE = ARM.state(ARM.q_home, wrenches={"wrist": np.zeros(6)})
MJCF = racer.mjcf()
UP, HERE, UPRIGHT = [0.0, 0.0, 1.0], [0.9, 0.1, 0.8], np.eye(3)
URDF = """<robot name="one"><link name="base"/><link name="tip"><inertial>
<mass value="1"/><origin xyz="0 0 0.1"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="swing" type="revolute"><parent link="base"/><child link="tip"/>
<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="50" velocity="2"/></joint>
</robot>"""


@dataclass(frozen=True)
class Door:
    """A public callable.

    good: arguments that it takes, by name; the others have defaults.
    before: makes what the callable is a method of, anew for each call.
    fresh: makes more arguments, anew for each call.
    """

    call: Callable[..., Any]
    good: Mapping[str, Any] = field(default_factory=dict)
    before: Callable[[], Any] | None = None
    fresh: Callable[[], Mapping[str, Any]] = dict

    @property
    def name(self) -> str:
        """Such as "Posture" or "Posture.set_target"."""
        return self.call.__qualname__

    @property
    def parameters(self) -> dict[str, inspect.Parameter]:
        """Whose values can be bad, by name."""
        listed = dict(inspect.signature(self.call).parameters)
        if self.before is not None:
            listed.pop("self")
        return listed

    def enter(self, owner: Any, **bad: Any) -> Any:
        """Call it with some arguments exchanged; a task that comes out is bound."""
        given = {**self.good, **self.fresh(), **bad}
        found = self.call(*(() if self.before is None else (owner,)), **given)
        if isinstance(found, wbc.Task | wbc.Level):
            wbc.Controller(ARM, found)
        return found


def position() -> tasks.FramePosition:
    return tasks.FramePosition(TIP, HERE)


def level() -> wbc.Level:
    return wbc.Level.of(position())


def hierarchy() -> wbc.Hierarchy:
    return wbc.Hierarchy(position())


def posture() -> wbc.Hierarchy:
    return wbc.Hierarchy(tasks.Posture(name="a"))


def solution() -> wbc.Solution:
    return wbc.resolve(STATE, posture())


def price() -> wbc.StrictnessCost:
    return solution().cost_of_strictness()


def controller() -> wbc.Controller:
    return wbc.Controller(ARM, tasks.Posture())


@cache
def arm_cell() -> ArmCell:
    return welding.cell(ARM)


@cache
def urdf() -> Path:
    path = Path(mkdtemp()) / "one.urdf"
    path.write_text(URDF)
    return path


class Pull(wbc.MotionTask):
    """A user's own task."""

    def evaluate(self, state: wbc.State, out: wbc.Rows) -> None:
        out.J[:] = np.eye(len(self.rows), ARM.nv)


def set_law(law: wbc.Law) -> None:
    position().law = law


def in_a_hierarchy(task: wbc.Task) -> wbc.Hierarchy:
    return wbc.Hierarchy(task)


DOORS = [
    # wbc
    Door(wbc.PD, {"stiffness": 1.0}),
    Door(wbc.Damper, {"damping": 1.0}),
    Door(wbc.SaturatedPD, {"stiffness": 1.0, "speed": 1.0, "acceleration": 1.0}),
    Door(wbc.DampedInverse),
    Door(wbc.HierarchicalQP),
    Door(wbc.NullSpace),
    Door(wbc.WeightedQP),
    Door(wbc.Level, {"terms": ((position(), 1.0),)}),
    Door(wbc.Level.of, {"item": position()}),
    Door(wbc.Level.__add__, {"other": tasks.Posture()}, level),
    Door(wbc.Level.__rmul__, {"weight": 2.0}, level),
    Door(wbc.Level.__rshift__, {"other": tasks.Posture()}, level),
    Door(wbc.Hierarchy.of, {"item": position()}),
    Door(wbc.Hierarchy.__rshift__, {"other": tasks.Posture()}, hierarchy),
    Door(in_a_hierarchy, {"task": position()}),
    Door(wbc.Task.__rmul__, {"weight": 2.0}, position),
    Door(wbc.Hierarchy.analyse, {"state": STATE}, hierarchy),
    Door(wbc.Controller, {"robot": ARM, "hierarchy": position()}),
    Door(wbc.Controller.__call__, {"q": ARM.q_home, "v": 0 * ARM.q_home}, controller),
    Door(wbc.Controller.change, {"hierarchy": position()}, controller),
    Door(wbc.resolve, {"state": STATE, "hierarchy": position()}),
    Door(wbc.solve_hierarchy, {"levels": [([[1.0, 0.0]], [1.0], [1.0])]}),
    Door(wbc.solve_pose, {"robot": ARM, "goal": position(), "quick": True}),
    Door(wbc.allocate_rows, {"m": 1, "n": 6}),
    Door(wbc.backends),
    Door(wbc.Robot.from_mjcf, {"source": MJCF}),
    Door(wbc.Robot.from_urdf, {"path": urdf()}),
    Door(wbc.Robot.state, {"q": ARM.q_home}, lambda: ARM),
    Door(wbc.Robot.joint_index, {"name": ARM.joint_names[0]}, lambda: ARM),
    Door(wbc.Robot.frame_id, {"name": TIP}, lambda: ARM),
    Door(Pull, {"name": "pull", "unit": "m", "rows": ("x",), "law": wbc.PD(1.0)}),
    Door(set_law, {"law": wbc.PD(1.0)}),
    # what may be asked of results
    Door(wbc.State.frame, {"name": TIP}, lambda: STATE),
    Door(wbc.State.position, {"name": TIP}, lambda: STATE),
    Door(wbc.State.jacobian, {"name": TIP}, lambda: STATE),
    Door(wbc.State.wrench, {"sensor": "wrist"}, lambda: STATE),
    Door(wbc.Solution.report, {"task": "a"}, solution),
    Door(wbc.Explanation.task, {"name": "a"}, lambda: solution().explain()),
    Door(wbc.Explanation.blocked, {"name": "a"}, lambda: solution().explain()),
    Door(wbc.StrictnessCost.level, {"name": "a"}, price),
    Door(wbc.Analysis.level, {"task": "a"}, lambda: posture().analyse(STATE)),
    Door(wbc.Certificate.holds, {}, lambda: solution().certificate()),
    # sims and robots
    Door(
        sims.run,
        {"duration": 0.001},
        fresh=lambda: {"cell": arm_cell(), "controller": controller()},
    ),
    Door(ArmCell, {"name": "cell", "robot": ARM}, fresh=lambda: {"spec": scene(ARM)}),
    Door(Encoders),
    Door(WristSensor),
    Door(Mismatch),
    Door(make_resolver, {"name": "hqp"}),
    Door(welding.cell, {"robot": ARM}),
    Door(constraints.cell, {"robot": lwr4.load("probe")}),
    Door(contact.cell, {"robot": lwr4.load("peg")}),
    Door(grasping.cell, {"robot": lwr4.load("gripper"), "cylinder": None}),
    Door(racer.load),
    Door(lwr4.load),
    Door(racer.mjcf),
    Door(lwr4.mjcf),
    Door(tools.mjcf, {"name": "torch"}),
    Door(
        assembly.mount, {"arm_xml": racer.mjcf(None), "tool_xml": tools.mjcf("torch")}
    ),
    Door(compose.mjcf, {"arms": {"arm": compose.Placed(MJCF)}}),
    Door(compose.load, {"arms": {"arm": compose.Placed(MJCF)}}),
    Door(find_demo, {"name": "welding"}),
    Door(compose.Placed, {"mjcf": MJCF}),
]
