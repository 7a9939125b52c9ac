"""Pinocchio and MuJoCo on one model file: every disagreement, by name.

A controller computes with Pinocchio's model, a simulation with MuJoCo's. Both read
the same file and may make different robots of it without a word. The audit loads the
file with each engine's own reader, compares what they compute on random states, and
finds the cause of a difference by mending one trait of Pinocchio's model at a time
until the difference is gone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import mujoco
import pinocchio as pin

from sims.audit.actuators import actuators
from sims.audit.causes import INERTIA, checks
from sims.audit.limits import limits, limits_checks
from sims.audit.load import Engines, load
from sims.audit.numbers import QUANTITIES, mujoco_numbers
from sims.audit.pair import pair
from sims.audit.passive import passive, passive_check
from sims.audit.result import Audit, Check, Finding, value
from sims.audit.structure import (
    BODIES,
    SECOND_ROOT,
    SKEWED,
    structure,
    structure_checks,
)
from sims.audit.traits import COUPLED, causes, inertia_cause, traits
from sims.audit.wbc import verdict, wbc_checks
from wbc.errors import InputError

__all__ = ["Audit", "Check", "Finding", "audit"]

# What a structural finding explains where no mend of the numbers does.
EXPLAINS = {
    SECOND_ROOT: ("total",),
    BODIES: ("total", "mass", "M", "h"),
    COUPLED: ("M", "h"),
    SKEWED: ("M", "h", "p", "R", "J", "drift"),
}


def audit(path: str | Path, *, states: int = 20, seed: int = 0) -> Audit:
    """Compare what Pinocchio and MuJoCo make of an MJCF or URDF file.

    Args:
        path: the file; it need not be one that `Robot` accepts.
        states: number of random states within the position limits, |v| <= 2 rad/s.
        seed: of the random states.

    Raises:
        ModelError: there is no such file, or it is neither MJCF nor URDF.
        InputError: fewer than one state.
    """
    if states < 1:
        raise InputError(f"states must be at least 1, got {states}.")
    path = Path(path)
    engines = load(path)
    findings, found = list(engines.findings), list[Check]()
    if engines.pin is not None and engines.mujoco is not None:
        more, found = _compare(engines, engines.pin, engines.mujoco, states, seed)
        findings += more
    if engines.mujoco is not None:
        own = wbc_checks(engines, engines.mujoco, states, seed)
        findings += _holes(own)
        found += _summary(own)
    findings.append(verdict(engines, path))
    findings.sort(key=lambda f: f.severity)  # "error" before "note", else as found
    return Audit(str(path), tuple(findings), tuple(found))


def _compare(
    engines: Engines,
    model: pin.Model,
    engine: mujoco.MjModel,
    states: int,
    seed: int,
) -> tuple[list[Finding], list[Check]]:
    both = pair(model, engine)
    q, v = both.states(states, seed)
    theirs = mujoco_numbers(both, q, v)
    findings = [
        *structure(engines, both),
        *passive(both, theirs),
        *traits(both),
        *limits(engines, both),
        *actuators(both),
    ]
    numbers = checks(both, q, v, theirs)
    needed = {name for check in numbers for name in check.because}
    numbers = _attribute(engines, numbers, {f.what for f in findings})
    findings = [*causes(engines, both, needed), *findings, *_unexplained(numbers)]
    return findings, [
        *structure_checks(both),
        *numbers,
        passive_check(both, theirs),
        *limits_checks(both),
    ]


def _attribute(engines: Engines, numbers: list[Check], known: set[str]) -> list[Check]:
    """Name the finding behind each difference, mended or structural."""
    attributed = []
    for key, check in zip(QUANTITIES, numbers, strict=True):
        mended = [inertia_cause(engines) if b == INERTIA else b for b in check.because]
        tree = [w for w, keys in EXPLAINS.items() if w in known and key in keys]
        because = () if check.ok else tuple(mended or tree)
        attributed.append(replace(check, because=because))
    return attributed


def _unexplained(numbers: list[Check]) -> Iterator[Finding]:
    for check in numbers:
        if not check.ok and not check.because:
            advice = (
                "No trait that this audit knows explains it: look at the elements "
                "named here, and cut the file down until the difference is gone."
            )
            yield _difference(check, f"{check.name}: unexplained", advice)


def _difference(check: Check, what: str, advice: str) -> Finding:
    values = value(check.pin, check.unit), value(check.mujoco, check.unit)
    return Finding(what, check.where, *values, advice, "error")


def _holes(own: list[Check]) -> Iterator[Finding]:
    wrong = [check for check in own if not check.ok]
    if wrong:
        advice = (
            "wbc's reader lets this file pass and gets it wrong, so its controller "
            "would act on another robot. Change the file, and please report it."
        )
        where = "; ".join(f"{check.name} ({check.where})" for check in wrong)
        worst = max(wrong, key=lambda check: check.worst)
        finding = _difference(worst, "wbc's own model differs", advice)
        yield replace(finding, where=where, pin=f"wbc: {finding.pin}")


def _summary(own: list[Check]) -> list[Check]:
    """One line for wbc's model: its worst check relative to the tolerance."""
    if not own:
        return []
    worst = max(own, key=lambda c: c.worst / c.tolerance)
    return [
        replace(worst, name="wbc's own model", where=f"{worst.name}, {worst.where}")
    ]
