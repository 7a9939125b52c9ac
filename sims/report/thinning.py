"""Long records made short for drawing, without losing what the eye would see."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from wbc.arrays import Array

__all__ = ["columns", "thin_curve", "thin_series"]


def thin_series(values: Array, limit: int) -> NDArray[np.intp]:
    """Indices of at most about `limit` samples of (T,) that draw the same curve.

    Each stretch keeps its ends, its least and its greatest sample, and one NaN if it
    has any, so neither a peak nor a gap is lost.
    """
    count = len(values)
    if count <= limit:
        return np.arange(count)
    kept: list[int] = []
    for begin, end in _stretches(count, max(limit // 5, 1)):
        part = values[begin:end]
        missing = np.isnan(part)
        low = np.where(missing, np.inf, part).argmin()
        high = np.where(missing, -np.inf, part).argmax()
        gap = missing.argmax()
        kept += [begin, begin + int(low), begin + int(high), begin + int(gap), end - 1]
    return np.unique(kept)


def thin_curve(points: Array, limit: int) -> NDArray[np.intp]:
    """Indices of at most about `limit` points (N, D) that draw the same curve.

    Each stretch keeps its first point and the one farthest from its chord.
    """
    count = len(points)
    if count <= limit:
        return np.arange(count)
    kept = [count - 1]
    for begin, end in _stretches(count, max(limit // 2, 1)):
        part = points[begin:end] - points[begin]
        chord = part[-1] / max(float(np.linalg.norm(part[-1])), 1e-300)
        away = np.linalg.norm(part - np.outer(part @ chord, chord), axis=1)
        kept += [begin, begin + int(np.nan_to_num(away).argmax())]
    return np.unique(kept)


def columns(times: Array, table: Array, limit: int) -> Array:
    """`table` (R, T) over `times` (T,) as at most `limit` columns of equal duration.

    A column holds the sample of greatest magnitude of its interval, with its sign;
    an interval without a sample repeats the one before it.
    """
    count = min(limit, len(times))
    edges = np.linspace(times[0], times[-1], count + 1)
    firsts = np.searchsorted(times, edges[:-1], side="left")
    lasts = np.append(firsts[1:], len(times))
    result = np.empty((len(table), count))
    for index, (begin, end) in enumerate(zip(firsts, lasts, strict=True)):
        part = table[:, begin:end] if end > begin else table[:, begin - 1 : begin]
        peak = np.nan_to_num(np.abs(part), nan=-1.0).argmax(axis=1)
        result[:, index] = part[np.arange(len(table)), peak]
    return result


def _stretches(count: int, pieces: int) -> list[tuple[int, int]]:
    edges = np.unique(np.linspace(0, count, pieces + 1).astype(int))
    return [(int(begin), int(end)) for begin, end in pairwise(edges)]
