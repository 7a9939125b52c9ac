"""The catalogue of tasks.

Poses (`FramePose`, `FramePosition`, `FrameOrientation`), geometric constraints
(`tasks.geometry` lists them all), axes (`AxisAlignment`, `AxisAlongPath`), motion along
paths (`PointOnCurve`, `TravelSpeed`), contact (`HybridForceMotion`, `Impedance`,
`Admittance`, with a `ForceLaw`), joint space (`Posture`, `Damping`), singularities
(`SingularDamping`) and limits (`JointLimits`, `JointLocking`, `TorqueLimits`,
`TorqueRateLimits`). `KnifePose` guides a blade against what it cuts; `Clearance` keeps
two arms of one model apart.
"""

from tasks.along import PointOnCurve, TravelSpeed
from tasks.axis import AxisAlignment, AxisAlongPath
from tasks.clearance import Clearance
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
from tasks.knife import KnifePose
from tasks.limits import JointLimits, TorqueLimits, TorqueRateLimits
from tasks.locking import JointLocking
from tasks.path import Path, PathPoint
from tasks.posture import Damping, Posture
from tasks.singular import SingularDamping

__all__ = [
    "Admittance",
    "AngleBetweenLines",
    "AxisAlignment",
    "AxisAlongPath",
    "Circle",
    "Clearance",
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
    "KnifePose",
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
    "SingularDamping",
    "TorqueLimits",
    "TorqueRateLimits",
    "TravelSpeed",
    "rim_grasp",
]
