"""The catalogue of tasks.

Poses (`FramePose`, `FramePosition`, `FrameOrientation`), geometric constraints
(`tasks.geometry` lists them all), axes (`AxisAlignment`, `AxisAlongPath`), motion along
paths (`PointOnCurve`, `TravelSpeed`), contact (`HybridForceMotion`, `Impedance`,
`Admittance`, with a `ForceLaw`), joint space (`Posture`, `Damping`) and limits
(`JointLimits`, `JointLocking`, `TorqueLimits`, `TorqueRateLimits`).
"""

from tasks.along import PointOnCurve, TravelSpeed
from tasks.axis import AxisAlignment, AxisAlongPath
from tasks.curve import Curve
from tasks.force import HybridForceMotion
from tasks.forcelaw import ForceLaw
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
from tasks.impedance import Admittance, Impedance
from tasks.limits import JointLimits, TorqueLimits, TorqueRateLimits
from tasks.locking import JointLocking
from tasks.path import Path, PathPoint
from tasks.posture import Damping, Posture

__all__ = [
    "Admittance",
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
    "ForceLaw",
    "FrameMotion",
    "FrameOrientation",
    "FramePose",
    "FramePosition",
    "HybridForceMotion",
    "Impedance",
    "JointLimits",
    "JointLocking",
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
    "TorqueRateLimits",
    "TravelSpeed",
    "rim_grasp",
]
