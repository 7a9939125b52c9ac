"""Chatter of a torque: how far it travels, and how often it turns, in a short time."""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array

__all__ = ["reversals", "travel"]


def travel(x: Array, window: int) -> float:
    """Largest total variation of a series (T,) within any `window` samples."""
    way = np.append(0.0, np.cumsum(np.abs(np.diff(x))))
    window = min(window, x.size - 1)
    return float((way[window:] - way[: way.size - window]).max())


def reversals(x: Array, swing: float, window: int) -> int:
    """Most turning points of a series (T,) within any `window` samples.

    A turning point counts once the series has come back from it by `swing`, so noise
    and round-off below that do not. Two are one swing to and fro; a torque that
    chatters has one every few samples.
    """
    turns, extreme, rising = [], x[0], 0
    for k, value in enumerate(x):
        if rising >= 0 and extreme - value > swing:
            turns += [k] if rising else []
            rising, extreme = -1, value
        elif rising <= 0 and value - extreme > swing:
            turns += [k] if rising else []
            rising, extreme = 1, value
        elif (value - extreme) * rising > 0:
            extreme = value
    at = np.array(turns, dtype=int)
    found = np.searchsorted(at, at + window) - np.arange(at.size)
    return int(found.max(initial=0))
