"""Primal active-set method, level by level: finds the working set from nothing.

At level k the point moves towards the level's minimiser on the working set, keeping
what the levels above have reached. It stops at the first bound in its way, which joins
the set, and where a row of the level comes back inside its bound, which leaves it.
Arrived, the held bound that pulls most is let go; when none pulls, those that push are
fixed for good and the next level begins. The last level is the wish for least norm.
"""

from __future__ import annotations

from wbc.arrays import Array
from wbc.compiled import inner
from wbc.lexicographic.multipliers import (
    SIGN,
    multipliers,
    norm_of,
    outside,
)
from wbc.lexicographic.sweep import sweep
from wbc.lexicographic.vectors import dot, reflect, reflect_back
from wbc.lexicographic.work import Work

__all__ = ["descend"]


@inner
def descend(
    A: Array,
    lower: Array,
    upper: Array,
    w: Work,
    tolerance: float,
    feasibility: float,
    most: int,
) -> int:
    """Solve from the origin with an empty working set.

    Returns:
        how many sweeps it took; negative if `most` were not enough, with the point
        reached and its working set left in place.
    """
    p, n, x, target, side = w.count.size, w.x.size, w.x, w.target, w.side
    for r in range(side.size):
        w.fixed[r] = side[r] == 2
        side[r] = side[r] if side[r] == 2 else 0
    x[:] = 0.0
    sweeps, dirty = 0, 0
    for k in range(p + 1):
        last = min(k + 1, p)
        if k < p:
            _hold_violated(A, lower, upper, w, k, feasibility)
            dirty = min(dirty, k)
        while True:
            sweeps += 1
            if sweeps > most:
                return -sweeps
            taken = sweep(A, lower, upper, w, tolerance, dirty, last)
            dirty = last
            _aim(w, taken, k == p)
            row, new, step = _first_event(A, lower, upper, w, k, feasibility)
            for j in range(n):
                x[j] += step * (target[j] - x[j])
            if row < 0:
                row, new = _settle(w, k), 0
            if row < 0:
                break
            side[row] = new
            dirty = min(dirty, w.level[row])
    return sweeps


@inner
def _hold_violated(
    A: Array, lower: Array, upper: Array, w: Work, k: int, feasibility: float
) -> None:
    """The level's rows that x violates join the working set."""
    side, size, x = w.side, w.size, w.x
    for r in range(w.start[k], w.start[k + 1]):
        if side[r] == 0:
            value = dot(A[r], x, 0, x.size)
            out = outside(value, lower[r], upper[r], size[r], feasibility)
            side[r] = 1 if out > 0.0 else -1 if out < 0.0 else 0


@inner
def _aim(w: Work, taken: int, least_norm: bool) -> None:
    """The swept coordinates, the others as they are, or zero at the last level."""
    target, x, c = w.target, w.x, w.c
    for j in range(x.size):
        target[j] = x[j]
    reflect(target, w.V, w.beta, taken)
    for j in range(x.size):
        if j < taken:
            target[j] = c[j]
        elif least_norm:
            target[j] = 0.0
    reflect_back(target, w.V, w.beta, taken)


@inner
def _first_event(
    A: Array, lower: Array, upper: Array, w: Work, k: int, feasibility: float
) -> tuple[int, int, float]:
    """What happens first on the way to the target: (row, its new side, step)."""
    start, side, fixed, size, slack = w.start, w.side, w.fixed, w.size, w.slack
    x, target, n, p = w.x, w.target, w.x.size, w.count.size
    step, row, new = 1.0, -1, 0
    for r in range(start[min(k + 1, p)]):
        if side[r] == 0:
            there = dot(A[r], target, 0, n)
            out = outside(there, lower[r], upper[r], size[r], feasibility)
            if out == 0.0:
                continue
            into, bound = (1, upper[r]) if out > 0.0 else (-1, lower[r])
        else:
            inside = slack[r] * side[r]
            own = k < p and r >= start[k] and side[r] != 2 and not fixed[r]
            if not own or inside <= feasibility * (size[r] + abs(slack[r])):
                continue
            there = dot(A[r], target, 0, n)
            into, bound = 0, upper[r] if side[r] == 1 else lower[r]
        here = dot(A[r], x, 0, n)
        if into != 0 and (there - here) * into <= 0.0:
            continue
        share = max((bound - here) / (there - here), 0.0) if there != here else 0.0
        if share < step:
            step, row, new = share, r, into
    return row, new, step


@inner
def _settle(w: Work, k: int) -> int:
    """The held bound that pulls most; where none does, those that push stay: -1."""
    start, count, order, side = w.start, w.count, w.order, w.side
    fixed, multiplier, size = w.fixed, w.multiplier, w.size
    slack, bound = w.slack, w.bound
    force = multipliers(w, k)
    if force > 0.0:
        worst, row = SIGN * force, -1
        for j in range(k):
            for r in order[start[j] : start[j] + count[j]]:
                push = multiplier[r] * size[r] * side[r]
                if not fixed[r] and -push > worst:
                    worst, row = -push, r
        if row >= 0:
            return row
        for j in range(k):
            for r in order[start[j] : start[j] + count[j]]:
                if not fixed[r] and multiplier[r] * size[r] * side[r] > SIGN * force:
                    fixed[r] = 1
    if k < count.size:
        rows = order[start[k] : start[k] + count[k]]
        norm = norm_of(slack, rows)
        for r in rows:
            if abs(slack[r]) > SIGN * (size[r] + abs(bound[r]) + norm):
                fixed[r] = 1
    return -1
