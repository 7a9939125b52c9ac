"""Tables that are read off the classes, so that they cannot grow old."""

from __future__ import annotations

import inspect
from collections import Counter
from collections.abc import Callable

import numpy as np

import tasks
from robots import racer
from tasks.geometry import Constraint
from wbc import Hierarchy


def _units(units: tuple[str, ...]) -> str:
    return ", ".join(f"{n} {unit}" for unit, n in Counter(units).items())


def constraints() -> str:
    """Rows and rank of every geometric constraint."""
    lines = ["| constraint | rows | units | rank |", "|---|---|---|---|"]
    for name in tasks.__all__:
        kind = getattr(tasks, name)
        if not (inspect.isclass(kind) and issubclass(kind, Constraint)):
            continue
        names, units = zip(*kind.ROWS, strict=True)
        lines.append(
            f"| `{name}` | {', '.join(names)} | {_units(units)} | {len(names)} |"
        )
    rows, rank, units = _rim()
    lines.append(f"| `rim_grasp` (five of them) | {rows} rows | {units} | {rank} |")
    return "\n".join(lines)


def _rim() -> tuple[int, int, str]:
    """Of a rim grasp: rows, rank by analysis at a pose, and units."""
    arm = racer.load()
    can = tasks.Cylinder([0.9, 0.1, 0.5], [0.0, 0.0, 1.0], 0.05)
    level = tasks.rim_grasp("torch_tip", can)
    q = arm.q_home + 0.3 * np.random.default_rng(0).normal(size=arm.nv)
    found = Hierarchy.of(level).analyse(arm.state(q)).levels[0]
    units = tuple(unit for task, _ in level.terms for unit in task.units)
    return found.rows, found.rank, _units(units)


TABLES: dict[str, Callable[[], str]] = {"constraints": constraints}
