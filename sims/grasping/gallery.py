"""The replay of all cases in one scene: cylinders wait on a bench for their turn."""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np

from sims.grasping.gripper import JOINTS
from sims.grasping.metrics import OBJECT, Result
from sims.grasping.plan import TCP
from sims.grasping.scene import (
    STEEL,
    WOOD,
    add_cylinder_body,
    add_stand,
    scene,
)
from sims.report.axes import PALETTE
from sims.report.replay import Arrow, Replay, Trace
from sims.scene import add_box
from wbc.arrays import Array

__all__ = ["camera", "replay"]

PAUSE: Final = 0.5
"""Between two cases [s]."""
STRIDE: Final = 10
"""Ticks between two samples of the replay."""
BENCH: Final = (-0.62, 0.45)
"""Where the waiting cylinders stand: x and height [m]."""
SPACING: Final = 0.14


def replay(results: list[Result]) -> str:
    """The replay as an HTML document."""
    model = _model(results)
    times, states, traces, pushes, chapters = [], [], [], [], []
    begin = 0.0
    for index, result in enumerate(results):
        log = result.log
        t = begin + log.t[::STRIDE] - log.t[0]
        chapters.append((result.job.cylinder.name, begin))
        times += [t, [t[-1] + PAUSE - 0.02]]
        qpos = _states(model, results, index)
        states += [qpos, qpos[-1:]]
        push = _pushes(result)
        pushes += [push, push[-1:]]
        path = log.p[TCP][::STRIDE]
        traces.append(Trace(f"tcp: {result.job.cylinder.name}", path, width=0.003))
        begin = t[-1] + PAUSE
    shown = traces if len(traces) < 3 else ()
    points, forces = np.moveaxis(np.concatenate(pushes), 2, 0)
    arrows = [
        Arrow(
            f"{_spoken(name)} on cylinder",
            points[:, i],
            forces[:, i],
            colour=PALETTE[i],
            ends=True,
        )
        for i, name in enumerate(JOINTS)
    ]
    return Replay(
        model,
        np.concatenate(times),
        np.concatenate(states),
        traces=shown,
        arrows=arrows,
        chapters=chapters,
        camera=camera(),
    ).html()


def camera() -> mujoco.MjvCamera:
    """From the operator's side, where both stands can be seen."""
    view = mujoco.MjvCamera()
    view.azimuth, view.elevation, view.distance = 62.0, -22.0, 2.4
    view.lookat[:] = [0.5, 0.0, 0.5]
    return view


def _model(results: list[Result]) -> mujoco.MjModel:
    spec = scene(results[0].log.robot, None)
    x, z = BENCH
    reach = 0.5 * SPACING * len(results)
    add_box(spec, "bench", (x - 0.09, -reach, 0.0), (x + 0.09, reach, z), WOOD)
    add_stand(spec, "stand", np.zeros(3), np.eye(3), STEEL, free=True)
    for index, result in enumerate(results):
        add_cylinder_body(spec, result.job.cylinder, f"cylinder {index}")
    return spec.compile()


def _states(model: mujoco.MjModel, results: list[Result], turn: int) -> Array:
    """Positions (T, nq) of everything while it is one case's turn."""
    log, job = results[turn].log, results[turn].job
    world = job.model
    own = log.qpos[::STRIDE]
    out = np.zeros((len(own), model.nq))
    for name in (*log.robot.joint_names, *JOINTS):
        out[:, _place(model, name)] = own[:, _place(world, name)]
    out[:, _free(model, "stand")] = _pose(job.cylinder.p, job.cylinder.R)
    for index in range(len(results)):
        y = SPACING * (index - 0.5 * (len(results) - 1))
        waiting = _pose(np.array([BENCH[0], y, BENCH[1]]), np.eye(3))
        out[:, _free(model, f"cylinder {index}")] = waiting
    moving = own[:, _free(world, OBJECT)]
    out[:, _free(model, f"cylinder {turn}")] = moving
    return out


def _spoken(joint: str) -> str:
    """Of "finger_left", "left finger"."""
    return " ".join(reversed(joint.split("_")))


def _pushes(result: Result) -> Array:
    """Place and force (T, 2, 2, 3) of both fingers, at the samples of the replay."""
    log, touch = result.log, result.touch
    samples = np.stack([touch.points, touch.forces], axis=2)
    latest = np.searchsorted(touch.t, log.t[::STRIDE], side="right") - 1
    pushes: Array = samples[np.maximum(latest, 0)]
    return pushes


def _place(model: mujoco.MjModel, joint: str) -> int:
    return int(model.jnt_qposadr[model.joint(joint).id])


def _free(model: mujoco.MjModel, joint: str) -> slice:
    first = _place(model, joint)
    return slice(first, first + 7)


def _pose(p: Array, R: Array) -> Array:
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, np.ascontiguousarray(R).ravel())
    return np.concatenate([p, quat])
