"""Lexicographic least squares with inequalities at every level, compiled.

The working set of the last call is tried first: it defines a hierarchy of equalities,
which one rank-revealing orthogonal sweep through the levels solves (`sweep`); the
multipliers of the sweep tell whether it is optimal (`multipliers`). Nearly every tick
ends there. Otherwise a row is changed and the sweep goes on from its level, and where
that does not settle soon, a primal active-set method that descends level by level
finds the set from scratch (`descent`).
"""

from wbc.lexicographic.solver import Lexicographic

__all__ = ["Lexicographic"]
