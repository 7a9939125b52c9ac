"""Configurations that satisfy constraints, nearest to a start posture."""

from wbc.pose.result import PoseResult, TaskMiss
from wbc.pose.solve import solve_pose

__all__ = ["PoseResult", "TaskMiss", "solve_pose"]
