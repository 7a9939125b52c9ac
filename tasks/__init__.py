"""The catalogue of tasks.

Poses (`FramePose`, `FramePosition`, `FrameOrientation`), geometry (`PointOnPoint`,
`PointOnLine`, `PointOnPlane`, `PointOnCurve`, `AxisAlignment`, `AxisAlongPath`),
motion along paths (`TravelSpeed`), joint space (`Posture`, `Damping`) and limits
(`JointLimits`, `TorqueLimits`).
"""

from tasks.along import PointOnCurve, TravelSpeed
from tasks.axis import AxisAlignment, AxisAlongPath
from tasks.curve import Curve
from tasks.frame import FrameOrientation, FramePose, FramePosition
from tasks.geometry import Line, Plane, PointOnLine, PointOnPlane, PointOnPoint
from tasks.limits import JointLimits, TorqueLimits
from tasks.path import Path, PathPoint
from tasks.posture import Damping, Posture

__all__ = [
    "AxisAlignment",
    "AxisAlongPath",
    "Curve",
    "Damping",
    "FrameOrientation",
    "FramePose",
    "FramePosition",
    "JointLimits",
    "Line",
    "Path",
    "PathPoint",
    "Plane",
    "PointOnCurve",
    "PointOnLine",
    "PointOnPlane",
    "PointOnPoint",
    "Posture",
    "TorqueLimits",
    "TravelSpeed",
]
