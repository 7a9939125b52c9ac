"""Lexicographic least squares with inequalities at every level, compiled.

The working set of the last call is tried first: it defines a hierarchy of equalities,
which one rank-revealing orthogonal sweep through the levels solves (`sweep`); the
multipliers of the sweep tell whether it is optimal (`multipliers`). Nearly every tick
ends there. Otherwise a row is changed and the sweep goes on from its level. Where that
does not settle soon, a dual active-set method finds a set from nothing (`dual`), and
should it fail, a primal one that descends level by level (`descent`). All arrays lie
behind one address (`work`); the inner loops are `vectors`.
"""

from wbc.lexicographic.solver import Lexicographic

__all__ = ["Lexicographic"]
