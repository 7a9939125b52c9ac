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
from wbc.lexicographic.sweep import few_left
from wbc.lexicographic.work import Work
from wbc.vectors import add_scaled, dot, length, reflect

__all__ = ["FEASIBILITY", "ROUND_OFF", "fault", "multipliers", "slack_floor"]

FEASIBILITY = 1e-10
"""A bound counts as violated beyond this times its row's norm."""
SIGN = 1e-9
"""A multiplier or slack below this, relative to those around it, has no sign."""
NOISE = 1e-14
"""Round-off of a force, relative to the forces that add up to it."""
ROUND_OFF = 1e-12
"""Round-off of a row's value, relative to its norm and to |x|."""


@inner
def fault(w: Work) -> tuple[int, int]:
    """The worst fault of the highest level that has one: (row, its right side).

    Returns:
        (-1, 0) for an optimal working set.
    """
    A, lower, upper, x = w.A, w.lower, w.upper, w.x
    start, side, size = w.start, w.side, w.size
    n, reach, held = x.size, length(x), False
    for k in range(w.count.size):
        worst, row, right = FEASIBILITY + ROUND_OFF * reach, -1, 0
        for r in range(start[k], start[k + 1]):
            if side[r] == 0 and size[r] > 0.0:
                value = dot(A[r], x, 0, n)
                out = max(value - upper[r], lower[r] - value)
                if out > worst * size[r]:
                    worst, row = out / size[r], r
                    right = 1 if value > upper[r] else -1
            elif side[r] * side[r] == 1:
                held = True
        if row >= 0:
            return row, right
    return (_puller(w, 1.0 + reach) if held else -1), 0


@inner
def _puller(w: Work, reach: float) -> int:
    """The held bound that pulls most in the first level where one does; -1 if none."""
    side, fixed, p = w.side, w.fixed, w.count.size
    for r in range(side.size):
        fixed[r] = side[r] * side[r] != 1 or w.stuck[r]
    for k in range(p + 1):
        row = _against_slack(w, k, reach) if k < p else -1
        if row < 0:
            floor = multipliers(w, k, reach)
            row = _against_multiplier(w, k, floor) if floor >= 0.0 else -1
        if row >= 0:
            return row
    return -1


@inner
def _against_slack(w: Work, k: int, reach: float) -> int:
    """A row held to a bound that it would leave inwards."""
    slack, side, fixed = w.slack, w.side, w.fixed
    worst, row, floor = 0.0, -1, slack_floor(w, k, reach)
    for r in w.order[w.start[k] : w.start[k] + w.count[k]]:
        if not fixed[r] and abs(slack[r]) > floor:
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
            if not fixed[r] and abs(push) > floor:
                fixed[r] = 1
                if -push > worst:
                    worst, row = -push, r
    return row


@inner
def slack_floor(w: Work, k: int, reach: float) -> float:
    """Slack of a row below which it has no sign."""
    rows = w.order[w.start[k] : w.start[k] + w.count[k]]
    return float(SIGN * (w.scale[k] * reach + _norm(w.slack, rows)))


@inner
def multipliers(w: Work, k: int, reach: float) -> float:
    """Multipliers of the rows above level k for its force A_k^T s_k.

    k = p asks for the wish for least norm, -x, below all levels.

    Returns:
        the force below which a row has no sign; negative where all are round-off.
    """
    start, first, count, order = w.start, w.first, w.count, w.order
    A, W, pull, multiplier, slack = w.A, w.W, w.pull, w.multiplier, w.slack
    p = count.size
    taken = first[min(k, p)]
    for j in range(taken):
        pull[j] = -w.c[j] if k == p else 0.0
    noise = NOISE
    if k < p:
        rows = order[start[k] : start[k] + count[k]]
        columns = few_left(w, rows.size, taken)
        if columns:
            pull[:] = 0.0
        for r in rows:
            if slack[r] != 0.0 and columns:
                add_scaled(slack[r], A[r], pull, 0, pull.size)
            elif slack[r] != 0.0:
                add_scaled(slack[r], W[r], pull, 0, taken)
        if columns:
            reflect(pull, w.V, w.beta, taken)
        # Directions that the level has lost still pull, by their singular value.
        scale = w.scale[k]
        noise = scale * (SIGN * _norm(w.slack, rows) + NOISE * scale * reach)
    force = float(np.sqrt(dot(pull, pull, 0, taken)))
    if force <= noise:
        return -1.0
    largest = force
    for j in range(k - 1, -1, -1):
        rows = order[start[j] : start[j] + count[j]]
        rank = first[j + 1] - first[j]
        push = _peel(W, multiplier, w.size, pull, rows, first[j], rank)
        largest = max(largest, push)
    return max(SIGN * force, NOISE * largest, noise)


@inner
def _peel(
    W: Array,
    multiplier: Array,
    size: Array,
    pull: Array,
    rows: IntArray,
    first: int,
    rank: int,
) -> float:
    """Multipliers of a level's pivots; takes their forces out, returns the largest."""
    for r in rows[rank:]:
        multiplier[r] = 0.0
    largest = 0.0
    for i in range(rank - 1, -1, -1):
        r = rows[i]
        multiplier[r] = pull[first + i] / W[r, first + i]
        add_scaled(-multiplier[r], W[r], pull, 0, first + i)
        largest = max(largest, abs(multiplier[r]) * size[r])
    return largest


@inner
def _norm(values: Array, rows: IntArray) -> float:
    """Norm of some rows' values."""
    square = 0.0
    for r in rows:
        square += values[r] * values[r]
    return float(np.sqrt(square))
