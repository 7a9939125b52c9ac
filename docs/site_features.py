"""How the features of the pictures are drawn."""

from __future__ import annotations

import numpy as np
from site_drawing import BLUE, GREEN, ORANGE, Drawing

import tasks


def draw_line(
    d: Drawing, line: tasks.Line, half: float = 0.2, colour: str = BLUE
) -> None:
    """A line, both ways from its point."""
    d.line([line.point - half * line.direction, line.point + half * line.direction],
           colour, 2.5)  # fmt: skip


def draw_plane(d: Drawing, plane: tasks.Plane, half: float = 0.13) -> None:
    """A part of a plane, with its normal."""
    a, b = tasks.Line(plane.point, plane.normal).normals
    corners = [plane.point + half * (i * a + j * b) for i, j in
               ((-1, -1), (1, -1), (1, 1), (-1, 1))]  # fmt: skip
    d.line(corners, BLUE, 1.5, fill=BLUE)
    d.arrow(plane.point, plane.point + 0.06 * plane.normal, BLUE, 1.5)


def draw_cylinder(d: Drawing, can: tasks.Cylinder, length: float = 0.14) -> None:
    """A cylinder with its axis."""
    d.ring(can.top, can.direction, can.radius, width=2.0, fill=BLUE)
    d.ring(can.top - length * can.direction, can.direction, can.radius, width=1.0)
    for side in tasks.Line(can.top, can.direction).normals:
        for s in (-1.0, 1.0):
            a = can.top + s * can.radius * side
            d.line([a, a - length * can.direction], BLUE, 1.0)
    axis = [can.top, can.top - length * can.direction]
    d.line(axis, BLUE, 1.0, "6 3 1 3")


def draw_triad(d: Drawing, p, R) -> None:
    """Three axes: x, y, z."""
    for axis, colour in zip(R.T, (ORANGE, GREEN, BLUE), strict=True):
        d.arrow(p, p + 0.06 * axis, colour, 1.5)


def draw_path(d: Drawing, path: tasks.Path) -> None:
    """A path, with an arrow at its end."""
    s = np.linspace(0.0, path.length, 60)
    points = [path.at(x).c[0] for x in s]
    d.line(points[:-1], BLUE, 2.5)
    d.arrow(points[-4], points[-1], BLUE, 2.5)
