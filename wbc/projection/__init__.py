"""Projection in the null space, with saturation, compiled.

With Z an orthonormal basis of what the blocks of rows above leave free, a block J y = b
gives

    y <- y + Z (J Z)^+ (b - J y),      Z <- Z null(J Z),

from singular vectors alone (`basis`, `recursion`); the rows of a hierarchical QP's
working set are factorised otherwise, so that either method can judge the other. Bounds
are held and released by what the result does to them (`active`).
"""

from wbc.projection.solver import Projection

__all__ = ["Projection"]
