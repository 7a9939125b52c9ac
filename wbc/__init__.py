"""Whole-body control: composable tasks, strict priorities, two schools of resolution.

A `Robot` gives a `State`; `Task`s say what is wanted; a `Hierarchy` orders them; a
resolver (`NullSpace` projection, strict `HierarchicalQP`, or `WeightedQP`) turns them
into a `Solution`; a `Controller` does so once a tick.
"""

from wbc.analysis import Analysis, Dependency, LevelAnalysis
from wbc.certificate import Certificate
from wbc.controller import Controller, resolve
from wbc.damped import DampedInverse
from wbc.errors import (
    InputError,
    ModelError,
    SolverError,
    StaleError,
    UnknownName,
    WbcError,
)
from wbc.explain import (
    ActiveBound,
    Blocker,
    Explanation,
    Fading,
    LevelCost,
    StrictnessCost,
    TaskExplanation,
)
from wbc.frames import FrameState
from wbc.hierarchy import Hierarchy, Level
from wbc.hqp import HierarchicalQP, HierarchyResult, solve_hierarchy
from wbc.kernel import Kernel
from wbc.law import PD, Damper, Law, SaturatedPD
from wbc.nullspace import NullSpace
from wbc.pose import PoseResult, TaskMiss, solve_pose
from wbc.qp import backends
from wbc.report import TaskReport
from wbc.resolver import Resolver, Status
from wbc.robot import Robot
from wbc.rows import Rows, allocate_rows
from wbc.solution import Solution
from wbc.state import State
from wbc.task import MotionTask, Task
from wbc.weighted import WeightedQP

__all__ = [
    "PD",
    "ActiveBound",
    "Analysis",
    "Blocker",
    "Certificate",
    "Controller",
    "DampedInverse",
    "Damper",
    "Dependency",
    "Explanation",
    "Fading",
    "FrameState",
    "HierarchicalQP",
    "Hierarchy",
    "HierarchyResult",
    "InputError",
    "Kernel",
    "Law",
    "Level",
    "LevelAnalysis",
    "LevelCost",
    "ModelError",
    "MotionTask",
    "NullSpace",
    "PoseResult",
    "Resolver",
    "Robot",
    "Rows",
    "SaturatedPD",
    "Solution",
    "SolverError",
    "StaleError",
    "State",
    "Status",
    "StrictnessCost",
    "Task",
    "TaskExplanation",
    "TaskMiss",
    "TaskReport",
    "UnknownName",
    "WbcError",
    "WeightedQP",
    "allocate_rows",
    "backends",
    "resolve",
    "solve_hierarchy",
    "solve_pose",
]
