"""Which bounds to hold: saturation in the null space (Flacco 2015)."""

from __future__ import annotations

from wbc.arrays import Array, IntArray
from wbc.compiled import compiled, inner
from wbc.projection.recursion import norm, project, target
from wbc.projection.work import Work, set_problem, work_at
from wbc.vectors import add_scaled, dot, length

__all__ = ["saturate"]

FEASIBILITY = 1e-9
"""A bound counts as violated beyond this, relative to its row's norm and size."""
MULTIPLIER = 1e-9
"""A multiplier below this, relative to the forces at play, has no sign."""


@compiled
def saturate(
    A: Array, lower: Array, upper: Array, rest: Array, address: int, release: bool
) -> int:
    """Hold the worst violated bound, let go of one that pulls, until neither is.

    Args:
        A: (m, n) rows in the coordinates where the law's metric is the identity.
        lower: (m,) bounds.
        upper: (m,) bounds.
        rest: (n,) what y would be if all motion were to die out.
        address: of a `Memory`.
        release: whether bounds that are held may be let go.

    Returns:
        number of projections; negative where that many did not settle it.
    """
    w = work_at(address)
    set_problem(w, A, lower, upper, rest)
    m, n = A.shape
    w.bounding[:] = 0
    for r in range(m):
        if lower[r] == upper[r]:
            w.side[r] = 0
        else:
            w.bounding[w.task[r]] = 1
    most: int = 2 * n + 4 if release else m + 1
    for count in range(1, most + 1):
        project(w)
        if _hold_worst(w):
            continue
        if release and _release_one(w):
            continue
        return count
    return -most


@inner
def _hold_worst(w: Work) -> bool:
    """Hold the bound that is violated most, relative to its row's norm."""
    A, lower, upper = w.A, w.lower, w.upper
    worst, row, side = 0.0, -1, 0
    for r in range(w.side.size):
        if w.side[r] != 0 or lower[r] == upper[r]:
            continue
        value = dot(A[r], w.y, 0, w.y.size)
        above, below = value - upper[r], lower[r] - value
        excess = max(above, below)
        if excess > 0.0:
            size = length(A[r])
            relative = excess / max(size, 1e-300)
            if excess > FEASIBILITY * (size + abs(value)) and relative > worst:
                worst, row, side = relative, r, 1 if above > below else -1
    if row >= 0:
        w.side[row] = side
    return row >= 0


@inner
def _release_one(w: Work) -> bool:
    """Let go of a held bound that the blocks below would leave by themselves.

    The sign of the first block that pulls at a row decides (lexicographic); the wish
    for least norm pulls last.
    """
    held, reach = 0, 1.0 + length(w.y)
    for r in range(w.side.size):
        w.undecided[r] = w.side[r] != 0
        held += w.undecided[r]
    if held == 0:
        return False
    for c in range(w.blocks[0]):
        rows = w.order[w.block[c] : w.block[c + 1]]
        scale = norm(w, rows)
        floor = MULTIPLIER * (scale * reach + _pull(w, rows))
        row = _would_leave(w, rows, floor)
        if row < 0 and length(w.pull) > scale * floor:
            row = _wrong_sign(w, c)
        if row >= 0:
            w.side[row] = 0
            return True
    for j in range(w.y.size):
        w.pull[j] = -w.y[j]
    row = _wrong_sign(w, w.blocks[0])
    if row >= 0:
        w.side[row] = 0
    return row >= 0


@inner
def _pull(w: Work, rows: IntArray) -> float:
    """What the rows of a block miss, and its force; the most that one misses."""
    most = 0.0
    w.pull[:] = 0.0
    for q in range(rows.size):
        r = rows[q]
        missing = target(w, r) - dot(w.A[r], w.y, 0, w.y.size)
        add_scaled(missing, w.A[r], w.pull, 0, w.y.size)
        w.missing[q] = missing
        most = max(most, abs(missing))
    return most


@inner
def _would_leave(w: Work, rows: IntArray, floor: float) -> int:
    """A row held inside its bound, by others; -1 if none. Those beyond it stay."""
    for q in range(rows.size):
        r = rows[q]
        if w.undecided[r] and abs(w.missing[q]) > floor:
            if w.missing[q] * w.side[r] > 0.0:
                return int(r)
            w.undecided[r] = 0
    return -1


@inner
def _wrong_sign(w: Work, count: int) -> int:
    """A held row of the first `count` blocks that pulls, where `pull` pushes at them.

    Multipliers from the lowest block up: each takes what falls into its directions.
    """
    n, largest = w.y.size, length(w.pull)
    for c in range(count - 1, -1, -1):
        rows = w.order[w.block[c] : w.block[c + 1]]
        push = w.push[w.block[c] : w.block[c + 1]]
        push[:] = 0.0
        for i in range(w.first[c], w.first[c + 1]):
            share = dot(w.Z[i], w.pull, 0, n) / (w.sigma[i] * w.sigma[i])
            add_scaled(share, w.B[i], push, 0, rows.size)
        for q in range(rows.size):
            add_scaled(-push[q], w.A[rows[q]], w.pull, 0, n)
            push[q] *= length(w.A[rows[q]])
            largest = max(largest, abs(push[q]))
    for q in range(w.block[count]):
        r = w.order[q]
        if w.undecided[r] and abs(w.push[q]) > MULTIPLIER * largest:
            if w.push[q] * w.side[r] < 0.0:
                return int(r)
            w.undecided[r] = 0
    return -1
