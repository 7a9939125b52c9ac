"""Primal active-set method, level by level: what remains where the others give up.

At level k the point moves towards the level's minimiser on the working set, keeping
what the levels above have reached. It stops at the first bound in its way, which joins
the set, and where a row of the level comes back inside its bound, which leaves it.
Arrived, the held bound that pulls most is let go; when none pulls, those that push are
fixed for good and the next level begins. The last level is the wish for least norm.

Each event costs a sweep, but every point on the way is optimal for the levels above,
and the sweeps are exact however singular a level is.
"""

from __future__ import annotations

from wbc.compiled import inner
from wbc.lexicographic.multipliers import ROUND_OFF, multipliers, slack_floor
from wbc.lexicographic.sweep import sweep
from wbc.lexicographic.work import Work
from wbc.vectors import copy, dot, length, reflect, reflect_back

__all__ = ["descend"]

PATIENCE = 8
"""A row that a level let go so often stays for the rest of the level."""


@inner
def descend(w: Work, most: int) -> int:
    """Solve from the origin with an empty working set.

    Returns:
        how many sweeps it took; negative if `most` were not enough. In any case x is
        optimal for the levels that were finished.
    """
    p, x, side = w.count.size, w.x, w.side
    for r in range(side.size):
        w.fixed[r] = side[r] == 2
        side[r] = side[r] if side[r] == 2 else 0
    x[:] = 0.0
    sweeps, dirty, gone, was = 0, 0, -1, 0
    for k in range(p + 1):
        w.released[:] = 0
        if k < p:
            _hold_violated(w, k)
            dirty = min(dirty, k)
        while True:
            sweeps += 1
            if sweeps > most:
                return -sweeps
            _aim(w, sweep(w, dirty, min(k + 1, p)), k == p)
            dirty = min(k + 1, p)
            if gone >= 0 and _still_out(w, gone, was):
                w.fixed[gone], side[gone] = 1, was
                dirty, gone = w.level[gone], -1
                continue
            row, new, step = _first_event(w, k)
            for j in range(x.size):
                x[j] += step * (w.target[j] - x[j])
            gone = -1
            if row < 0:
                gone = row = _settle(w, k)
                if row < 0:
                    break
                was = side[row]
            side[row] = new
            dirty = min(dirty, w.level[row])
    return sweeps


@inner
def _still_out(w: Work, row: int, side: int) -> bool:
    """Whether a row just let go heads straight out: its push was within round-off."""
    value = dot(w.A[row], w.target, 0, w.x.size)
    out = value - w.upper[row] if side == 1 else w.lower[row] - value
    return bool(out > ROUND_OFF * w.size[row] * (1.0 + length(w.target)))


@inner
def _hold_violated(w: Work, k: int) -> None:
    """The level's rows that x violates join the working set."""
    side, size, x = w.side, w.size, w.x
    reach = ROUND_OFF * (1.0 + length(x))
    for r in range(w.start[k], w.start[k + 1]):
        if side[r] == 0 and size[r] > 0.0:
            value = dot(w.A[r], x, 0, x.size)
            if value - w.upper[r] > reach * size[r]:
                side[r] = 1
            elif w.lower[r] - value > reach * size[r]:
                side[r] = -1


@inner
def _aim(w: Work, taken: int, least_norm: bool) -> None:
    """The swept coordinates, the others as they are, or zero at the last level."""
    target = w.target
    copy(w.x, target)
    reflect(target, w.V, w.beta, taken)
    copy(w.c[:taken], target)
    if least_norm:
        target[taken:] = 0.0
    reflect_back(target, w.V, w.beta, taken)


@inner
def _first_event(w: Work, k: int) -> tuple[int, int, float]:
    """What happens first on the way to the target: (row, its new side, step)."""
    start, side, fixed, size, slack = w.start, w.side, w.fixed, w.size, w.slack
    A, lower, upper, x, target = w.A, w.lower, w.upper, w.x, w.target
    n, p = x.size, w.count.size
    step, row, new = 1.0, -1, 0
    reach = ROUND_OFF * (1.0 + length(x))
    for r in range(start[min(k + 1, p)]):
        own = k < p and r >= start[k] and side[r] != 2 and not fixed[r]
        inside = own and slack[r] * side[r] > reach * w.scale[k]
        if size[r] == 0.0 or not (side[r] == 0 or inside):
            continue
        there, into = dot(A[r], target, 0, n), 0
        if side[r] == 0:
            limit = reach * size[r]
            into = (
                1 if there - upper[r] > limit else -1 if lower[r] - there > limit else 0
            )
            if into == 0:
                continue
        here = dot(A[r], x, 0, n)
        if into != 0 and (there - here) * into <= 0.0:
            continue
        bound = upper[r] if into + side[r] == 1 else lower[r]
        share = max((bound - here) / (there - here), 0.0) if there != here else 0.0
        if share < step:
            step, row, new = share, r, into
    return row, new, step


@inner
def _settle(w: Work, k: int) -> int:
    """The held bound that pulls most; where none does, those that push stay: -1."""
    start, count, order, side = w.start, w.count, w.order, w.side
    fixed, multiplier, size, released = w.fixed, w.multiplier, w.size, w.released
    reach = 1.0 + length(w.x)
    worst, row = multipliers(w, k, reach), -1
    floor = worst
    if floor >= 0.0:
        for j in range(k):
            for r in order[start[j] : start[j] + count[j]]:
                push = multiplier[r] * size[r] * side[r]
                if not fixed[r] and released[r] < PATIENCE and -push > worst:
                    worst, row = -push, r
        if row >= 0:
            released[row] += 1
            return row
        for j in range(k):
            for r in order[start[j] : start[j] + count[j]]:
                if multiplier[r] * size[r] * side[r] > floor:
                    fixed[r] = 1
    if k < count.size:
        limit = slack_floor(w, k, reach)
        for r in order[start[k] : start[k] + count[k]]:
            if abs(w.slack[r]) > limit:
                fixed[r] = 1
    return -1
