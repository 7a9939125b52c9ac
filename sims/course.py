"""The course of a run: what figures about any run are drawn from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar, final

import numpy as np

from sims.log import Log
from wbc.arrays import Array

__all__ = ["Course"]

Name = TypeVar("Name", str, tuple[int, str])


@final
@dataclass(frozen=True, slots=True, eq=False)
class Course:
    """What happened in a run, or in several that follow one another.

    Attributes:
        t: (T,) time [s].
        torque, speed: (T,) largest share of its limit that any joint uses.
        errors: "task [unit]" -> (T,) norm of the error; NaN without such a task.
        active: "level k: task: row" -> (T,) whether that bound was active.
        sampled: (S,) times [s] of the shortfalls.
        shortfall: (level, task) -> (S,), see `LevelLog`.
    """

    t: Array
    torque: Array
    speed: Array
    errors: dict[str, Array]
    active: dict[str, Array]
    sampled: Array
    shortfall: dict[tuple[int, str], Array]

    @classmethod
    def of(cls, *logs: Log) -> Course:
        """The course of one run, or of consecutive runs of one cell in order."""
        sizes = [log.t.size for log in logs]
        samples = [log.levels.t.size for log in logs]
        return cls(
            t=np.concatenate([log.t for log in logs]),
            torque=np.concatenate(
                [_use(log.torque, log.robot.tau_max) for log in logs]
            ),
            speed=np.concatenate([_use(log.v, log.robot.v_max) for log in logs]),
            errors=_union([_named(log) for log in logs], sizes, np.nan),
            active=_union([log.active for log in logs], sizes, missing=False),
            sampled=np.concatenate([log.levels.t for log in logs]),
            shortfall=_union([log.levels.shortfall for log in logs], samples, np.nan),
        )


def _use(values: Array, limit: Array) -> Array:
    share: Array = np.abs(values / limit).max(axis=1)
    return share


def _named(log: Log) -> dict[str, Array]:
    """Errors by task and unit, of the tasks that have one."""
    return {
        f"{name} [{log.units.get(name) or '1'}]": error
        for name, error in log.errors.items()
        if np.isfinite(error).any()
    }


def _union(
    parts: Sequence[Mapping[Name, Array]], sizes: Sequence[int], missing: float
) -> dict[Name, Array]:
    """One array a name over all parts, filled where a part has no such name."""
    names = dict.fromkeys(name for part in parts for name in part)
    return {
        name: np.concatenate(
            [
                part[name] if name in part else np.full(size, missing)
                for part, size in zip(parts, sizes, strict=True)
            ]
        )
        for name in names
    }
