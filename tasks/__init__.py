"""The catalogue of tasks.

Poses (`FramePose`, `FramePosition`, `FrameOrientation`), geometric constraints
(`tasks.geometry` lists them all), axes (`AxisAlignment`, `AxisAlongPath`), motion along
paths (`PointOnCurve`, `TravelSpeed`), joint space (`Posture`, `Damping`) and limits
(`JointLimits`, `TorqueLimits`).
"""

from tasks.along import PointOnCurve, TravelSpeed
from tasks.axis import AxisAlignment, AxisAlongPath
from tasks.curve import Curve
from tasks.frame import FrameOrientation, FramePose, FramePosition
from tasks.geometry import (
    AngleBetweenLines,
    Circle,
    Cylinder,
    DistanceToLine,
    DistanceToPlane,
    DistanceToPoint,
    FrameMotion,
    Line,
    LineInPlane,
    LineOnLine,
    MovingFrame,
    ParallelLines,
    ParallelPlanes,
    PerpendicularLines,
    Plane,
    PlaneOnPlane,
    Point,
    PointOnCircle,
    PointOnCylinder,
    PointOnLine,
    PointOnPlane,
    PointOnPoint,
    rim_grasp,
)
from tasks.limits import JointLimits, TorqueLimits
from tasks.path import Path, PathPoint
from tasks.posture import Damping, Posture

__all__ = [
    "AngleBetweenLines",
    "AxisAlignment",
    "AxisAlongPath",
    "Circle",
    "Curve",
    "Cylinder",
    "Damping",
    "DistanceToLine",
    "DistanceToPlane",
    "DistanceToPoint",
    "FrameMotion",
    "FrameOrientation",
    "FramePose",
    "FramePosition",
    "JointLimits",
    "Line",
    "LineInPlane",
    "LineOnLine",
    "MovingFrame",
    "ParallelLines",
    "ParallelPlanes",
    "Path",
    "PathPoint",
    "PerpendicularLines",
    "Plane",
    "PlaneOnPlane",
    "Point",
    "PointOnCircle",
    "PointOnCurve",
    "PointOnCylinder",
    "PointOnLine",
    "PointOnPlane",
    "PointOnPoint",
    "Posture",
    "TorqueLimits",
    "TravelSpeed",
    "rim_grasp",
]
