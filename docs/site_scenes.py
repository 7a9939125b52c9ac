"""What each task's picture shows: features, and the task between them and the tool.

Each scene takes the tool's pose p (3,), R (3, 3) and gives the tasks and a function
that draws the features.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pinocchio as pin
from site_drawing import BLUE, Drawing
from site_features import draw_cylinder, draw_line, draw_path, draw_plane, draw_triad

import tasks
from wbc import Task

TIP = "torch_tip"
X, Y, Z = np.eye(3)
UP = np.array([0.12, 0.05, 1.0])
"""A direction near to the vertical; normals of planes in the pictures."""
ALONG = np.array([0.25, 1.0, 0.1])
"""Direction of lines in the pictures."""
Scene = tuple[list[Task], Callable[[Drawing], None]]


def _turned(R: np.ndarray, *angle: float) -> np.ndarray:
    return np.array(pin.exp3(np.array(angle))) @ R


def position(p, R) -> Scene:
    """A target point."""
    goal = p + [0.02, 0.1, -0.04]
    return [tasks.FramePosition(TIP, goal)], lambda d: d.dot(goal, BLUE, 5.0)


def orientation(p, R) -> Scene:
    """A target triad beside the tool."""
    goal = _turned(R, -0.5, 0.2, 0.4)
    show = p + [0.0, 0.17, 0.0]
    return [tasks.FrameOrientation(TIP, goal)], lambda d: draw_triad(d, show, goal)


def pose(p, R) -> Scene:
    """A target triad at its place."""
    goal, turned = p + [0.0, 0.11, -0.03], _turned(R, -0.4, 0.2, 0.3)
    return [tasks.FramePose(TIP, goal, turned)], lambda d: draw_triad(d, goal, turned)


def knife(p, R) -> Scene:
    """The plane that a blade should lie in, with the point for its tip."""
    goal, turned = p + [0.0, 0.1, -0.03], _turned(R, -0.35, 0.15, 0.3)
    task = tasks.KnifePose(TIP, goal, turned)
    plane = tasks.Plane(goal, turned[:, 1])

    def draw(d: Drawing) -> None:
        draw_plane(d, plane, 0.1)
        d.dot(goal, BLUE, 5.0)

    return [task], draw


def on_point(p, R) -> Scene:
    """A point."""
    goal = p + [0.02, 0.1, -0.04]
    return [tasks.PointOnPoint(TIP, goal)], lambda d: d.dot(goal, BLUE, 5.0)


def on_line(p, R) -> Scene:
    """A line."""
    line = tasks.Line(p + [0.0, 0.04, -0.09], ALONG)
    return [tasks.PointOnLine(TIP, line)], lambda d: draw_line(d, line)


def on_plane(p, R) -> Scene:
    """A plane."""
    plane = tasks.Plane(p - 0.08 * Z, UP)
    return [tasks.PointOnPlane(TIP, plane)], lambda d: draw_plane(d, plane)


def on_circle(p, R) -> Scene:
    """A circle."""
    ring = tasks.Circle(p + [0.02, 0.06, -0.07], UP, 0.10)
    return (
        [tasks.PointOnCircle(TIP, ring)],
        lambda d: d.ring(ring.centre, ring.normal, ring.radius, width=2.5),
    )


def on_cylinder(p, R) -> Scene:
    """A cylinder's mantle."""
    can = tasks.Cylinder(p + [0.0, 0.13, 0.04], UP, 0.06)
    return [tasks.PointOnCylinder(TIP, can)], lambda d: draw_cylinder(d, can)


def from_point(p, R) -> Scene:
    """A sphere around a point."""
    goal = p + [0.0, 0.13, -0.05]

    def draw(d: Drawing) -> None:
        d.dot(goal, BLUE, 5.0)
        d.ring(goal, X, 0.08, dash="3 3", width=1.0)
        d.ring(goal, Z, 0.08, dash="3 3", width=1.0)

    return [tasks.DistanceToPoint(TIP, goal, 0.08)], draw


def from_line(p, R) -> Scene:
    """A mantle around a line."""
    line = tasks.Line(p + [0.0, 0.02, -0.12], ALONG)

    def draw(d: Drawing) -> None:
        draw_line(d, line)
        for s in (-0.12, 0.0, 0.12):
            centre = line.point + s * line.direction
            d.ring(centre, line.direction, 0.06, dash="3 3", width=1.0)

    return [tasks.DistanceToLine(TIP, line, 0.06)], draw


def from_plane(p, R) -> Scene:
    """A plane, and the distance from it."""
    plane = tasks.Plane(p - 0.13 * Z, UP)
    return [tasks.DistanceToPlane(TIP, plane, 0.06)], lambda d: draw_plane(d, plane)


def _axis(R) -> tasks.Line:
    return tasks.Line([0.0, 0.0, 0.0], Z, on=TIP)


def line_on_line(p, R) -> Scene:
    """The tool's axis and a line."""
    line = tasks.Line(p + [0.02, 0.08, -0.03], [0.3, 0.25, -1.0])
    task = tasks.LineOnLine(_axis(R), line)
    return [task], lambda d: draw_line(d, line, 0.14)


def parallel(p, R) -> Scene:
    """The tool's axis and a line elsewhere."""
    line = tasks.Line(p + [0.0, 0.13, 0.03], [0.2, 0.35, -1.0])
    return [tasks.ParallelLines(_axis(R), line)], lambda d: draw_line(d, line, 0.12)


def perpendicular(p, R) -> Scene:
    """The tool's axis across a line elsewhere."""
    line = tasks.Line(p + [0.0, 0.02, -0.09], [0.1, 1.0, 0.5])
    return [tasks.PerpendicularLines(_axis(R), line)], lambda d: draw_line(
        d, line, 0.16
    )


def angle(p, R) -> Scene:
    """The tool's axis at 60 degrees to a line elsewhere."""
    line = tasks.Line(p + [0.0, 0.02, -0.09], [0.1, 1.0, 0.2])
    task = tasks.AngleBetweenLines(_axis(R), line, np.pi / 3.0)
    return [task], lambda d: draw_line(d, line, 0.16)


def in_plane(p, R) -> Scene:
    """The tool's axis in an upright plane."""
    plane = tasks.Plane(p + [0.0, 0.07, 0.03], [0.15, 1.0, 0.3])
    task = tasks.LineInPlane(_axis(R), plane)
    return [task], lambda d: draw_plane(d, plane)


def _face() -> tasks.Plane:
    return tasks.Plane([0.0, 0.0, 0.0], Z, on=TIP)


def parallel_planes(p, R) -> Scene:
    """The tool's face and a plane."""
    plane = tasks.Plane(p - 0.09 * Z, UP)
    task = tasks.ParallelPlanes(_face(), plane, sense="opposite")
    return [task], lambda d: draw_plane(d, plane)


def plane_on_plane(p, R) -> Scene:
    """The tool's face on a plane."""
    plane = tasks.Plane(p - 0.09 * Z, UP)
    task = tasks.PlaneOnPlane(_face(), plane, sense="opposite")
    return [task], lambda d: draw_plane(d, plane)


def rim(p, R) -> Scene:
    """A gripper at the rim of a can."""
    can = tasks.Cylinder(p + [0.02, 0.1, -0.05], Z, 0.06)
    level = tasks.rim_grasp(TIP, can, depth=0.02)
    return [task for task, _ in level.terms], lambda d: draw_cylinder(d, can, 0.1)


def _bow(p) -> tasks.Curve:
    u = np.linspace(-1.0, 1.0, 15)
    bow = np.stack([0.06 * u**2, 0.17 * u, 0.05 * np.sin(2.5 * u)], axis=1)
    return tasks.Curve(p + [0.0, 0.03, -0.08] + bow, normals=Z)


def on_curve(p, R) -> Scene:
    """A curve in space."""
    curve = _bow(p)
    return [tasks.PointOnCurve(TIP, curve)], lambda d: draw_path(d, curve)


def along_path(p, R) -> Scene:
    """The tool's axis at angles to a path."""
    curve = _bow(p)
    task = tasks.AxisAlongPath(TIP, curve, work=0.0, travel=0.35)
    return [task], lambda d: draw_path(d, curve)


def alignment(p, R) -> Scene:
    """The tool's axis along a direction."""
    n = np.array([0.3, 0.3, -1.0])
    show = p + [0.0, 0.12, 0.03]
    task = tasks.AxisAlignment(TIP, n)
    return [task], lambda d: d.arrow(show, show + 0.1 * n, BLUE, 2.5)


SCENES: dict[str, Callable[..., Scene]] = {
    "FramePosition": position,
    "FrameOrientation": orientation,
    "FramePose": pose,
    "KnifePose": knife,
    "PointOnPoint": on_point,
    "PointOnLine": on_line,
    "PointOnPlane": on_plane,
    "PointOnCircle": on_circle,
    "PointOnCylinder": on_cylinder,
    "DistanceToPoint": from_point,
    "DistanceToLine": from_line,
    "DistanceToPlane": from_plane,
    "LineOnLine": line_on_line,
    "ParallelLines": parallel,
    "PerpendicularLines": perpendicular,
    "AngleBetweenLines": angle,
    "LineInPlane": in_plane,
    "ParallelPlanes": parallel_planes,
    "PlaneOnPlane": plane_on_plane,
    "rim_grasp": rim,
    "PointOnCurve": on_curve,
    "AxisAlongPath": along_path,
    "AxisAlignment": alignment,
}
