"""Multipliers of a swept working set, and what they say of its optimality.

A working set is optimal when every row outside it is within its bounds, and every
inequality in it pushes: of its own slack and its multipliers in the levels below, the
first that is not zero has the sign of its bound (lexicographic; Escande, Mansard and
Wieber 2014).
"""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array, IntArray
from wbc.compiled import inner
from wbc.lexicographic.vectors import add_scaled, dot
from wbc.lexicographic.work import Work

__all__ = ["SIGN", "fault", "multipliers", "norm_of", "outside"]

SIGN = 1e-9
"""A multiplier or slack below this, relative to those around it, has no sign."""
VANISHING = 1e-12
"""A force below this, relative to the level's rows and bounds, is round-off."""


@inner
def multipliers(w: Work, k: int) -> float:
    """Multipliers of the rows above level k for its force A_k^T s_k.

    k = p asks for the wish for least norm, -x, below all levels.

    Returns:
        the norm of the force; 0 where it is but round-off, and no multipliers then.
    """
    start, first, count, order = w.start, w.first, w.count, w.order
    W, slack, pull, multiplier = w.W, w.slack, w.pull, w.multiplier
    p = count.size
    taken = first[min(k, p)]
    for j in range(taken):
        pull[j] = -w.c[j] if k == p else 0.0
    noise = 0.0
    if k < p:
        rows = order[start[k] : start[k] + count[k]]
        for r in rows:
            if slack[r] != 0.0:
                add_scaled(slack[r], W[r], pull, 0, taken)
        sizes = norm_of(w.size, rows)
        noise = VANISHING * sizes * (norm_of(slack, rows) + norm_of(w.bound, rows))
    force = float(np.sqrt(dot(pull, pull, 0, taken)))
    if force <= noise:
        return 0.0
    for j in range(k - 1, -1, -1):
        rows = order[start[j] : start[j] + count[j]]
        _peel(W, multiplier, pull, rows, first[j], first[j + 1] - first[j])
    return force


@inner
def _peel(
    W: Array, multiplier: Array, pull: Array, rows: IntArray, first: int, rank: int
) -> None:
    """Multipliers of a level's pivots; takes their force out of the pull."""
    for r in rows:
        multiplier[r] = 0.0
    for i in range(rank - 1, -1, -1):
        left = pull[first + i]
        for r in rows[i + 1 : rank]:
            left -= W[r, first + i] * multiplier[r]
        multiplier[rows[i]] = left / W[rows[i], first + i]
    for r in rows[:rank]:
        add_scaled(-multiplier[r], W[r], pull, 0, first)


@inner
def norm_of(values: Array, rows: IntArray) -> float:
    """Norm of some rows' values."""
    square = 0.0
    for r in rows:
        square += values[r] * values[r]
    return float(np.sqrt(square))


@inner
def outside(
    value: float, lower: float, upper: float, size: float, feasibility: float
) -> float:
    """Signed distance outside the bounds per norm of the row; 0 within tolerance."""
    above, below = value - upper, lower - value
    limit = feasibility * (size + abs(value))
    if above > limit:
        return above / (size + 1e-300)
    if below > limit:
        return -below / (size + 1e-300)
    return 0.0


@inner
def fault(
    A: Array, lower: Array, upper: Array, w: Work, feasibility: float
) -> tuple[int, int]:
    """The worst fault of the highest level that has one: (row, its right side).

    Returns:
        (-1, 0) for an optimal working set.
    """
    start, side, size, x = w.start, w.side, w.size, w.x
    held = False
    for k in range(w.count.size):
        worst, row = 0.0, -1
        for r in range(start[k], start[k + 1]):
            if side[r] == 0:
                value = dot(A[r], x, 0, x.size)
                out = outside(value, lower[r], upper[r], size[r], feasibility)
                if abs(out) > abs(worst):
                    worst, row = out, r
            elif side[r] != 2:
                held = True
        if row >= 0:
            return row, 1 if worst > 0.0 else -1
    return (_puller(w) if held else -1), 0


@inner
def _puller(w: Work) -> int:
    """The held bound that pulls most in the first level where one does; -1 if none."""
    start, count, order, side, fixed = w.start, w.count, w.order, w.side, w.fixed
    p = count.size
    for r in range(side.size):
        fixed[r] = side[r] == 0 or side[r] == 2
    for k in range(p + 1):
        row = -1
        if k < p:
            rows = order[start[k] : start[k] + count[k]]
            row = _against_slack(w.slack, w.bound, w.size, side, fixed, rows)
        if row < 0:
            force = multipliers(w, k)
            if force > 0.0:
                row = _against_multiplier(w, k, SIGN * force)
        if row >= 0:
            return row
    return -1


@inner
def _against_slack(
    slack: Array,
    bound: Array,
    size: Array,
    side: IntArray,
    fixed: IntArray,
    rows: IntArray,
) -> int:
    """A row held to a bound that it would leave inwards."""
    norm, worst, row = norm_of(slack, rows), 0.0, -1
    for r in rows:
        if fixed[r] or abs(slack[r]) <= SIGN * (size[r] + abs(bound[r]) + norm):
            continue
        fixed[r] = 1
        if slack[r] * side[r] > worst:
            worst, row = slack[r] * side[r], r
    return row


@inner
def _against_multiplier(w: Work, k: int, floor: float) -> int:
    """A row above level k whose multiplier has the wrong sign."""
    start, count, order, side = w.start, w.count, w.order, w.side
    fixed, multiplier, size = w.fixed, w.multiplier, w.size
    worst, row = 0.0, -1
    for j in range(k):
        for r in order[start[j] : start[j] + count[j]]:
            push = multiplier[r] * size[r] * side[r]
            if fixed[r] or abs(push) <= floor:
                continue
            fixed[r] = 1
            if -push > worst:
                worst, row = -push, r
    return row
