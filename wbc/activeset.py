"""From a QP backend's answer to a level's exact minimiser.

The cheapest sufficient thing is tried first: no bound matters; the working set of
the last tick; the backend's set, repaired by a primal active-set method that only
ever steps from feasible point to feasible point (Nocedal and Wright, ch. 16). The
origin is always feasible, so the repair also finishes where a backend misleads.
"""

from __future__ import annotations

import numpy as np

from wbc.arrays import Array
from wbc.errors import SolverError
from wbc.levelqp import (
    LevelPoint,
    LevelProblem,
    Sides,
    WorkingSet,
    faults,
    minimise_on,
)
from wbc.qp import QpBackend

__all__ = ["solve_level"]

PUSHING = 1e-6
"""A backend's multiplier above this, relative to the largest, marks a held row."""
INDEPENDENT = 1e-7
"""A row must keep this much of its norm beside those already held."""
GUESS_ROUNDS = 3
STEP = 1e-11


def solve_level(
    problem: LevelProblem, guess: WorkingSet | None, backend: QpBackend
) -> LevelPoint:
    """The level's minimiser, near the origin of its free coordinates.

    Raises:
        SolverError: no point passes the optimality conditions.
    """
    origin = np.zeros(problem.C.shape[1])
    point = minimise_on(problem, origin, WorkingSet.empty(problem))
    if faults(problem, point).none:
        return point
    if guess is not None:
        found = _try(problem, origin, guess)
        if found is not None:
            return found
    reason = "its point fails the optimality conditions"
    for start in (_ask, _origin):
        try:
            found = _descend(problem, *start(problem, backend))
        except SolverError as error:
            reason, found = str(error), None
        if found is not None:
            return found
    raise SolverError(f"no optimal point (QP backend '{backend.name}': {reason}).")


def _try(problem: LevelProblem, origin: Array, work: WorkingSet) -> LevelPoint | None:
    """Trust a guessed set, mending at most a few rows."""
    for _ in range(GUESS_ROUNDS):
        point = minimise_on(problem, origin, work)
        found = faults(problem, point)
        if found.none:
            return point
        carried, violated = work
        if found.wrong.any():
            carried = np.where(found.wrong > 0.0, 0, carried)
        if (found.outside[work.carried != 0] != 0.0).any():
            return None
        carried = np.where(found.outside != 0.0, np.sign(found.outside), carried)
        violated = np.where(found.beyond != 0.0, np.sign(found.beyond), violated)
        violated = np.where(found.met, 0, violated)
        work = WorkingSet(carried.astype(np.int8), violated.astype(np.int8))
    return None


def _origin(problem: LevelProblem, _: QpBackend) -> tuple[Array, Sides]:
    return np.zeros(problem.C.shape[1]), np.zeros(problem.c_lower.size, np.int8)


def _ask(problem: LevelProblem, backend: QpBackend) -> tuple[Array, Sides]:
    """Pose the QP in (z, s), rows scaled to unit norm and the cost to unit size.

    Raises:
        SolverError: the backend found no solution.
    """
    r, b = problem.C.shape[1], problem.i_lower.size
    size = 1.0 / problem.scale
    E, e = problem.E * size, problem.e * size
    P = np.zeros((r + b, r + b))
    P[:r, :r] = E.T @ E + 1e-10 * np.eye(r)
    P[r:, r:] = np.eye(b)
    q = np.concatenate([-(E.T @ e), np.zeros(b)])
    G = np.vstack(
        [
            np.hstack([problem.I * size, np.eye(b)]),
            np.hstack([problem.C, np.zeros((problem.C.shape[0], b))]),
        ]
    )
    lower = np.concatenate([problem.i_lower * size, problem.c_lower])
    upper = np.concatenate([problem.i_upper * size, problem.c_upper])
    slack = np.clip(0.0, problem.i_lower, problem.i_upper) * size
    start = np.concatenate([np.zeros(r), slack])
    x, duals = backend.solve(P, q, G, lower, upper, start)
    return _feasible(problem, x[:r]), _held(problem, duals[b:])


def _feasible(problem: LevelProblem, z: Array) -> Array:
    """The point, drawn towards the feasible origin as far as carried rows demand."""
    step = _reach(problem, np.zeros_like(z), z, np.zeros(problem.c_lower.size, np.int8))
    return z * min(1.0, step[0])


def _held(problem: LevelProblem, duals: Array) -> Sides:
    """Independent rows that the backend says push, the strongest first."""
    held = np.zeros(duals.size, np.int8)
    floor = PUSHING * max(1e-9, float(np.abs(duals).max(initial=0.0)))
    bound = np.where(duals > 0.0, problem.c_upper, problem.c_lower)
    duals = np.where(np.isfinite(bound), duals, 0.0)
    basis = np.zeros((problem.C.shape[1], 0))
    for row in np.argsort(-np.abs(duals)):
        if abs(duals[row]) <= floor:
            break
        rest = problem.C[row] - basis @ (basis.T @ problem.C[row])
        length = float(np.linalg.norm(rest))
        if length > INDEPENDENT:
            basis = np.column_stack([basis, rest / length])
            held[row] = 1 if duals[row] > 0 else -1
    return held


def _descend(problem: LevelProblem, z: Array, held: Sides) -> LevelPoint | None:
    """Primal active-set steps until the optimality conditions hold."""
    rounds = 30 + 5 * (held.size + problem.i_lower.size)
    ahead = np.zeros_like(z)
    for round_ in range(rounds):
        violated = _violated(problem, z, ahead)
        point = minimise_on(problem, z, WorkingSet(held, violated))
        found = faults(problem, point)
        if found.none:
            return point
        least = not (found.beyond.any() or found.met.any())
        turn = 1.0 if least else _line_search(problem, z, point.z)
        step, row, side = _reach(problem, z, point.z, held)
        ahead = point.z - z
        z = z + min(step, turn) * ahead
        if step < turn:
            held = held.copy()
            held[row] = side
        elif least and found.wrong.any():
            first = round_ > rounds // 2  # Bland's rule once the usual one cycles
            wrong = found.wrong > 0.0 if first else found.wrong
            held = held.copy()
            held[int(np.argmax(wrong))] = 0
    return None


def _violated(problem: LevelProblem, z: Array, ahead: Array) -> Sides:
    """Which of the level's rows are beyond a bound at z, or at it and leaving."""
    value, slope = problem.I @ z, problem.I @ ahead
    norm = np.linalg.norm(problem.I, axis=1)
    gap = STEP * (norm + np.abs(value))
    above = value > problem.i_upper + np.where(slope > 0.0, -gap, gap)
    below = value < problem.i_lower - np.where(slope < 0.0, -gap, gap)
    sides: Sides = above.astype(np.int8) - below.astype(np.int8)
    return sides


def _reach(
    problem: LevelProblem, z: Array, target: Array, held: Sides
) -> tuple[float, int, int]:
    """How far towards `target` the carried rows let go; the blocking row and side."""
    value, slope = problem.C @ z, problem.C @ (target - z)
    rising = (slope > STEP) & (held == 0)
    falling = (slope < -STEP) & (held == 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        up = np.where(rising, (problem.c_upper - value) / slope, np.inf)
        down = np.where(falling, (problem.c_lower - value) / slope, np.inf)
    ratio = np.maximum(np.minimum(up, down), 0.0)
    if not ratio.size or not np.isfinite(ratio.min()):
        return np.inf, -1, 0
    row = int(np.argmin(ratio))
    return float(ratio[row]), row, 1 if rising[row] else -1


def _line_search(problem: LevelProblem, z: Array, target: Array) -> float:
    """The step in [0, 1] towards `target` at which the level's cost is least.

    The cost is convex and piecewise quadratic, so its slope is continuous and grows:
    it is followed from one change of a row's status to the next. A row that is at its
    bound and about to leave it counts from the start, or steps could cycle.
    """
    ahead = target - z
    fixed = problem.E @ ahead
    at_start, curvature = float(fixed @ (problem.E @ z - problem.e)), fixed @ fixed
    value, slope = problem.I @ z, problem.I @ ahead
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = np.concatenate(
            [(problem.i_upper - value) / slope, (problem.i_lower - value) / slope]
        )
    inside = np.isfinite(crossing) & (crossing > 0.0) & (crossing < 1.0)
    steps = np.concatenate([[0.0], np.sort(crossing[inside]), [1.0]])
    rows = value + steps[:, None] * slope
    beyond = rows - np.clip(rows, problem.i_lower, problem.i_upper)
    climb = at_start + steps * curvature + beyond @ slope
    k = int(np.argmax(climb > 0.0))
    if climb[k] <= 0.0:
        return 1.0
    if k == 0:
        return 0.0
    share = climb[k - 1] / (climb[k - 1] - climb[k])
    return float(steps[k - 1] + share * (steps[k] - steps[k - 1]))
