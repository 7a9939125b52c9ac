"""Grasping a cylinder at its rim: the four constraints of P4, section IV-A."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tasks.geometry.distances import DistanceToLine, DistanceToPlane
from tasks.geometry.features import Cylinder, Line, Plane
from tasks.geometry.lines import LineInPlane, ParallelLines, PerpendicularLines
from wbc import Level
from wbc.arrays import number, positive, unit
from wbc.checks import expect, text
from wbc.errors import InputError

__all__ = ["rim_grasp"]

ORIGIN = np.zeros(3)


def rim_grasp(
    frame: str,
    cylinder: Cylinder,
    *,
    approach: ArrayLike = (0.0, 0.0, 1.0),
    closing: ArrayLike = (0.0, 1.0, 0.0),
    radius: float | None = None,
    depth: float = 0.0,
    stiffness: ArrayLike = 100.0,
    damping: ArrayLike | None = None,
    name: str = "rim",
) -> Level:
    """The tasks of a grasp at the rim of a cylinder: 7 rows, rank 5.

    What stays free is the place along the rim; the fingers may also stand on either
    side, and which side is the nearer decides. The rows are, with B the gripper and A
    the cylinder: A's axis in the plane of B's two axes (2 rows), B's origin at the
    radius from A's axis (1) and on the top plane (1), the approach against A's
    direction (2), and the closing direction across A's axis (1). All four rows of
    angles turn across A's axis, in which there are two directions: two rows are
    redundant at every pose, exactly, so that no solver takes them for a sixth.

    Args:
        frame: name of the gripper's frame, origin between the finger tips.
        cylinder: what is grasped; its direction points out of the face approached.
        approach: (3,) in the gripper's axes, towards the object.
        closing: (3,) in the gripper's axes, from finger to finger; across `approach`.
        radius: where the origin goes [m]; the cylinder's by default, the middle of the
            wall for a hollow one.
        depth: of the origin below the top plane [m], negative above it.
        stiffness: [1/s^2].
        damping: [1/s], critical by default.
        name: what the names of the tasks begin with.

    Raises:
        InputError: axes that are not at a right angle, an unusable number or gain.
    """
    expect(Cylinder, cylinder=cylinder)
    text(name, "name")
    b1, b2 = unit(approach, "approach"), unit(closing, "closing")
    if abs(b1 @ b2) > 1e-6:
        raise InputError("approach and closing of a gripper must be at a right angle.")
    r = cylinder.radius if radius is None else positive(radius, "radius of the grasp")
    axis, n = cylinder.axis, cylinder.direction
    first, second = Line(ORIGIN, b1, on=frame), Line(ORIGIN, b2, on=frame)
    plane = Plane(ORIGIN, np.cross(b1, b2), on=frame)
    top = Plane(cylinder.top, n, on=cylinder.on)
    return Level.of(
        LineInPlane(
            axis, plane, stiffness=stiffness, damping=damping, name=f"{name} radial"
        )
    ) + (
        DistanceToLine(
            frame, axis, r, stiffness=stiffness, damping=damping, name=f"{name} radius"
        )
        + DistanceToPlane(
            frame,
            top,
            -number(depth, "depth"),
            stiffness=stiffness,
            damping=damping,
            name=f"{name} top",
        )
        + ParallelLines(
            axis,  # its rows turn across A's axis, as the other angles do: see above
            first,
            sense="opposite",
            stiffness=stiffness,
            damping=damping,
            name=f"{name} approach",
        )
        + PerpendicularLines(
            second, axis, stiffness=stiffness, damping=damping, name=f"{name} closing"
        )
    )
