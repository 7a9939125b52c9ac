"""Hierarchies for the solvers alone: random ones, and slowly changing sequences.

All rows have unit norm, because DAQP normalises them: otherwise it would minimise in
another metric than the one asked for. The last level is a posture, so that the
optimum is unique and answers can be compared.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from benchmarks.arm import arms_urdf

__all__ = ["MOTION_DT", "Problem", "arm_motion", "random_problems", "smooth_motion"]

Array = NDArray[np.float64]
Level = tuple[Array, Array, Array]

KINDS = {3: "bep", 4: "beip", 5: "beiep", 6: "beieip"}
"""Levels by their number: box, equalities, inequalities, posture."""
MOTION_DT = 0.005
PACE = 2.0 * np.pi  # of the slowest change along a smooth motion [rad/s]
SWING, SWING_PACE = 0.25, 7.0  # of an arm's joints [rad], [rad/s]
TORQUE_SHARE = 0.3  # of the limits, so that they switch
WIDTH = 0.2  # half of an inequality's interval


@dataclass(frozen=True, eq=False)
class Problem:
    """Stacked levels; those that start with a box know it.

    Attributes:
        sizes: rows of each level.
        A: (m, n) unit rows.
        lower: (m,)
        upper: (m,)
        boxed: whether the first n rows are the identity.
        general: the rows below the box.
    """

    sizes: tuple[int, ...]
    A: Array
    lower: Array
    upper: Array
    boxed: bool = False
    general: Array = field(init=False)

    def __post_init__(self) -> None:
        below = self.A[self.n if self.boxed else 0 :]
        object.__setattr__(self, "general", np.ascontiguousarray(below))

    @property
    def n(self) -> int:
        """Number of unknowns."""
        return self.A.shape[1]

    def levels(self) -> list[Level]:
        """(A, lower, upper) of every level."""
        ends = np.cumsum(self.sizes)[:-1]
        parts = (np.split(a, ends) for a in (self.A, self.lower, self.upper))
        return list(zip(*parts, strict=True))


def random_problems(n: int, count: int = 20) -> list[Problem]:
    """3 to 6 levels under a box; the second half conflicts."""
    return [_random(n, seed, conflicting=2 * seed >= count) for seed in range(count)]


def _random(n: int, seed: int, *, conflicting: bool) -> Problem:
    rng = np.random.default_rng([n, seed])
    kinds = KINDS[3 + seed % 4]
    wish = rng.uniform(-0.8, 0.8, n)
    levels = []
    for kind in kinds:
        if conflicting:
            wish = rng.uniform(2.0, 4.0, n) * rng.choice([-1.0, 1.0], n)
        levels.append(_level(kind, n, wish, rng))
    return _stack(levels, boxed=True)


def _level(kind: str, n: int, wish: Array, rng: np.random.Generator) -> Level:
    """One level that the wish meets (posture apart)."""
    if kind == "b":
        return np.eye(n), np.full(n, -1.0), np.full(n, 1.0)
    if kind == "p":
        posture = rng.uniform(-1.5, 1.5, n)
        return np.eye(n), posture, posture
    m = max(n // 3, 3) if kind == "e" else n // 2
    A = _unit(rng.standard_normal((m, n)))
    if kind == "e":
        return A, A @ wish, A @ wish
    middle = A @ wish + rng.uniform(-WIDTH, WIDTH, m)
    return A, middle - WIDTH, middle + WIDTH


def smooth_motion(n: int, ticks: int) -> list[Problem]:
    """Five levels whose rows and bounds drift; limits come and go.

    Dense limits (n rows), a box, equalities, inequalities, posture; the wish swings
    beyond the limits.
    """
    rng = np.random.default_rng([n, 1000])
    m, k = max(n // 3, 3), n // 2
    bases = [
        (np.eye(n) + 0.3 * rng.standard_normal((n, n)) / n**0.5, 0.3 / n**0.5),
        (rng.standard_normal((m, n)), 0.3),
        (rng.standard_normal((k, n)), 0.3),
    ]
    changes = [s * rng.standard_normal(A.shape) for A, s in bases]
    pace, phase = PACE * rng.uniform(0.3, 1.0, n), rng.uniform(0.0, 2 * np.pi, n)
    problems = []
    for tick in range(ticks):
        t = tick * MOTION_DT
        wave = np.sin(pace * t + phase)
        limits, E, G = (
            _unit(A + change * np.sin(PACE * t))
            for (A, _), change in zip(bases, changes, strict=True)
        )
        wish, box, rest = 1.1 * wave, np.full(n, 1.5), 0.5 * wave[::-1]
        levels = [
            (limits, np.full(n, -1.0), np.full(n, 1.0)),
            (np.eye(n), -box, box),
            (E, E @ wish, E @ wish),
            (G, G @ wish - WIDTH, G @ wish + WIDTH),
            (np.eye(n), rest, rest),
        ]
        problems.append(_stack(levels))
    return problems


def arm_motion(arms: int, ticks: int, folder: Path) -> list[Problem]:
    """Five levels of real arms whose torque limits switch: what a controller sees.

    Torque limits, acceleration limits, position, orientation, posture, while the
    joints swing; the tips are asked to follow.
    """
    arm = arms_urdf(arms)
    path = folder / f"motion{arms}.urdf"
    path.write_text(arm.urdf)
    model = pin.buildModelFromUrdf(str(path))
    data, home = model.createData(), np.array(arm.home)
    tips = [model.getFrameId(tip) for tip in arm.tips]
    phase = np.arange(model.nv)
    problems = []
    for tick in range(ticks):
        angle = SWING_PACE * tick * MOTION_DT + phase
        q = home + SWING * np.sin(angle)
        v = SWING * SWING_PACE * np.cos(angle)
        a = -SWING * SWING_PACE**2 * np.sin(angle)
        M, h = pin.crba(model, data, q), pin.nonLinearEffects(model, data, q, v)
        pin.computeJointJacobians(model, data, q)
        pin.updateFramePlacements(model, data)
        world = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        J = [pin.getFrameJacobian(model, data, tip, world) for tip in tips]
        moves, turns = np.vstack([j[:3] for j in J]), np.vstack([j[3:] for j in J])
        limit, box = TORQUE_SHARE * model.effortLimit, np.array(arm.acceleration)
        rest = -25.0 * (q - home) - 10.0 * v
        levels = [
            (M, -limit - h, limit - h),
            (np.eye(model.nv), -box, box),
            (moves, moves @ a, moves @ a),
            (turns, turns @ a, turns @ a),
            (np.eye(model.nv), rest, rest),
        ]
        problems.append(_stack(levels))
    return problems


def _stack(levels: list[Level], *, boxed: bool = False) -> Problem:
    """Levels as one problem, every row scaled to unit norm."""
    A, lower, upper = (np.concatenate(part) for part in zip(*levels, strict=True))
    size = np.linalg.norm(A, axis=1)
    sizes = tuple(level[0].shape[0] for level in levels)
    return Problem(sizes, A / size[:, None], lower / size, upper / size, boxed)


def _unit(A: Array) -> Array:
    return A / np.linalg.norm(A, axis=1, keepdims=True)
