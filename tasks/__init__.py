"""The catalogue of tasks.

Poses (`FramePose`, `FramePosition`, `FrameOrientation`), geometry (`PointOnPoint`,
`PointOnLine`, `PointOnPlane`, `PointOnCurve`, `AxisAlignment`, `AxisAlongPath`),
motion along paths (`TravelSpeed`), contact (`HybridForceMotion`, `Impedance`,
`Admittance`, with a `ForceLaw`), joint space (`Posture`, `Damping`) and limits
(`JointLimits`, `JointLocking`, `TorqueLimits`). `KnifePose` guides a blade against
what it cuts; `Clearance` keeps two arms of one model apart.
"""

from tasks.along import PointOnCurve, TravelSpeed
from tasks.axis import AxisAlignment, AxisAlongPath
from tasks.clearance import Clearance
from tasks.curve import Curve
from tasks.force import HybridForceMotion
from tasks.forcelaw import ForceLaw
from tasks.frame import FrameOrientation, FramePose, FramePosition
from tasks.geometry import Line, Plane, PointOnLine, PointOnPlane, PointOnPoint
from tasks.impedance import Admittance, Impedance
from tasks.knife import KnifePose
from tasks.limits import JointLimits, TorqueLimits
from tasks.locking import JointLocking
from tasks.path import Path, PathPoint
from tasks.posture import Damping, Posture

__all__ = [
    "Admittance",
    "AxisAlignment",
    "AxisAlongPath",
    "Clearance",
    "Curve",
    "Damping",
    "ForceLaw",
    "FrameOrientation",
    "FramePose",
    "FramePosition",
    "HybridForceMotion",
    "Impedance",
    "JointLimits",
    "JointLocking",
    "KnifePose",
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
