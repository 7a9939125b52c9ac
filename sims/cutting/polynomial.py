"""A guide line as a polynomial y(x): fit, derivatives, arc length."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple, final

import numpy as np
from numpy.typing import ArrayLike

from wbc import InputError
from wbc.arrays import Array, frozen

__all__ = ["Bend", "Polynomial"]

STRAIGHT = 1e-4
"""Curvature [1/m] below which the closed form of the length loses digits."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)


class Bend(NamedTuple):
    """A curve at one x: y [m] and its first three derivatives by x."""

    y: float
    y1: float
    y2: float
    y3: float


@final
@dataclass(frozen=True, slots=True, eq=False)
class Polynomial:
    """y = sum_k c_k (x - centre)^k, P0 eq. (7) for any order.

    Attributes:
        coefficients: (order + 1,) c_k, lowest power first [m^(1 - k)].
        centre: [m].
    """

    coefficients: Array
    centre: float = 0.0
    _powers: tuple[float, ...] = field(init=False, repr=False)
    _parabola: bool = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Keep a read-only copy that is long enough for three derivatives."""
        given = np.atleast_1d(np.asarray(self.coefficients, dtype=np.float64))
        padded = np.zeros(max(given.size, 4))
        padded[: given.size] = given
        checked = frozen(padded, padded.shape, "coefficients of a guide line")
        object.__setattr__(self, "coefficients", checked)
        object.__setattr__(self, "_powers", tuple(checked[::-1].tolist()))
        parabola = (checked[3:] == 0.0).all() and abs(checked[2]) > STRAIGHT
        object.__setattr__(self, "_parabola", bool(parabola))

    @classmethod
    def fit(cls, x: ArrayLike, y: ArrayLike, order: int = 2) -> Polynomial:
        """Least squares through points.

        Args:
            x: (k,) [m].
            y: (k,) [m].
            order: highest power; 2 in the paper.

        Raises:
            InputError: fewer points than coefficients, or all at the same x.
        """
        xs, ys = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
        if order < 0 or xs.ndim != 1 or xs.shape != ys.shape:
            raise InputError(f"cannot fit order {order} to {xs.shape}, {ys.shape}.")
        if np.unique(xs).size <= order:
            raise InputError(
                f"a guide line of order {order} needs {order + 1} points at different "
                f"x, got {np.unique(xs).size}: lower the order or see more points."
            )
        middle, half = 0.5 * (xs.min() + xs.max()), max(0.5 * np.ptp(xs), 1e-9)
        powers = np.vander((xs - middle) / half, order + 1, increasing=True)
        scaled = np.linalg.lstsq(powers, ys, rcond=None)[0]
        return cls(scaled / half ** np.arange(order + 1), float(middle))

    def __call__(self, x: ArrayLike) -> Array:
        """Heights y (k,) at x (k,) [m]."""
        u = np.asarray(x, dtype=np.float64) - self.centre
        return np.polynomial.polynomial.polyval(u, self.coefficients)  # type: ignore[no-any-return]

    def at(self, x: float) -> Bend:
        """The curve and three derivatives at x, by Horner's rule."""
        u = x - self.centre
        y = y1 = y2 = y3 = 0.0
        for c in self._powers:
            y3 = y3 * u + y2
            y2 = y2 * u + y1
            y1 = y1 * u + y
            y = y * u + c
        return Bend(y, y1, 2.0 * y2, 6.0 * y3)

    def length(self, a: float, b: float) -> float:
        """Arc length D from a to b [m], negative where b < a.

        P0 eq. (8) as corrected: the integral of sqrt(1 + (dy/dx)^2); in closed form
        for a parabola, by 40 Gauss points otherwise.
        """
        if self._parabola:
            return self._antiderivative(b) - self._antiderivative(a)
        bend = self.coefficients
        half = 0.5 * (b - a)
        x = 0.5 * (a + b) + half * NODES - self.centre
        slopes = np.polynomial.polynomial.polyval(x, bend[1:] * np.arange(1, bend.size))
        return float(half * (WEIGHTS @ np.sqrt(1.0 + slopes**2)))

    def _antiderivative(self, x: float) -> float:
        """[u sqrt(1 + u^2) + asinh u] / (4 a2) with u = y'(x)."""
        a1, a2 = self._powers[-2], self._powers[-3]
        u = 2.0 * a2 * (x - self.centre) + a1
        return (u * math.sqrt(1.0 + u * u) + math.asinh(u)) / (4.0 * a2)
