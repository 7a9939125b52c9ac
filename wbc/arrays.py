"""Array types, and the checks made once when an object is built."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wbc.errors import InputError, shown

__all__ = [
    "FLOAT",
    "Array",
    "BoolArray",
    "IntArray",
    "frozen",
    "number",
    "numbers",
    "per_row",
    "positive",
    "rotation",
    "unit",
]

Array: TypeAlias = NDArray[np.float64]
BoolArray: TypeAlias = NDArray[np.bool_]
IntArray: TypeAlias = NDArray[np.int_]

REAL = frozenset("biufO")
"""Kinds of numpy's types: true and false, integers, floating-point numbers, objects."""
FLOAT = np.dtype(np.float64)
ROTATION_TOLERANCE = 1e-6
"""Read by code that is compiled (`wbc.compiled`), too."""


def numbers(value: Any, what: str) -> Array:
    """A copy of `value` as an array of numbers, of any shape, NaN included.

    Raises:
        InputError: not numeric, complex, ragged, or too large for a floating-point
            number.
    """
    try:
        return np.array(_real(value), dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(
            f"{what} is not an array of numbers: {shown(value)}."
        ) from error


def _real(value: Any) -> NDArray[Any]:
    """`value` as an array of whatever can stand for real numbers.

    Raises:
        TypeError: numpy would read numbers from it that nobody wrote, such as "3" as
            3, 1j as 0, or a date as the seconds since 1970.
    """
    array = np.asarray(value)
    kinds = {array.dtype.kind}
    if array.dtype.kind == "O":
        kinds = {np.asarray(x).dtype.kind for x in array.flat}
    if not kinds <= REAL:
        raise TypeError
    return array


def frozen(
    value: ArrayLike,
    shape: tuple[int, ...],
    what: str,
    *,
    finite: bool = True,
) -> Array:
    """A read-only copy of `value`, of exactly this shape.

    Raises:
        InputError: wrong shape, not numeric, NaN, or infinite where `finite`.
    """
    array = numbers(value, what)
    if array.shape != shape:
        raise InputError(f"{what} has shape {array.shape}; it must be {shape}.")
    if not (np.isfinite(array) if finite else ~np.isnan(array)).all():
        kind = "finite" if finite else "free of NaN"
        raise InputError(f"{what} must be {kind}, got {array}.")
    array.flags.writeable = False
    return array


def unit(value: ArrayLike, what: str) -> Array:
    """A read-only unit vector (3,) along `value`.

    Raises:
        InputError: wrong shape, not finite, or of zero length.
    """
    vector = frozen(value, (3,), what)
    length = float(np.linalg.norm(vector))
    if length < 1e-12:
        raise InputError(f"{what} has zero length: it names no direction.")
    return frozen(vector / length, (3,), what)


def rotation(value: ArrayLike, what: str) -> Array:
    """A read-only rotation matrix (3, 3).

    Raises:
        InputError: wrong shape, not finite, or not a proper rotation.
    """
    R = frozen(value, (3, 3), what)
    error = float(np.abs(R @ R.T - np.eye(3)).max())
    if error > ROTATION_TOLERANCE:
        raise InputError(
            f"{what} is not a rotation matrix: |R R^T - I| is {error:.1e}."
        )
    if np.linalg.det(R) < 0:
        raise InputError(
            f"{what} is not a rotation matrix but a reflection: its determinant is -1. "
            "Turn one of its axes round."
        )
    return R


def positive(value: Any, what: str, *, zero: bool = False) -> float:
    """A finite number greater than zero, or at least zero where `zero`.

    Raises:
        InputError: not a number, not finite, or of the wrong sign.
    """
    x = _scalar(value, what)
    if not np.isfinite(x) or x < 0 or (x == 0 and not zero):
        bound = "at least 0" if zero else "greater than 0"
        raise InputError(f"{what} must be finite and {bound}, got {x}.")
    return x


def number(value: Any, what: str) -> float:
    """A finite number of any sign.

    Raises:
        InputError: not a number, or not finite.
    """
    x = _scalar(value, what)
    if not np.isfinite(x):
        raise InputError(f"{what} must be finite, got {x}.")
    return x


def _scalar(value: Any, what: str) -> float:
    try:
        if _real(value).ndim != 0:
            raise TypeError  # float would take what has one element
        return float(value)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"{what} must be a number, got {shown(value)}.") from error


def per_row(value: ArrayLike, what: str) -> Array:
    """A gain for all rows (shape ()) or one for each row (m,), never negative.

    Raises:
        InputError: not numeric, empty, more than one axis, not finite, or negative.
    """
    gains = numbers(value, what)
    if gains.ndim > 1 or not gains.size:
        raise InputError(
            f"{what} must be a number or one number a row, got {shown(value)}."
        )
    if not np.isfinite(gains).all() or (gains < 0).any():
        raise InputError(f"{what} must be finite and at least 0, got {gains}.")
    gains.flags.writeable = False
    return gains
