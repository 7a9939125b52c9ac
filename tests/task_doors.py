"""What the catalogue of tasks exports, each with arguments that it takes."""

from __future__ import annotations

import numpy as np

import tasks
from tests.doors import ARM, HERE, TIP, UP, UPRIGHT, Door, position

__all__ = ["TASK_DOORS"]

ALONG = np.linspace(0.0, 0.1, 8)
CURVE = np.column_stack([ALONG, ALONG**2, np.full(8, 0.5)])
POINT, LINE = tasks.Point(on=TIP), tasks.Line(HERE, UP, on=TIP)
PLANE, CIRCLE = tasks.Plane(HERE, UP), tasks.Circle(HERE, UP, 0.1)
AXIS, TUBE = tasks.Line(HERE, UP), tasks.Cylinder(HERE, UP, 0.1)
SIX = {"position": HERE, "orientation": UPRIGHT}
LINES = {"first": LINE, "second": AXIS}
PLANES = {"first": tasks.Plane(HERE, UP, on=TIP), "second": PLANE}
TARGET = {"frame": TIP, "target": HERE}
WRIST = {**TARGET, "sensor_frame": TIP}


def pose() -> tasks.FramePose:
    return tasks.FramePose(TIP, HERE, UPRIGHT)


def press(rows: int = 3) -> tasks.HybridForceMotion:
    S, R = [0] * (rows - 1) + [1], None if rows == 3 else UPRIGHT
    force = np.zeros(rows)
    return tasks.HybridForceMotion(TIP, HERE, force, S, orientation=R, sensor_frame=TIP)


def impedance() -> tasks.Impedance:
    return tasks.Impedance(TIP, HERE, sensor_frame=TIP)


def motion(position: object = HERE, orientation: object = UPRIGHT) -> object:
    return tasks.MovingFrame(tasks.FrameMotion(position, orientation))


def twist(twist: object = (0.0,) * 6, acceleration: object = (0.0,) * 6) -> object:
    return tasks.MovingFrame(tasks.FrameMotion(twist=twist, acceleration=acceleration))


def set_speed(speed: float) -> None:
    tasks.TravelSpeed(TIP, tasks.Line(HERE, UP, 1.0), speed=1.0).speed = speed


def set_fraction(fraction: float) -> None:
    tasks.TorqueLimits().fraction = fraction


def set_rate(rate: object) -> None:
    tasks.TorqueRateLimits().rate = rate


TASK_DOORS = [
    Door(set_speed, {"speed": 1.0}),
    Door(set_fraction, {"fraction": 1.0}),
    Door(set_rate, {"rate": 1.0}),
    Door(tasks.FramePosition, TARGET),
    Door(tasks.FramePosition.set_target, {"target": HERE}, position),
    Door(tasks.FrameOrientation, {"frame": TIP, "target": UPRIGHT}),
    Door(
        tasks.FrameOrientation.set_target,
        {"target": UPRIGHT},
        lambda: tasks.FrameOrientation(TIP, UPRIGHT),
    ),
    Door(tasks.FramePose, {"frame": TIP, **SIX}),
    Door(tasks.FramePose.set_target, SIX, pose),
    Door(tasks.KnifePose, {"frame": TIP, **SIX, "sensor_frame": TIP}),
    Door(tasks.KnifePose.set_target, SIX, lambda: tasks.KnifePose(TIP, HERE, UPRIGHT)),
    Door(tasks.AxisAlignment, {"frame": TIP, "direction": UP}),
    Door(
        tasks.AxisAlignment.set_target,
        {"direction": UP},
        lambda: tasks.AxisAlignment(TIP, UP),
    ),
    Door(tasks.AxisAlongPath, {"frame": TIP, "path": AXIS}),
    Door(tasks.PointOnCurve, {"frame": TIP, "curve": AXIS}),
    Door(
        tasks.TravelSpeed,
        {"frame": TIP, "path": tasks.Line(HERE, UP, 1.0), "speed": 0.1},
    ),
    Door(tasks.Curve, {"points": CURVE}),
    Door(tasks.Curve.locate, {"p": HERE}, lambda: AXIS),
    Door(tasks.Curve.at, {"s": 0.1}, lambda: AXIS),
    Door(tasks.Posture),
    Door(tasks.Posture.set_target, {"target": ARM.q_home}, tasks.Posture),
    Door(tasks.Damping),
    Door(tasks.JointLimits),
    Door(tasks.JointLocking),
    Door(tasks.TorqueLimits),
    Door(tasks.TorqueRateLimits),
    Door(tasks.SingularDamping, {"task": position()}),
    Door(tasks.Clearance, {"first": TIP, "second": "link3", "distance": 0.1}),
    Door(tasks.ForceLaw),
    Door(tasks.HybridForceMotion, {**WRIST, "force": [0.0, 0.0, 1.0]}),
    Door(tasks.HybridForceMotion.set_target, {"target": HERE}, lambda: press(6)),
    Door(tasks.HybridForceMotion.set_force, {"force": UP}, press),
    Door(tasks.HybridForceMotion.set_axes, {"axes": UPRIGHT}, press),
    Door(tasks.Impedance, WRIST),
    Door(tasks.Impedance.set_target, {"target": HERE}, impedance),
    Door(tasks.Impedance.set_force, {"force": UP}, impedance),
    Door(tasks.Admittance, WRIST),
    # features and constraints
    Door(tasks.Point),
    Door(tasks.Line, {"point": HERE, "direction": UP}),
    Door(tasks.Line.between, {"start": HERE, "end": [1.0, 1.0, 1.0]}),
    Door(tasks.Plane, {"point": HERE, "normal": UP}),
    Door(tasks.Plane.distance, {"p": HERE}, lambda: PLANE),
    Door(tasks.Circle, {"centre": HERE, "normal": UP, "radius": 0.1}),
    Door(tasks.Cylinder, {"top": HERE, "direction": UP, "radius": 0.1}),
    Door(motion),
    Door(twist),
    Door(tasks.MovingFrame),
    Door(tasks.MovingFrame.steady),
    Door(tasks.MovingFrame.set, {}, tasks.MovingFrame),
    Door(tasks.PointOnPoint, {"point": TIP, "target": HERE}),
    Door(tasks.PointOnLine, {"point": TIP, "line": AXIS}),
    Door(tasks.PointOnPlane, {"point": TIP, "plane": PLANE}),
    Door(tasks.PointOnCircle, {"point": TIP, "circle": CIRCLE}),
    Door(tasks.PointOnCylinder, {"point": TIP, "cylinder": TUBE}),
    Door(tasks.DistanceToPoint, {"point": TIP, "target": HERE, "distance": 0.1}),
    Door(tasks.DistanceToLine, {"point": TIP, "line": AXIS, "distance": 0.1}),
    Door(tasks.DistanceToPlane, {"point": TIP, "plane": PLANE, "distance": 0.1}),
    Door(tasks.LineOnLine, LINES),
    Door(tasks.ParallelLines, LINES),
    Door(tasks.PerpendicularLines, LINES),
    Door(tasks.AngleBetweenLines, {**LINES, "angle": 1.0}),
    Door(tasks.LineInPlane, {"line": LINE, "plane": PLANE}),
    Door(tasks.ParallelPlanes, PLANES),
    Door(tasks.PlaneOnPlane, PLANES),
    Door(tasks.rim_grasp, {"frame": TIP, "cylinder": TUBE}),
]
