"""Geometric constraints: a feature on the robot, another one anywhere, and a relation.

Features are `Point`, `Line`, `Plane`, `Circle` and `Cylinder`, each carried by the
world, by a frame of the robot, or by a `MovingFrame`.

| constraint | rows and units | rank |
|---|---|---|
| `PointOnPoint` | 3 m | 3 |
| `PointOnLine` | 2 m | 2 |
| `PointOnPlane` | 1 m | 1 |
| `PointOnCircle` | 2 m | 2 |
| `PointOnCylinder` | 1 m | 1 |
| `DistanceToPoint`, `DistanceToLine`, `DistanceToPlane` | 1 m | 1 |
| `LineOnLine` | 2 m, 2 rad | 4 |
| `ParallelLines` | 2 rad | 2 |
| `PerpendicularLines`, `AngleBetweenLines` | 1 rad | 1 |
| `LineInPlane` | 1 m, 1 rad | 2 |
| `ParallelPlanes` | 2 rad | 2 |
| `PlaneOnPlane` | 1 m, 2 rad | 3 |
| `rim_grasp`, five of these | 3 m, 4 rad | 5 |
"""

from tasks.geometry.constraint import Constraint
from tasks.geometry.distances import DistanceToLine, DistanceToPlane, DistanceToPoint
from tasks.geometry.features import Circle, Cylinder, Line, Plane, Point
from tasks.geometry.lines import (
    AngleBetweenLines,
    LineInPlane,
    LineOnLine,
    ParallelLines,
    PerpendicularLines,
)
from tasks.geometry.moving import FrameMotion, MovingFrame
from tasks.geometry.planes import ParallelPlanes, PlaneOnPlane
from tasks.geometry.points import (
    PointOnCircle,
    PointOnCylinder,
    PointOnLine,
    PointOnPlane,
    PointOnPoint,
)
from tasks.geometry.rim import rim_grasp

__all__ = [
    "AngleBetweenLines",
    "Circle",
    "Constraint",
    "Cylinder",
    "DistanceToLine",
    "DistanceToPlane",
    "DistanceToPoint",
    "FrameMotion",
    "Line",
    "LineInPlane",
    "LineOnLine",
    "MovingFrame",
    "ParallelLines",
    "ParallelPlanes",
    "PerpendicularLines",
    "Plane",
    "PlaneOnPlane",
    "Point",
    "PointOnCircle",
    "PointOnCylinder",
    "PointOnLine",
    "PointOnPlane",
    "PointOnPoint",
    "rim_grasp",
]
