"""What an audit hands back: compared quantities and named disagreements."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, final

__all__ = ["Audit", "Check", "Finding", "listed", "named", "once", "value"]

LISTED = 6


def value(number: float, unit: str = "") -> str:
    """Six digits; infinity is how the engines write "no limit"."""
    return "no limit" if math.isinf(number) else f"{number:.6g} {unit}".rstrip()


PLURAL = {"body": "bodies", "joint": "joints"}


def once(names: Sequence[str]) -> list[str]:
    """The names without repetition, in order."""
    return list(dict.fromkeys(names))


def named(kind: str, names: Sequence[str]) -> str:
    """Such as "joint a" or "joints a, b"."""
    return f"{PLURAL[kind] if len(names) > 1 else kind} {listed(names)}"


def listed(names: Sequence[str]) -> str:
    """Names separated by commas, a long list cut short with its count."""
    shown = ", ".join(names[:LISTED])
    rest = len(names) - LISTED
    return f"{shown} and {rest} more" if rest > 0 else shown


@final
@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that the engines treat differently, or that only one of them knows.

    Attributes:
        what: short name of the trait, such as "gravity" or "second root dropped".
        where: joint, body or frame names, and which entry.
        pin: what Pinocchio makes of it.
        mujoco: what MuJoCo makes of it.
        advice: what to do.
        severity: "error" if the models disagree, "note" if the models agree and a
            user should know all the same.
    """

    what: str
    where: str
    pin: str
    mujoco: str
    advice: str
    severity: Literal["error", "note"]


@final
@dataclass(frozen=True, slots=True)
class Check:
    """One compared quantity: its worst difference over all states and entries.

    Attributes:
        name: the quantity.
        worst: largest absolute difference [unit]; infinite where only one engine has
            a bound.
        tolerance: largest difference that counts as equal [unit].
        unit: of both.
        where: entry of the worst difference, by names; empty if all are equal.
        pin: Pinocchio's value there [unit].
        mujoco: MuJoCo's value there [unit].
        because: what makes the difference vanish, as names of findings.
    """

    name: str
    worst: float
    tolerance: float
    unit: str
    where: str = ""
    pin: float = 0.0
    mujoco: float = 0.0
    because: tuple[str, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether the engines agree; NaN never does."""
        return self.worst <= self.tolerance


@final
@dataclass(frozen=True, slots=True)
class Audit:
    """The comparison of Pinocchio and MuJoCo on one model file.

    Attributes:
        source: path of the file.
        findings: errors first, then notes.
        checks: the compared quantities; empty if an engine cannot read the file.
    """

    source: str
    findings: tuple[Finding, ...]
    checks: tuple[Check, ...]

    @property
    def agrees(self) -> bool:
        """Whether no finding is an error."""
        return not any(f.severity == "error" for f in self.findings)

    def text(self) -> str:
        """A table of the checks and a paragraph a finding, for a terminal."""
        from sims.audit.text import render

        return render(self)
