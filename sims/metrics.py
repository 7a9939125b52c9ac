"""Numbers that a run is judged by: a value, and the bound that it must keep."""

from __future__ import annotations

import json
import math
import operator
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Final, Literal, final

from wbc.errors import InputError, UnknownName

__all__ = ["Metric", "Sense", "format_value", "table", "to_json", "verdict"]

Sense = Literal["<=", ">=", "==", ">"]

_TESTS: Final[dict[str, Callable[[float, float], bool]]] = {
    "<=": operator.le,
    ">=": operator.ge,
    "==": operator.eq,
    ">": operator.gt,
}


@final
@dataclass(frozen=True, slots=True)
class Metric:
    """One number of a run.

    Attributes:
        name: key with its SI unit as the last word, such as `tilt_error_rad`.
        value: the number; NaN means that it could not be measured.
        bound: what the value is held against; None if it only informs.
        sense: how value and bound compare, read as "value sense bound".
    """

    name: str
    value: float
    bound: float | None = None
    sense: Sense = "<="

    def __post_init__(self) -> None:
        """Refuse what could never be judged."""
        if not self.name:
            raise InputError("a metric needs a name.")
        if self.sense not in _TESTS:
            raise UnknownName("sense", self.sense, _TESTS)
        if self.bound is not None and math.isnan(self.bound):
            raise InputError(f"the bound of metric '{self.name}' is NaN.")

    @property
    def measured(self) -> bool:
        """Whether there is a value, which too short a run may not have."""
        return not math.isnan(self.value)

    @property
    def holds(self) -> bool:
        """Whether the bound is kept; without a bound yes, a NaN value never."""
        if not self.measured:
            return False
        return self.bound is None or _TESTS[self.sense](self.value, self.bound)

    @property
    def limit(self) -> str:
        """Sense and bound as text, such as "<= 0.001"; empty without a bound."""
        return "" if self.bound is None else f"{self.sense} {format_value(self.bound)}"

    @property
    def mark(self) -> str:
        """Either "ok", "FAIL" or "not measured"; empty if nothing could fail."""
        if not self.measured:
            return "not measured"
        if not self.holds:
            return "FAIL"
        return "" if self.bound is None else "ok"


def format_value(value: float) -> str:
    """Four significant digits, whole numbers below a thousand million in full."""
    if math.isnan(value):
        return "-"
    if math.isfinite(value) and value == round(value) and abs(value) < 1e9:
        return f"{value:.0f}"
    return f"{value:.4g}"


def verdict(metrics: Sequence[Metric]) -> str:
    """One line that says how the run ended, such as "2 of 9 bounds fail"."""
    missing = sum(not metric.measured for metric in metrics)
    failed = sum(not metric.holds for metric in metrics) - missing
    judged = sum(metric.bound is not None or not metric.holds for metric in metrics)
    if not judged:
        return "no bounds to hold"
    if failed:
        rest = f", {missing} not measured" if missing else ""
        return f"{failed} of {judged} bounds fail{rest}"
    if missing:
        return f"{missing} of {judged} bounds not measured, the others hold"
    return f"all {judged} bounds hold" if judged > 1 else "the one bound holds"


def table(metrics: Iterable[Metric]) -> str:
    """Aligned plain text, one line a metric: name, value, bound, mark."""
    rows = [(m.name, format_value(m.value), m.limit, m.mark) for m in _unique(metrics)]
    name, value, limit = (max((len(r[i]) for r in rows), default=0) for i in range(3))
    lines = (f"{a:<{name}}  {b:>{value}}  {c:<{limit}}  {d}" for a, b, c, d in rows)
    return "\n".join(line.rstrip() for line in lines)


def to_json(metrics: Iterable[Metric]) -> str:
    """A flat JSON object {name: value}; null where a value is not finite."""
    values = {
        metric.name: metric.value if math.isfinite(metric.value) else None
        for metric in _unique(metrics)
    }
    return json.dumps(values, indent=2, allow_nan=False) + "\n"


def _unique(metrics: Iterable[Metric]) -> list[Metric]:
    listed = list(metrics)
    counts = Counter(metric.name for metric in listed)
    twice = sorted(name for name, count in counts.items() if count > 1)
    if twice:
        raise InputError(f"metrics named more than once: {', '.join(twice)}.")
    return listed
