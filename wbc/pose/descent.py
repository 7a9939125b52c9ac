"""Down to where a level holds, and along where all hold towards the start.

Every step is a strict hierarchy on joint displacements: the box of joint limits and of
the step size, then the levels above, linearised, then what is to be improved. After a
step the levels above are restored, so that only configurations on which they hold are
compared.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import final

import numpy as np

from wbc.arrays import Array
from wbc.hqp import solve_hierarchy
from wbc.pose.goal import Goal, Linear

__all__ = ["Descent"]

STEP = 0.5
"""Largest displacement of a joint in one step [rad or m, weighted]."""
STEPS = 100
HOLDS = 1e-9
"""Norm of a level's error below which it counts as held on the way [m, rad]."""
EXACT = 1e-13
"""Norm below which an error is round-off."""
STILL = 1e-11
"""Norm of a step that changes nothing."""
RESTORATIONS = 8
DIFFERENCE = 1e-5
FLAT = 1e-3
"""Least curvature that a step along the constraints counts on."""


@final
class Descent:
    """Steps of a goal within the limits.

    Args:
        goal: the tasks.
        low: (n,) lower limits of u.
        high: (n,) upper limits.
    """

    def __init__(self, goal: Goal, low: Array, high: Array) -> None:
        self._goal, self._low, self._high = goal, low, high
        self._eye = np.eye(low.size)

    def approach(self, u: Array, k: int) -> Array:
        """Least error of level k while the levels above hold (Levenberg-Marquardt).

        The damping is in proportion to the squared error, so that convergence is
        quadratic where the error vanishes and steps stay bounded where it cannot.
        """
        damping, growth, slow = 1e-2, 2.0, 0
        levels = self._goal.evaluate(u)
        for _ in range(STEPS):
            J, e = levels[k]
            size = float(np.linalg.norm(e))
            if size < EXACT or damping > 1e12 or slow > 3:
                break
            mu = np.sqrt(damping) * size
            wanted = (np.vstack([J, mu * self._eye]), np.append(-e, 0.0 * u))
            step = self._step(u, levels[:k], wanted)
            if np.linalg.norm(step) < STILL:
                break
            trial = self.restore(u + step, k)
            found = None if trial is None else self._goal.evaluate(trial)
            after = np.inf if found is None else float(np.linalg.norm(found[k][1]))
            if trial is None or found is None or after >= size:
                damping, growth = damping * growth, 2.0 * growth
                continue
            slow = slow + 1 if after > (1.0 - 1e-7) * size else 0
            u, levels, damping, growth = trial, found, max(damping / 4.0, 1e-9), 2.0
        return u

    def restore(self, u: Array, k: int) -> Array | None:
        """The levels above k held again, by least motion; None if that fails."""
        best = np.inf
        u = np.clip(u, self._low, self._high)
        for _ in range(RESTORATIONS if k else 0):
            levels = self._goal.evaluate(u)[:k]
            error = max(float(np.linalg.norm(e)) for _, e in levels)
            if error < EXACT or (error < HOLDS and error > 0.5 * best):
                return u
            if error > 2.0 * best:
                return None
            best = min(best, error)
            u = u + self._step(u, levels)
        levels = self._goal.evaluate(u)[:k]
        held = all(np.linalg.norm(e) < HOLDS for _, e in levels)
        return u if held else None

    def slide(self, u: Array, wish: Array) -> Array:
        """Nearest to `wish` with all levels held (Newton's method on the tangent)."""
        k = self._goal.count
        restored = self.restore(u, k)
        if restored is None:
            return u
        u = restored
        for _ in range(STEPS):
            levels = self._goal.evaluate(u)
            rows, bend = self._tangent(u, u - wish, levels)
            step = self._step(u, levels, rows)
            trial = None
            if float(np.linalg.norm(step)) > STILL:
                trial = self._nearer(u, step, wish, k)
            if trial is None and bend is not None:  # at a saddle: leave it
                trial = self._nearer(u, 0.1 * bend, wish, k)
                trial = (
                    trial
                    if trial is not None
                    else self._nearer(u, -0.1 * bend, wish, k)
                )
            if trial is None:
                break
            u = trial
        return u

    def _nearer(self, u: Array, step: Array, wish: Array, k: int) -> Array | None:
        """A shorter and shorter step, until it leads nearer; None if none does."""
        square = float((u - wish) @ (u - wish))
        for _ in range(12):
            trial = self.restore(u + step, k)
            if trial is not None:
                after = float((trial - wish) @ (trial - wish))
                if after < square - 1e-15 * (1.0 + square):
                    return trial
            step = 0.5 * step
        return None

    def _tangent(
        self, u: Array, away: Array, levels: Sequence[Linear]
    ) -> tuple[Linear, Array | None]:
        """Rows whose least squares is Newton's step, and a direction of a saddle.

        The Lagrangian of |u - wish|^2 / 2 has the Hessian I + sum lambda_i dd e_i; on
        the tangent space its eigenvalues are taken by their size.
        """
        J = np.vstack([J for J, _ in levels])
        free = (u > self._low + HOLDS) & (u < self._high - HOLDS)
        prices = -np.linalg.lstsq(J[:, free].T, away[free], rcond=1e-9)[0]
        now = J.T @ prices
        bent = np.empty((u.size, u.size))
        for j in range(u.size):
            ahead = self._goal.evaluate(u + DIFFERENCE * self._eye[j])
            bent[j] = np.vstack([J for J, _ in ahead]).T @ prices - now
        H = self._eye + (bent + bent.T) / (2.0 * DIFFERENCE)
        _, sigma, Vt = np.linalg.svd(np.vstack([J, np.diag(~free * 1.0)]))
        Z = Vt[int(np.count_nonzero(sigma > 1e-7 * max(sigma[0], 1.0))) :].T
        values, vectors = np.linalg.eigh(Z.T @ H @ Z)
        saddle = Z @ vectors[:, 0] if values.size and values[0] < -FLAT else None
        # joints at a limit may leave it: outside the tangent the Hessian is taken as I
        C = np.sqrt(np.maximum(np.abs(values), FLAT))
        W = self._eye - Z @ Z.T
        rows = np.vstack([(C[:, None] * vectors.T) @ Z.T, W])
        wanted = np.append(-(vectors.T @ (Z.T @ away)) / C, -W @ away)
        return (rows, wanted), saddle

    def _step(
        self, u: Array, levels: Sequence[Linear], last: Linear | None = None
    ) -> Array:
        """Displacement that the levels, linearised, and then `last` ask for."""
        low = np.clip(self._low - u, -STEP, 0.0)
        high = np.clip(self._high - u, 0.0, STEP)
        stack = [(self._eye, low, high), *((J, -e, -e) for J, e in levels)]
        if last is not None:
            stack.append((last[0], last[1], last[1]))
        return solve_hierarchy(stack).x
