"""Every task once, and random stacks: what the general properties are proved on.

A new task is subjected to all of them by one line in `CATALOGUE`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
import pinocchio as pin

import tasks
from tests.arms import TIPS
from wbc import Hierarchy, Level, Robot, Rows, State, Task

Kind = Literal["exact", "near zero", "velocity", "force", "bounds"]
Rng = np.random.Generator
FELT = np.array([3.0, -8.0, 11.0, 0.4, 0.2, -0.7])  # [N, Nm]


def _still(t: float) -> None:
    """A target that does not move."""


@dataclass(frozen=True)
class Subject:
    """A task, and how its target moves: `move(t)` puts it where it is at time t."""

    task: Task
    move: Callable[[float], None] = _still


@dataclass(frozen=True)
class Entry:
    """One task of the catalogue.

    kind: "exact" where d(error)/dt is the rate everywhere, "near zero" where only at
    a small error (errors that are rotations), "velocity" where the error is itself
    the rate, "force" for tasks that answer a measured wrench, "bounds" for inequality
    tasks.
    make: (state, rng, aligned) -> Subject in generic position, or at zero error.
    """

    kind: Kind
    make: Callable[[State, Rng, bool], Subject]


def tip(robot: Robot) -> str:
    return TIPS[robot.name]


def random_state(robot: Robot, rng: Rng, t: float = 0.0) -> State:
    """Inside the position limits (or a turn), at a good part of the speed limits.

    A sensor "wrist" feels a wrench.
    """
    low, high = np.maximum(robot.q_min, -3.0), np.minimum(robot.q_max, 3.0)
    q = rng.uniform(low, high)
    v = rng.uniform(-0.5, 0.5, robot.nv) * robot.v_max
    return robot.state(q, v, t, wrenches={"wrist": FELT})


def random_rotation(rng: Rng, size: float = 2.0) -> np.ndarray:
    w = rng.normal(size=3)
    return np.array(pin.exp3(size * rng.uniform(0.2, 1.0) * w / np.linalg.norm(w)))


def turning(rng: Rng) -> Callable[[float], tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """R(t), omega(t), alpha(0) of a frame that turns about changing axes."""
    omega, alpha = rng.normal(size=3), rng.normal(size=3)

    def at(t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        late = np.array(pin.exp3(0.5 * t * t * alpha))
        R = late @ np.array(pin.exp3(t * omega))
        return R, t * alpha + late @ omega, alpha

    return at


# ------------------------------------------------------------------- the factories


def _near(state: State, rng: Rng, aligned: bool, size: float = 0.1) -> np.ndarray:
    p = state.frame(tip(state.robot)).p
    return p if aligned else p + rng.uniform(-size, size, 3)


def _position(state: State, rng: Rng, aligned: bool) -> Subject:
    p, pd, pdd = _near(state, rng, aligned), rng.normal(size=3), rng.normal(size=3)
    task = tasks.FramePosition(tip(state.robot), p)
    return Subject(
        task,
        lambda t: task.set_target(p + t * pd + 0.5 * t * t * pdd, pd + t * pdd, pdd),
    )


def _target(state: State, rng: Rng, aligned: bool) -> np.ndarray:
    R = state.frame(tip(state.robot)).R
    return R if aligned else random_rotation(rng) @ R


def _orientation(state: State, rng: Rng, aligned: bool) -> Subject:
    R, turn = _target(state, rng, aligned), turning(rng)
    task = tasks.FrameOrientation(tip(state.robot), R)

    def move(t: float) -> None:
        turned, omega, alpha = turn(t)
        task.set_target(turned @ R, omega, alpha)

    return Subject(task, move)


def _pose(state: State, rng: Rng, aligned: bool) -> Subject:
    p, R = _near(state, rng, aligned), _target(state, rng, aligned)
    pd, pdd, turn = rng.normal(size=3), rng.normal(size=3), turning(rng)
    task = tasks.FramePose(tip(state.robot), p, R)

    def move(t: float) -> None:
        turned, omega, alpha = turn(t)
        task.set_target(
            p + t * pd + 0.5 * t * t * pdd,
            turned @ R,
            np.concatenate([pd + t * pdd, omega]),
            np.concatenate([pdd, alpha]),
        )

    return Subject(task, move)


def _axis(state: State, rng: Rng, aligned: bool) -> Subject:
    axis, turn = rng.normal(size=3), turning(rng)
    n = _target(state, rng, aligned) @ axis
    task = tasks.AxisAlignment(tip(state.robot), n, axis=axis)

    def move(t: float) -> None:
        turned, omega, alpha = turn(t)
        task.set_target(turned @ n, omega, alpha)

    return Subject(task, move)


def curve_near(state: State, rng: Rng) -> tasks.Curve:
    """A bent and twisted curve that passes the tip at a few centimetres."""
    u = np.linspace(-1.0, 1.0, 21)
    shape = np.stack([0.3 * u, 0.08 * np.sin(2.0 * u), 0.06 * np.cos(2.5 * u)], axis=1)
    middle = _near(state, rng, False, 0.02) - [0.0, 0.0, 0.06]
    return tasks.Curve(shape @ random_rotation(rng).T + middle)


def _along(state: State, rng: Rng, aligned: bool) -> Subject:
    frame, path = tip(state.robot), curve_near(state, rng)
    work, travel = rng.uniform(-0.5, 0.5, 2)
    draft = tasks.AxisAlongPath(frame, path, work=work, travel=travel)
    F = state.frame(frame)
    axis = rng.normal(size=3)
    if aligned:
        axis = F.R.T @ draft.direction_at(path.at(path.locate(F.p)))[0]
    return Subject(
        tasks.AxisAlongPath(frame, path, work=work, travel=travel, axis=axis)
    )


CARRIERS = ("world", "set", "steady", "function", "robot")
"""What the other feature of a constraint can be fixed in."""
MIDDLE = {"racer": "link3", "seven": "link4"}
"""A frame further up the arm, for features of the same robot."""


@dataclass(frozen=True)
class Place:
    """A carrier somewhere, its pose now, and how to put it where it is at time t."""

    on: tasks.geometry.features.Carrier
    p: np.ndarray
    R: np.ndarray
    move: Callable[[float], None] = _still

    def local(self, point: np.ndarray) -> np.ndarray:
        """A point of the world in the carrier's axes."""
        return self.R.T @ (point - self.p)


def place(kind: str, state: State, rng: Rng) -> Place:
    """A carrier of a kind, in general position and motion."""
    if kind == "world":
        return Place(None, np.zeros(3), np.eye(3))
    if kind == "robot":
        F = state.frame(MIDDLE[state.robot.name])
        return Place(MIDDLE[state.robot.name], F.p, F.R)
    p, R, turn = rng.normal(size=3), random_rotation(rng), turning(rng)
    v, a, spin = rng.normal(size=3), rng.normal(size=3), rng.normal(size=3)
    if kind == "steady":
        return Place(
            tasks.MovingFrame.steady(
                v, spin=spin, acceleration=a, position=p, orientation=R, start=state.t
            ),
            p,
            R,
        )

    def at(t: float) -> tasks.FrameMotion:
        turned, omega, alpha = turn(t)
        return tasks.FrameMotion(
            p + t * v + 0.5 * t * t * a,
            turned @ R,
            np.concatenate([v + t * a, omega]),
            np.concatenate([a, alpha]),
        )

    if kind == "function":
        return Place(tasks.MovingFrame(lambda t: at(t - state.t)), p, R)
    frame = tasks.MovingFrame(at(0.0))

    def move(t: float) -> None:
        now = at(t)
        frame.set(now.position, now.orientation, now.twist, now.acceleration)

    return Place(frame, p, R, move)


def two_places(state: State, rng: Rng, kind: str | None = None) -> list[Place]:
    """The robot's tip and another carrier, in either order."""
    other = place(kind or str(rng.choice(CARRIERS)), state, rng)
    F = state.frame(tip(state.robot))
    places = [Place(tip(state.robot), F.p, F.R), other]
    return places if rng.uniform() < 0.7 else places[::-1]


def _a_point(place: Place, p: np.ndarray, n: np.ndarray):
    del n
    return tasks.Point(place.local(p), on=place.on)


def _a_line(place: Place, p: np.ndarray, n: np.ndarray):
    return tasks.Line(place.local(p), place.R.T @ n, on=place.on)


def _a_plane(place: Place, p: np.ndarray, n: np.ndarray):
    return tasks.Plane(place.local(p), place.R.T @ n, on=place.on)


def _a_circle(place: Place, p: np.ndarray, n: np.ndarray):
    return tasks.Circle(place.local(p), place.R.T @ n, 0.15, on=place.on)


def _a_cylinder(place: Place, p: np.ndarray, n: np.ndarray):
    return tasks.Cylinder(place.local(p), place.R.T @ n, 0.15, on=place.on)


def _moving(task: Task, places: list[Place]) -> Subject:
    return Subject(task, lambda t: [place.move(t) for place in places] and None)


Make = Callable[..., Subject]


def _point_on(kind: type[Task], feature: Callable, *more: float) -> Make:
    """A point of the first carrier near a feature of the second."""

    def make(state: State, rng: Rng, aligned: bool, on: str | None = None) -> Subject:
        places = two_places(state, rng, on)
        p, n = state.frame(tip(state.robot)).p, rng.normal(size=3)
        away = np.zeros(3) if aligned else rng.uniform(-0.1, 0.1, 3)
        point = _a_point(places[0], p + rng.uniform(-0.1, 0.1, 3), n)
        return _moving(kind(point, feature(places[1], p + away, n), *more), places)

    return make


PAIRS = {
    tasks.LineInPlane: (_a_line, _a_plane),
    tasks.ParallelPlanes: (_a_plane, _a_plane),
    tasks.PlaneOnPlane: (_a_plane, _a_plane),
}


def _lines(kind: type[Task], sensed: bool, *more: float) -> Make:
    """Two features with directions; aligned, they lie along each other."""

    def make(state: State, rng: Rng, aligned: bool, on: str | None = None) -> Subject:
        places = two_places(state, rng, on)
        p, n = state.frame(tip(state.robot)).p, rng.normal(size=3)
        sense = str(rng.choice(["same", "opposite", "nearest"])) if sensed else "same"
        first, second = PAIRS.get(kind, (_a_line, _a_line))
        away = np.zeros(3) if aligned else rng.uniform(-0.1, 0.1, 3)
        m = -n if sense == "opposite" else n
        m = m if aligned else random_rotation(rng) @ n
        options = {"sense": sense} if sensed else {}
        a, b = first(places[0], p, n), second(places[1], p + away, m)
        return _moving(kind(a, b, *more, **options), places)

    return make


def _speed(state: State, rng: Rng, aligned: bool) -> Subject:
    """On the curve, while the speed still rises and already falls."""
    frame, path = tip(state.robot), curve_near(state, rng)
    s = path.locate(state.frame(frame).p)
    return Subject(
        tasks.TravelSpeed(
            frame, path, speed=0.1, ramp=0.8, start=state.t - 0.3, end=s + 0.03
        )
    )


def _hybrid(state: State, rng: Rng, aligned: bool) -> Subject:
    frame = tip(state.robot)
    return Subject(
        tasks.HybridForceMotion(
            frame,
            _near(state, rng, aligned),
            rng.normal(size=6),
            (0, 1, 0, 1, 0, 0),
            orientation=_target(state, rng, aligned),
            axes=random_rotation(rng),
            sensor_frame=frame,
        )
    )


def _knife(state: State, rng: Rng, aligned: bool) -> Subject:
    """A blade that may rock about its normal: rows of two kernels."""
    p, R = _near(state, rng, aligned), _target(state, rng, aligned)
    pd, pdd, turn = rng.normal(size=3), rng.normal(size=3), turning(rng)
    task = tasks.KnifePose(tip(state.robot), p, R, rocking=True)

    def move(t: float) -> None:
        turned, omega, alpha = turn(t)
        task.set_target(
            p + t * pd + 0.5 * t * t * pdd,
            turned @ R,
            np.concatenate([pd + t * pdd, omega]),
            np.concatenate([pdd, alpha]),
        )

    return Subject(task, move)


def _compliant(kind: type[tasks.Impedance] | type[tasks.Admittance]):
    def make(state: State, rng: Rng, aligned: bool) -> Subject:
        frame = tip(state.robot)
        target, axes = _near(state, rng, aligned), random_rotation(rng)
        return Subject(kind(frame, target, axes=axes, sensor_frame=frame))

    return make


def _singular(state: State, rng: Rng, aligned: bool) -> Subject:
    """So wide a threshold that most directions are damped."""
    goal = tasks.FramePosition(tip(state.robot), _near(state, rng, aligned))
    return Subject(tasks.SingularDamping(goal, threshold=0.6))


CATALOGUE: dict[type[Task], Entry] = {
    tasks.FramePosition: Entry("exact", _position),
    tasks.FrameOrientation: Entry("near zero", _orientation),
    tasks.FramePose: Entry("near zero", _pose),
    tasks.PointOnPoint: Entry("exact", _point_on(tasks.PointOnPoint, _a_point)),
    tasks.PointOnLine: Entry("exact", _point_on(tasks.PointOnLine, _a_line)),
    tasks.PointOnPlane: Entry("exact", _point_on(tasks.PointOnPlane, _a_plane)),
    tasks.PointOnCircle: Entry("exact", _point_on(tasks.PointOnCircle, _a_circle)),
    tasks.PointOnCylinder: Entry(
        "exact", _point_on(tasks.PointOnCylinder, _a_cylinder)
    ),
    tasks.DistanceToPoint: Entry(
        "exact", _point_on(tasks.DistanceToPoint, _a_point, 0.2)
    ),
    tasks.DistanceToLine: Entry("exact", _point_on(tasks.DistanceToLine, _a_line, 0.2)),
    tasks.DistanceToPlane: Entry(
        "exact", _point_on(tasks.DistanceToPlane, _a_plane, -0.2)
    ),
    tasks.PerpendicularLines: Entry("exact", _lines(tasks.PerpendicularLines, False)),
    tasks.AngleBetweenLines: Entry(
        "exact", _lines(tasks.AngleBetweenLines, False, 0.7)
    ),
    tasks.LineInPlane: Entry("exact", _lines(tasks.LineInPlane, False)),
    tasks.LineOnLine: Entry("near zero", _lines(tasks.LineOnLine, True)),
    tasks.ParallelLines: Entry("near zero", _lines(tasks.ParallelLines, True)),
    tasks.ParallelPlanes: Entry("near zero", _lines(tasks.ParallelPlanes, True)),
    tasks.PlaneOnPlane: Entry("near zero", _lines(tasks.PlaneOnPlane, True)),
    tasks.PointOnCurve: Entry(
        "exact",
        lambda s, g, z: Subject(tasks.PointOnCurve(tip(s.robot), curve_near(s, g))),
    ),
    tasks.AxisAlignment: Entry("near zero", _axis),
    tasks.AxisAlongPath: Entry("near zero", _along),
    tasks.TravelSpeed: Entry("velocity", _speed),
    tasks.Posture: Entry(
        "exact", lambda s, g, z: Subject(tasks.Posture(g.uniform(-1, 1, s.robot.nv)))
    ),
    tasks.Damping: Entry("velocity", lambda s, g, z: Subject(tasks.Damping())),
    tasks.KnifePose: Entry("near zero", _knife),
    tasks.HybridForceMotion: Entry("force", _hybrid),
    tasks.Impedance: Entry("force", _compliant(tasks.Impedance)),
    tasks.Admittance: Entry("force", _compliant(tasks.Admittance)),
    tasks.Clearance: Entry(
        "bounds", lambda s, g, z: Subject(tasks.Clearance(*s.robot.frames[-2:], 0.05))
    ),
    tasks.SingularDamping: Entry("bounds", _singular),
    tasks.JointLocking: Entry("bounds", lambda s, g, z: Subject(tasks.JointLocking())),
    tasks.JointLimits: Entry("bounds", lambda s, g, z: Subject(tasks.JointLimits())),
    tasks.TorqueLimits: Entry("bounds", lambda s, g, z: Subject(tasks.TorqueLimits())),
    tasks.TorqueRateLimits: Entry(
        "bounds", lambda s, g, z: Subject(tasks.TorqueRateLimits())
    ),
}

MOTION = {
    task: entry
    for task, entry in CATALOGUE.items()
    if entry.kind not in ("force", "bounds")
}


# ----------------------------------------------------------------- rows of one's own


class RawRows(Task):
    """A test's own matrices as a task: lower <= A vdot <= upper."""

    def __init__(self, name: str, A, lower, upper=None) -> None:
        super().__init__(name, "-")
        self.A, self.lower = np.array(A, dtype=float), np.array(lower, dtype=float)
        self.upper = self.lower if upper is None else np.array(upper, dtype=float)

    def row_names(self, robot: Robot) -> tuple[str, ...]:
        return tuple(f"{self.name} {i}" for i in range(self.lower.size))

    def update(self, state: State, rows: Rows) -> None:
        rows.A[:], rows.lower[:], rows.upper[:] = self.A, self.lower, self.upper


Levels = list[tuple[np.ndarray, np.ndarray, np.ndarray]]


def hierarchy_of(levels: Levels) -> Hierarchy:
    return Hierarchy(
        *(Level.of(RawRows(f"level {k}", *rows)) for k, rows in enumerate(levels, 1))
    )


def random_equalities(rng: Rng, n: int, count: int | None = None) -> Levels:
    """3 to 5 levels; every other one is singular, or conflicts with those above."""
    levels: Levels = []
    for _ in range(count or int(rng.integers(3, 6))):
        m = int(rng.integers(1, 5))
        A = rng.normal(size=(m, n))
        kind = rng.choice(["plain", "plain", "singular", "conflict", "zero", "mixed"])
        above = np.vstack([a for a, _, _ in levels]) if levels else None
        if kind == "singular":
            A = rng.normal(size=(m, 1)) @ rng.normal(size=(1, n))
        elif kind == "zero":
            A[int(rng.integers(m))] = 0.0
        elif kind == "conflict" and above is not None:
            A = rng.normal(size=(m, above.shape[0])) @ above
        elif kind == "mixed" and above is not None:
            A[0] = above[int(rng.integers(above.shape[0]))]
        b = 5.0 * rng.normal(size=m)
        levels.append((A, b, b.copy()))
    return levels


def random_inequalities(rng: Rng, n: int) -> Levels:
    """3 to 5 levels, each with bounds on one or both sides, and some equalities."""
    levels: Levels = []
    for A, b, _ in random_equalities(rng, n):
        sides = rng.choice(["both", "lower", "upper", "equal"], b.size)
        sides[int(rng.integers(b.size))] = rng.choice(["both", "lower", "upper"])
        width = rng.exponential(2.0, b.size)
        lower = np.where(sides == "upper", -np.inf, b)
        upper = np.where(sides == "lower", np.inf, b + width)
        equal = sides == "equal"
        levels.append((A, lower, np.where(equal, b, upper)))
    return levels
