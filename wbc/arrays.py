"""Array types, and the checks made once when an object is built."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wbc.errors import InputError

__all__ = [
    "Array",
    "BoolArray",
    "IntArray",
    "frozen",
    "per_row",
    "positive",
    "rotation",
    "unit",
]

Array: TypeAlias = NDArray[np.float64]
BoolArray: TypeAlias = NDArray[np.bool_]
IntArray: TypeAlias = NDArray[np.int_]

ROTATION_TOLERANCE = 1e-6
"""Read by code that is compiled (`wbc.compiled`), too."""


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
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"{what} is not an array of numbers: {value!r}") from error
    if array.shape != shape:
        raise InputError(f"{what} has shape {array.shape}; it must be {shape}.")
    if np.isnan(array).any() or (finite and np.isinf(array).any()):
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
    if error > ROTATION_TOLERANCE or np.linalg.det(R) < 0:
        raise InputError(
            f"{what} is not a rotation matrix: |R R^T - I| is {error:.1e}."
        )
    return R


def positive(value: Any, what: str, *, zero: bool = False) -> float:
    """A finite number greater than zero, or at least zero where `zero`.

    Raises:
        InputError: not a number, not finite, or of the wrong sign.
    """
    try:
        number = float(value)
    except (TypeError, ValueError) as error:
        raise InputError(f"{what} must be a number, got {value!r}.") from error
    if not np.isfinite(number) or number < 0 or (number == 0 and not zero):
        bound = "at least 0" if zero else "greater than 0"
        raise InputError(f"{what} must be finite and {bound}, got {number}.")
    return number


def per_row(value: ArrayLike, what: str) -> Array:
    """A gain for all rows (shape ()) or one for each row (m,), never negative.

    Raises:
        InputError: not numeric, more than one axis, not finite, or negative.
    """
    try:
        gains = np.array(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"{what} must be a number or one number a row.") from error
    if gains.ndim > 1:
        raise InputError(f"{what} must be a number or one number a row.")
    if not np.isfinite(gains).all() or (gains < 0).any():
        raise InputError(f"{what} must be finite and at least 0, got {gains}.")
    gains.flags.writeable = False
    return gains
