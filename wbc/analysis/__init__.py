"""Rank analysis of a hierarchy at a state: what is redundant, what conflicts."""

from wbc.analysis.analyse import analyse
from wbc.analysis.data import Analysis, Dependency, LevelAnalysis, Metric

__all__ = ["Analysis", "Dependency", "LevelAnalysis", "Metric", "analyse"]
