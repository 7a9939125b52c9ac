"""Dual active-set method, level by level: a working set from nothing.

A level's equalities are eliminated and their factor becomes the metric of what is
left: a coordinate that they determine costs what it adds to their squared residual, a
free one next to nothing (`THRIFT`). In this metric the inequalities are a small
strictly convex problem, which the method of Goldfarb and Idnani (1983) solves: the row
violated most is pulled to its bound, rows that would have to push the wrong way let
go. Degenerate bounds do it no harm, and a step costs a few dot products. Rows that
push are then fixed for good and the next level begins.

The metric makes this an approximation of a strict hierarchy, good enough to tell which
rows are active; the exact sweep that follows has the last word.
"""

from __future__ import annotations

import numpy as np

from wbc.compiled import inner
from wbc.lexicographic.moves import along, make_basis, move
from wbc.lexicographic.sweep import factorise, resolve, take_point, working_rows
from wbc.lexicographic.work import Dual, Work
from wbc.vectors import add_scaled, copy, dot, length

__all__ = ["climb"]

THRIFT = 1e-8
"""Price of a free coordinate, relative to the level's smallest row squared."""
CHEAPEST = 1e-13
"""But at least this, relative to the level's squared norm."""
FEASIBILITY = 1e-8
"""A row violated less than this, relative to its norm, is left to the exact sweeps."""
DEPENDENT = 1e-12
"""A row keeping less than this of its square in the metric depends on those held."""
BLOCKING = 1e-9
"""A held row gives way where it loses more than this, forces being compared."""
IGNORED = 3
"""In place of the side of a row that nothing moves."""
CLEAR = 1e2
"""A multiplier this much above the price of free coordinates belongs to the level."""
MET = 1e-6
"""A slack below this, relative to the row's norm, only pays for free coordinates."""


@inner
def climb(w: Work, d: Dual, most: int) -> int:
    """Find a working set from nothing.

    Returns:
        the steps it took; negative if `most` were not enough.
    """
    side, order, taken, steps = w.side, w.order, 0, 0
    tolerance = w.tolerance[0]
    for r in range(side.size):
        side[r] = side[r] if side[r] == 2 else 0
    for k in range(w.count.size):
        count, lost = working_rows(w, k), tolerance * w.scale[k]
        own = order[w.start[k] : w.start[k] + count]
        rank = resolve(w, own, taken, lost)
        take_point(w, d.point, taken + rank)
        price = _price(w, k)
        d.held[:] = 0
        d.known[:] = 0
        d.number[:] = 0
        based = False
        while True:
            row, sign = _most_violated(w, d, k)
            if row < 0:
                break
            if rank == own.size and d.number[0] == 0:
                factorise(w.W, w.slack, w.factor, own, taken, rank)
            if not based and taken + rank == w.x.size:
                make_basis(w, d, taken)
            based = True
            soft = price if row >= w.start[k] else 0.0
            d.multiplier[row] = 0.0
            while d.held[row] == 0:
                steps += 1
                if steps > most:
                    return -steps
                if not d.known[row]:
                    move(w, d, row, taken, rank, price)
                left = _direction(w, d, row, sign, soft)
                bound = w.upper[row] if sign > 0 else w.lower[row]
                _step(w, d, row, sign, soft, bound, left)
        pushing, broken = _fix(w, d, k, price)
        if pushing + broken > 0 and k + 1 < w.count.size:
            rows = d.pushing[:pushing]
            taken += resolve(w, rows, taken, 0.0)
            own = order[w.start[k] : w.start[k] + working_rows(w, k)]
            rank = resolve(w, own, taken, lost)
        taken += rank
    for r in d.chosen[: d.number[0]]:
        side[r] = d.held[r]
    return steps


@inner
def _price(w: Work, k: int) -> float:
    """What a unit of slack, squared, is worth in units of the free coordinates."""
    least = np.inf
    for size in w.size[w.start[k] : w.start[k + 1]]:
        if 0.0 < size < least:
            least = size
    if least == np.inf:
        return 0.0
    return float(max(THRIFT * least * least, CHEAPEST * w.scale[k] * w.scale[k]))


@inner
def _most_violated(w: Work, d: Dual, k: int) -> tuple[int, int]:
    """The row of levels up to k that is furthest out, and on which side."""
    side, size, held, point = w.side, w.size, d.held, d.point
    lower, upper = w.lower, w.upper
    worst, row, sign = FEASIBILITY * (1.0 + length(d.point)), -1, 0
    for r in range(w.start[k + 1]):
        if side[r] == 0 and held[r] == 0 and size[r] > 0.0:
            value = along(w, d, r, point)
            out = max(value - upper[r], lower[r] - value)
            if out > worst * size[r]:
                worst, row = out / size[r], r
                sign = 1 if value > upper[r] else -1
    return row, sign


@inner
def _direction(w: Work, d: Dual, row: int, sign: int, soft: float) -> float:
    """Where x goes and what those held lose when the row is pulled.

    Returns:
        how far the row comes per unit of pull; 0 where it depends on those held.
    """
    P, L, held, rate, way = d.P, d.L, d.held, d.rate, d.way
    n, count, chosen = w.x.size, d.number[0], d.chosen
    new = L[count]
    whole = left = along(w, d, row, P[row]) + soft
    for i in range(count):
        r = chosen[i]
        share = sign * held[r] * along(w, d, r, P[row])
        new[i] = (share - dot(L[i], new, 0, i)) * L[i, i]
        left -= new[i] * new[i]
    copy(new[:count], rate)
    for j in range(n):
        way[j] = sign * P[row, j]
    for i in range(count - 1, -1, -1):
        rate[i] *= L[i, i]
        add_scaled(-rate[i], L[i], rate, 0, i)
        add_scaled(-rate[i] * held[chosen[i]], P[chosen[i]], way, 0, n)
    return left if left > DEPENDENT * whole else 0.0


@inner
def _step(
    w: Work,
    d: Dual,
    row: int,
    sign: int,
    soft: float,
    bound: float,
    left: float,
) -> None:
    """Pull the row to its bound, or as far as those held can go; one of them leaves."""
    chosen, held, multiplier, rate, point = (
        d.chosen,
        d.held,
        d.multiplier,
        d.rate,
        d.point,
    )
    count, size, gone, step = d.number[0], w.size, -1, np.inf
    if left > 0.0:
        value = along(w, d, row, point)
        step = max(sign * (value - bound) - soft * multiplier[row], 0.0) / left
    for i in range(count):
        r = chosen[i]
        blocks = rate[i] * size[r] > BLOCKING * size[row]
        if blocks and multiplier[r] < step * rate[i]:
            step, gone = multiplier[r] / rate[i], i
    if step == np.inf:
        held[row] = IGNORED
        return
    add_scaled(-step, d.way, point, 0, point.size)
    for i in range(count):
        multiplier[chosen[i]] -= step * rate[i]
    multiplier[row] += step
    if gone < 0:
        d.L[count, count] = 1.0 / np.sqrt(left)
        chosen[count] = row
        held[row] = sign
        d.number[0] = count + 1
    else:
        _drop(d, gone)


@inner
def _drop(d: Dual, gone: int) -> None:
    """Take a row out of the set and of its factor."""
    L, chosen = d.L, d.chosen
    count = d.number[0] - 1
    d.held[chosen[gone]] = 0
    for i in range(gone, count):
        chosen[i] = chosen[i + 1]
        copy(L[i + 1, : i + 2], L[i])
        L[i, i + 1] = 1.0 / L[i, i + 1]
    for j in range(gone, count):
        end = np.sqrt(L[j, j] * L[j, j] + L[j, j + 1] * L[j, j + 1])
        cos, sin = L[j, j] / end, L[j, j + 1] / end
        L[j, j] = 1.0 / end
        for i in range(j + 1, count):
            a, b = L[i, j], L[i, j + 1]
            L[i, j], L[i, j + 1] = cos * a + sin * b, cos * b - sin * a
    d.number[0] = count


@inner
def _fix(w: Work, d: Dual, k: int, price: float) -> tuple[int, int]:
    """Fix rows above that push and own rows that stay violated: how many of each."""
    pushing, broken, reach = 0, 0, 1.0 + length(d.point)
    for r in d.chosen[: d.number[0]]:
        slack = price * d.multiplier[r]
        if r >= w.start[k]:
            if slack > MET * w.size[r] * reach:
                w.side[r] = d.held[r]
                broken += 1
        elif slack * w.size[r] > CLEAR * price * reach:
            w.side[r] = d.held[r]
            d.pushing[pushing] = r
            pushing += 1
    return pushing, broken
