"""A smooth curve through points in space, parametrised by arc length."""

from __future__ import annotations

from math import factorial
from typing import final

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import BSpline, make_interp_spline

from tasks.path import Path
from wbc.arrays import Array, frozen, numbers
from wbc.errors import InputError

__all__ = ["Curve"]

DEGREE = 5
DENSE = 4000
"""Samples at which arc length is measured."""
KNOTS = 240
"""Samples that the curve is finally interpolated through."""


@final
class Curve(Path):
    """Quintic spline through points, re-parametrised by arc length.

    Its first normal follows `normals` (such as the surface normals of a work-piece)
    as far as the tangent allows; without them it turns as little as possible along
    the curve (rotation-minimising frame by double reflection, Wang et al. 2008).

    Args:
        points: (k, 3), k >= 6 [m].
        normals: (k, 3) or (3,), or None.

    Raises:
        InputError: too few points, neighbours that coincide, a normal along the
            curve, or values that are not finite.
    """

    def __init__(self, points: ArrayLike, normals: ArrayLike | None = None) -> None:
        through = _points(points)
        chord = np.linalg.norm(np.diff(through, axis=0), axis=1)
        if (chord < 1e-9).any():
            raise InputError("neighbouring points of a curve must not coincide.")
        u = np.concatenate([[0.0], np.cumsum(chord)])
        spline = make_interp_spline(u, through, k=DEGREE)
        s, at = _arc_length(spline, u[-1])
        self.length = float(s[-1])
        knots = np.linspace(0.0, self.length, KNOTS)
        u_of_s = _refine(spline, s, at, knots, np.interp(knots, s, at))
        c = spline(u_of_s)
        tangent = spline(u_of_s, 1)
        tangent /= np.linalg.norm(tangent, axis=1)[:, None]
        n1 = _normals(c, tangent, _along(normals, u, u_of_s, len(through)))
        rows = np.hstack([c, n1, np.cross(tangent, n1)])
        breaks, pieces = _pieces(make_interp_spline(knots, rows, k=DEGREE))
        header = [1.0, self.length, breaks.size, KNOTS]
        table = np.concatenate([header, breaks, pieces.ravel(), c.ravel()])
        self.table = frozen(table, table.shape, "the curve")


def _points(points: ArrayLike) -> Array:
    array = numbers(points, "points of a curve")
    if array.ndim != 2 or array.shape[1] != 3 or array.shape[0] <= DEGREE:
        raise InputError(
            f"a curve needs at least {DEGREE + 1} points of shape (k, 3), got "
            f"{array.shape}."
        )
    return frozen(array, array.shape, "the curve's points")


def _pieces(spline: BSpline) -> tuple[Array, Array]:
    """Start (k,) and Taylor coefficients (k, 6, 9) of every polynomial piece."""
    breaks = np.unique(spline.t)[:-1]
    orders = range(DEGREE, -1, -1)
    taylor = [spline(breaks, order) / factorial(order) for order in orders]
    return breaks, np.stack(taylor, axis=1)


def _speed(spline: BSpline, u: Array) -> Array:
    return np.linalg.norm(spline(u, 1), axis=-1)  # type: ignore[no-any-return]


def _arc_length(spline: BSpline, end: float) -> tuple[Array, Array]:
    """Arc length s at dense parameters u, by Simpson's rule on every interval."""
    u = np.linspace(0.0, end, DENSE)
    middle = 0.5 * (u[1:] + u[:-1])
    at_nodes, at_middle = _speed(spline, u), _speed(spline, middle)
    pieces = (at_nodes[:-1] + 4.0 * at_middle + at_nodes[1:]) * np.diff(u) / 6.0
    return np.concatenate([[0.0], np.cumsum(pieces)]), u


def _refine(spline: BSpline, s: Array, u: Array, wanted: Array, guess: Array) -> Array:
    """Newton on s(u) = wanted, with Simpson's rule from the dense sample below."""
    for _ in range(3):
        below = np.clip(np.searchsorted(u, guess, side="right") - 1, 0, u.size - 2)
        left = u[below]
        ends = _speed(spline, left) + _speed(spline, guess)
        middle = _speed(spline, 0.5 * (left + guess))
        length = s[below] + (ends + 4.0 * middle) * (guess - left) / 6.0
        guess = np.clip(guess - (length - wanted) / _speed(spline, guess), 0.0, u[-1])
    return guess


def _along(normals: ArrayLike | None, u: Array, at: Array, count: int) -> Array | None:
    """The given normals interpolated at the knots, (KNOTS, 3)."""
    if normals is None:
        return None
    given = numbers(normals, "normals of a curve")
    if given.shape == (3,):
        given = np.tile(given, (count, 1))
    given = frozen(given, (count, 3), "the curve's normals")
    return make_interp_spline(u, given, k=DEGREE)(at)  # type: ignore[no-any-return]


def _normals(c: Array, tangent: Array, wanted: Array | None) -> Array:
    if wanted is None:
        return _rotation_minimising(c, tangent)
    across = wanted - tangent * np.einsum("ij,ij->i", wanted, tangent)[:, None]
    length = np.linalg.norm(across, axis=1)
    if (length < 1e-3).any():
        raise InputError("a normal of the curve points along it somewhere.")
    return across / length[:, None]  # type: ignore[no-any-return]


def _rotation_minimising(c: Array, tangent: Array) -> Array:
    first = np.eye(3)[int(np.argmin(np.abs(tangent[0])))]
    normal = first - tangent[0] * (tangent[0] @ first)
    normals = [normal / np.linalg.norm(normal)]
    for i in range(len(c) - 1):
        v1 = c[i + 1] - c[i]
        square = v1 @ v1
        reflected = normals[-1] - 2.0 / square * (v1 @ normals[-1]) * v1
        t = tangent[i] - 2.0 / square * (v1 @ tangent[i]) * v1
        v2 = tangent[i + 1] - t
        square = v2 @ v2
        if square > 1e-30:
            reflected = reflected - 2.0 / square * (v2 @ reflected) * v2
        normals.append(reflected)
    return np.array(normals)
