"""Pictures of the tasks that are no pose of a tool: speeds, joints, limits, forces."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from site_drawing import BLUE, GREEN, INK, ORANGE, Drawing, Plot

import tasks
from wbc import Robot, Rows, State, Task, allocate_rows

Picture = tuple[str, str]
ZIGZAG = (0, 1, -1, 1, -1, 1, -1, 1, 0)


def _rows(task: Task, state: State) -> Rows:
    task.check(state.robot)
    rows = allocate_rows(len(task.row_names(state.robot)), state.robot.nv)
    task.update(state, rows)
    return rows


def speed(robot: Robot) -> Picture:
    """Speed that is asked for, over time at the start and over way at the end."""
    path = tasks.Line([0.7, 0.0, 0.9], [0.0, 1.0, 0.0], 0.2)
    task = tasks.TravelSpeed("torch_tip", path, speed=0.04, ramp=1.0)
    # The row's error is ds/dt - v_ref. Follow it: s' = v_ref(t, s).
    tip, s, dt = robot.state(robot.q_home).frame("torch_tip").p, 0.0, 0.05
    t = np.arange(0.0, 7.0, dt)
    wanted = np.zeros(t.size)
    for i, now in enumerate(t):
        shifted = tasks.Line(tip - [0.0, s, 0.0], path.direction, path.length)
        moved = tasks.TravelSpeed("torch_tip", shifted, speed=0.04, ramp=1.0)
        wanted[i] = -_rows(moved, robot.state(robot.q_home, t=now)).error[0]
        s += dt * wanted[i]
    plot = Plot((0.0, 7.0), (0.0, 0.04), ("time [s]", "ds/dt [m/s]"))
    plot.curve(t, wanted, width=2.5)
    name = task.row_names(robot)[0]
    caption = (
        f"Rows: {name} [{task.unit}]. A path of 0.2 m at 0.04 m/s with a ramp of 1 s: "
        "it sets off by time and stops by place."
    )
    return plot.svg("TravelSpeed"), caption


CHAIN = ("base", "link1", "link2", "link3", "link4", "link5", "link6", "flange")


def _skeleton(drawing: Drawing, state: State, colour: str, dash: str = "") -> None:
    points = [state.frame(name).p for name in (*CHAIN, "torch_tip")]
    drawing.line(points, colour, 2.5 if dash else 5.0, dash)
    for p in points[1:-2]:
        drawing.dot(p, colour, 3.0)


def posture(robot: Robot) -> Picture:
    """The arm, and the arm at the target."""
    drawing = Drawing([0.4, 0.0, 0.62], 125.0)
    home = robot.state(robot.q_home)
    now = robot.state(robot.q_home + [0.5, 0.35, 0.4, 0.0, 0.5, 0.0])
    _skeleton(drawing, now, INK)
    _skeleton(drawing, home, ORANGE, "4 3")
    caption = (
        "Rows: one a joint [rad or m]. With all joints named it holds everything that "
        "is left, so it goes to the bottom of a stack."
    )
    return drawing.svg("Posture"), caption


def damping(robot: Robot) -> Picture:
    """A joint speed that dies out."""
    task = tasks.Damping(5.0)
    v, dt = np.ones(robot.nv), 0.01
    t = np.arange(0.0, 1.0, dt)
    speeds = np.zeros(t.size)
    for i in range(t.size):
        speeds[i] = v[0]
        v = v + dt * _rows(task, robot.state(robot.q_home, v)).lower
    plot = Plot((0.0, 1.0), (0.0, 1.0), ("time [s]", "joint velocity [rad/s]"))
    plot.curve(t, speeds, width=2.5)
    return plot.svg("Damping"), "Rows: one a joint [rad/s]. Rate 5 per second."


def joint_limits(robot: Robot) -> Picture:
    """Bounds on the acceleration of one joint near its upper limit."""
    task, j = tasks.JointLimits(), 1
    limit = robot.q_max[j]
    gap = np.linspace(0.0, 0.5, 120)
    plot = Plot((0.0, 0.5), (-10.0, 10.0), ("distance from q_max [rad]", "dv/dt"))
    for v, colour in ((0.0, BLUE), (1.0, ORANGE), (2.0, GREEN)):
        upper = []
        for g in gap:
            q, speeds = robot.q_home.copy(), np.zeros(robot.nv)
            q[j], speeds[j] = limit - g, v
            upper.append(_rows(task, robot.state(q, speeds)).upper[j])
        plot.curve(gap, np.clip(upper, -10.0, 10.0), colour, width=2.5)
        plot.text((160.0, 100.0 + 13.0 * v), f"at {v:g} rad/s", colour)
    caption = (
        "Rows: one a joint [rad/s²]. The upper bound on a joint's acceleration over "
        "its distance from the limit, at three speeds: a faster joint must brake "
        "earlier, and never harder than it can."
    )
    return plot.svg("JointLimits"), caption


def torque_limits(robot: Robot) -> Picture:
    """Limits of all joints, and what gravity takes of them at home."""
    plot = Plot((1.0, 6.0), (-1000.0, 1000.0), ("joint", "torque [Nm]"))
    rows = _rows(tasks.TorqueLimits(), robot.state(robot.q_home))
    gravity = robot.state(robot.q_home).gravity()
    for i in range(robot.nv):
        x = 1.0 + i * 0.98 + 0.05
        plot.curve([x, x], [rows.lower[i], rows.upper[i]], BLUE, width=8.0)
        plot.dot(plot.point(x, gravity[i]), ORANGE)
    caption = (
        "Rows: one a joint [Nm or N]. The limits of the example arm, and, as dots, "
        "what its weight takes of them at home."
    )
    return plot.svg("TorqueLimits"), caption


def locking(robot: Robot) -> Picture:
    """What the row asks of a joint in its zone."""
    task, j, zone = tasks.JointLocking(0.1), 1, 0.1
    gap = np.linspace(0.0, 0.3, 200)
    wish = []
    for g in gap:
        q = robot.q_home.copy()
        q[j] = robot.q_max[j] - g
        rows = _rows(task, robot.state(q))
        wish.append(rows.lower[j] if rows.lower[j] == rows.upper[j] else np.nan)
    wish = np.array(wish)
    inside = ~np.isnan(wish)
    plot = Plot((0.0, 0.3), (-20.0, 20.0), ("distance from q_max [rad]", "dv/dt"))
    plot.curve(gap[inside], wish[inside], ORANGE, width=2.5)
    edge = [plot.point(zone, -20.0), plot.point(zone, 20.0)]
    plot.line(edge, BLUE, 1.0, "4 3")
    plot.text((edge[0][0] + 5.0, 40.0), "outside: no row", BLUE)
    caption = (
        "Rows: one a joint [rad]. The acceleration asked of a joint at rest in its "
        "zone of 0.1 rad: towards the middle of the zone."
    )
    return plot.svg("JointLocking"), caption


def _tool(d: Drawing, tip, lean: float = 0.25) -> None:
    d.line([tip, tip + np.array([0.0, -lean * 0.13, 0.13])], INK, 5.0)
    d.dot(tip)


def _ground(d: Drawing, z: float) -> None:
    corners = [[0.1, -0.18, z], [0.1, 0.18, z], [-0.1, 0.18, z], [-0.1, -0.18, z]]
    d.line(corners, BLUE, 1.5, fill=BLUE)


def hybrid(robot: Robot) -> Picture:
    """Force down, motion along."""
    d, tip = Drawing(), np.array([0.0, -0.04, -0.06])
    _ground(d, tip[2])
    _tool(d, tip)
    d.arrow(tip, tip + [0.0, 0.13, 0.0], GREEN, 2.5)
    d.arrow(tip, tip + [0.0, 0.0, -0.09], ORANGE, 2.5)
    d.text(d.at(tip + [0.0, 0.03, -0.085]), "force", ORANGE)
    d.text(d.at(tip + [0.0, 0.11, 0.02]), "motion", GREEN)
    caption = "Rows: 3 or 6 in the task's own axes, each one of motion or of force."
    return d.svg("HybridForceMotion"), caption


def _spring(d: Drawing, a, b, colour: str) -> None:
    a, b = d.at(a), d.at(b)
    way = b - a
    across = np.array([-way[1], way[0]]) / np.linalg.norm(way) * 6.0
    bends = [
        a + way * s + across * k
        for s, k in zip(np.linspace(0.2, 0.8, 9), ZIGZAG, strict=True)
    ]
    d.line([a, *bends, b], colour, 1.5)


def impedance(robot: Robot) -> Picture:
    """A spring from the tip to a target."""
    d, tip = Drawing(), np.array([0.0, -0.08, -0.02])
    goal = np.array([0.0, 0.12, -0.05])
    _tool(d, tip)
    _spring(d, tip, goal, BLUE)
    d.dot(goal, BLUE, 5.0)
    d.arrow(tip, tip + [0.0, -0.08, -0.05], ORANGE)
    d.text(d.at(tip + [0.0, -0.1, -0.08]), "h", ORANGE)
    d.text(d.at(goal + [0.0, 0.0, -0.035]), "x_d", BLUE, "middle")
    caption = (
        "Rows: p x, p y, p z [m] in the task's axes. The tip is a mass on a spring and "
        "a damper; h is what it exerts on its surroundings."
    )
    return d.svg("Impedance"), caption


def admittance(robot: Robot) -> Picture:
    """A spring from the reference to the target, and the tip that follows it."""
    d, tip = Drawing(), np.array([0.0, -0.10, -0.02])
    reference, goal = np.array([0.0, -0.03, -0.03]), np.array([0.0, 0.14, -0.05])
    _tool(d, tip)
    _spring(d, reference, goal, BLUE)
    d.dot(goal, BLUE, 5.0)
    d.dot(reference, GREEN, 5.0)
    d.arrow(tip, reference, GREEN, 1.5)
    d.text(d.at(reference + [0.0, 0.0, -0.04]), "x_c", GREEN, "middle")
    d.text(d.at(goal + [0.0, 0.0, -0.035]), "x_d", BLUE, "middle")
    caption = (
        "Rows: p x, p y, p z [m] in the task's axes. The reference x_c gives way; the "
        "tip follows it."
    )
    return d.svg("Admittance"), caption


PLOTS: dict[str, Callable[[Robot], Picture]] = {
    "TravelSpeed": speed,
    "Posture": posture,
    "Damping": damping,
    "JointLimits": joint_limits,
    "TorqueLimits": torque_limits,
    "JointLocking": locking,
    "HybridForceMotion": hybrid,
    "Impedance": impedance,
    "Admittance": admittance,
}
