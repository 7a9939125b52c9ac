"""Pictures of what keeps a robot out of trouble: clearance, torque rates, damping."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from site_drawing import BLUE, GREEN, ORANGE, Plot

import tasks
from wbc import Controller, Hierarchy, Robot, Task, allocate_rows, resolve

Picture = tuple[str, str]
TIP, BASE = "torch_tip", "base"
START = np.radians([0.0, -4.0, -112.0, 0.0, 72.0, 180.0])
WRIST = 4
"""The joint that is zero where the wrist is singular."""


def _distances(robot: Robot, stack: Hierarchy, t: np.ndarray) -> list[float]:
    """Of the tool from the base at times t (T,) under a stack."""
    q, v, found = START.copy(), np.zeros(robot.nv), []
    for _ in t:
        state = robot.state(q, v)
        apart = state.frame(TIP).p - state.frame(BASE).p
        found.append(float(np.linalg.norm(apart)))
        v = v + t[1] * resolve(state, stack).acceleration
        q = q + t[1] * v
    return found


def clearance(robot: Robot) -> Picture:
    """A tool that is drawn towards the base, and stops in time."""
    least, t = 0.85, np.arange(0.0, 1.2, 0.01)
    inside = 0.7 * robot.state(START).frame(TIP).p
    pull = tasks.FramePosition(TIP, inside, stiffness=40.0) >> tasks.Damping()
    guard = tasks.Clearance(TIP, BASE, least)
    plot = Plot((0.0, 1.2), (0.6, 1.1), ("time [s]", "distance [m]"))
    plot.curve(t, _distances(robot, pull, t), ORANGE, width=2.5)
    plot.curve(t, _distances(robot, guard >> pull, t), BLUE, width=2.5)
    plot.line([plot.point(0.0, least), plot.point(1.2, least)], GREEN, 1.0, "4 3")
    caption = (
        f"Rows: {guard.row_names(robot)[0]} [m/s²]. A tool that is drawn towards the "
        "robot's base, with the task above the pull (blue) and without (orange)."
    )
    return plot.svg("Clearance"), caption


def _torques(robot: Robot, top: Hierarchy, t: np.ndarray) -> list[float]:
    """Of the second joint at times t (T,), when the target of a posture jumps."""
    posture = tasks.Posture(START, stiffness=400.0)
    controller = Controller(robot, top >> posture, dt=t[1])
    q, v, found = START.copy(), np.zeros(robot.nv), []
    for now in t:
        if now >= 0.01:
            posture.set_target(START + [0.0, -0.01, 0.0, 0.0, 0.0, 0.0])
        solution = controller(q, v, now)
        found.append(float(solution.torque[1]))
        v = v + t[1] * solution.acceleration
        q = q + t[1] * v
    return found


def torque_rates(robot: Robot) -> Picture:
    """A target that jumps, with and without a bound on the rate."""
    t = np.arange(0.0, 0.3, 1e-3)
    top = Hierarchy.of(tasks.TorqueLimits())
    free = _torques(robot, top, t)
    bound = _torques(robot, top >> tasks.TorqueRateLimits(1000.0), t)
    plot = Plot((0.0, 0.3), (-200.0, 0.0), ("time [s]", "torque [Nm]"))
    plot.curve(t, free, ORANGE, width=2.0)
    plot.curve(t, bound, BLUE, width=2.5)
    caption = (
        "Rows: one a joint [Nm or N]. The torque of a joint whose target jumps at "
        "0.01 s, bounded to 1000 Nm/s (blue), and as it would be (orange)."
    )
    return plot.svg("TorqueRateLimits"), caption


def _rows(task: Task, state) -> np.ndarray:
    rows = allocate_rows(len(task.row_names(state.robot)), state.robot.nv)
    task.update(state, rows)
    return rows.A.copy()


def _gain(robot: Robot, angle: float, away: float, damped: bool) -> float:
    """Largest joint acceleration per unit of what a pose asks for."""
    q = START.copy()
    q[WRIST] = angle
    state = robot.state(q)
    F = state.frame(TIP)
    goal = tasks.FramePose(TIP, F.p + [away, 0.0, 0.0], F.R)
    A = _rows(goal, state)
    m = len(A)
    if damped:
        A = np.vstack([A, _rows(tasks.SingularDamping(goal), state)])
    return float(np.linalg.norm(np.linalg.pinv(A, rcond=1e-12)[:, :m], 2))


def singular_damping(robot: Robot) -> Picture:
    """How hard a pose drives the joints as the wrist gets singular."""
    angles = np.radians(np.linspace(0.5, 40.0, 160))
    plot = Plot((0.0, 40.0), (0.0, 40.0), ("wrist from straight [deg]", "gain"))
    lines = (
        ("undamped", ORANGE, 0.0, False),
        ("damped, at the goal", BLUE, 0.0, True),
        ("damped, 0.1 m from it", GREEN, 0.1, True),
    )
    for i, (words, colour, away, damped) in enumerate(lines):
        gains = [_gain(robot, a, away, damped) for a in angles]
        plot.curve(np.degrees(angles), np.minimum(gains, 40.0), colour, width=2.5)
        plot.text((120.0, 50.0 + 13.0 * i), words, colour)
    caption = (
        "Rows: one a direction of the joints [rad/s]. The largest joint acceleration "
        "per unit that a pose asks for, near a straight wrist; cut off at 40."
    )
    return plot.svg("SingularDamping"), caption


PLOTS: dict[str, Callable[[Robot], Picture]] = {
    "Clearance": clearance,
    "TorqueRateLimits": torque_rates,
    "SingularDamping": singular_damping,
}
