"""The surface between the muscles from scattered points, and guide lines on it."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import RBFInterpolator

from sims.cutting.polynomial import Polynomial
from wbc import InputError
from wbc.arrays import Array, positive

__all__ = ["GuideSurface"]

FEWEST = 6
"""Points that a surface needs."""
THINNEST = 2e-3
"""Least standard deviation of the points across their longest extent in x, z [m]."""
SAMPLES = 41
SMOOTHING = 2500.0
"""Per square metre of noise: a surface that bends by 3 mm over 0.1 m is expected."""


@final
class GuideSurface:
    """y(x, z) through points of the interface, P0 section II-D.

    A thin-plate spline: it needs no grid, goes on linearly beyond the points, where
    the last passages need it, and smooths noisy ones.

    Args:
        points: (k, 3) of the interface [m].
        noise: their standard deviation [m]; the surface passes through exact ones.

    Raises:
        InputError: too few points, all on one line, or values that are not finite.
    """

    def __init__(self, points: ArrayLike, noise: float = 0.0) -> None:
        seen = np.asarray(points, dtype=np.float64)
        if seen.ndim != 2 or seen.shape[1] != 3 or not np.isfinite(seen).all():
            raise InputError(f"points {seen.shape} must be (k, 3) and finite.")
        if len(seen) < FEWEST:
            raise InputError(
                f"a guide line needs at least {FEWEST} points of the interface, "
                f"{len(seen)} are seen."
            )
        plane = seen[:, [0, 2]]
        if np.linalg.svd(plane - plane.mean(axis=0), compute_uv=False)[1] < (
            THINNEST * np.sqrt(len(seen))
        ):
            raise InputError("the points seen of the interface lie on one line.")
        smoothing = SMOOTHING * positive(noise, "noise", zero=True) ** 2
        self._low, self._high = float(plane[:, 0].min()), float(plane[:, 0].max())
        try:
            self._y = RBFInterpolator(plane, seen[:, 1], smoothing=smoothing)
        except np.linalg.LinAlgError as error:
            raise InputError("two points of the interface coincide.") from error

    @property
    def extent(self) -> tuple[float, float]:
        """Least and greatest x of the points [m]."""
        return self._low, self._high

    def line(self, x: ArrayLike, z: float) -> Array:
        """The guide line at depth z: y (k,) at x (k,) [m]."""
        at = np.atleast_1d(np.asarray(x, dtype=np.float64))
        return self._y(np.column_stack([at, np.full(at.size, z)]))  # type: ignore[no-any-return]

    def fit(
        self, z: float, low: float, high: float, order: int = 2, samples: int = SAMPLES
    ) -> Polynomial:
        """The guide line at depth z between two x [m], as a polynomial."""
        x = np.linspace(low, high, samples)
        return Polynomial.fit(x, self.line(x, z), order)
