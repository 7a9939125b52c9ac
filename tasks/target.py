"""Moving targets of frames: set at every tick, so checked by one compiled call."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike

from tasks.kernels.target import take
from wbc.arrays import FLOAT, Array, frozen, rotation
from wbc.errors import InputError, shown

__all__ = ["ORIGIN", "POINT", "POSE", "STILL", "UPRIGHT", "take_target"]

ORIGIN, UPRIGHT, STILL = np.zeros(3), np.eye(3), np.zeros(6)
"""In place of what a target has not."""
POINT = ("target", "target", "target velocity", "target acceleration")
POSE = ("target position", "target orientation", "target twist", "target acceleration")
"""What a point or a rotation, a pose, and their motion are called in messages."""
for _constant in (ORIGIN, UPRIGHT, STILL):
    _constant.flags.writeable = False


def take_target(
    owner: str, what: Sequence[str], given: Sequence[ArrayLike], out: Array
) -> None:
    """Write a target as kernels read it, or leave the old one as it is.

    Args:
        owner: name of the task.
        what: names of the four things given, for messages.
        given: position (3,), orientation (3, 3), velocity and acceleration, these (3,)
            for a position or an orientation, (6,) for both.
        out: (9,) position and its motion, (15,) orientation and its motion, or (24,)
            one after the other.

    Raises:
        InputError: something is of the wrong shape, not finite, or no rotation.
    """
    moving = (6,) if out.size == 24 else (3,)
    shapes = ((3,), (3, 3), moving, moving)
    try:
        p, R, V, A = [
            value.astype(FLOAT, "C", "same_kind", False)  # no complex numbers, no dates
            if type(value) is np.ndarray
            else np.array(value, FLOAT, order="C")
            for value in given
        ]
        fits = (p.shape, R.shape, V.shape, A.shape) == shapes
    except (TypeError, ValueError, OverflowError):
        fits = False
    if not fits or not take(p, R, V, A, out):
        _complain(owner, what, given, shapes)


def _complain(
    owner: str,
    what: Sequence[str],
    given: Sequence[ArrayLike],
    shapes: Sequence[tuple[int, ...]],
) -> NoReturn:
    """Say what is wrong with a target."""
    for name, value, shape in zip(what, given, shapes, strict=True):
        label = f"{name} of '{owner}'"
        if shape == (3, 3):
            rotation(value, label)
        else:
            frozen(value, shape, label)
    raise InputError(f"target of '{owner}' cannot be used: {shown(given)}.")
