"""Random stacks under all resolvers: what each kind of stack does to each of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias, final

import numpy as np

from sims.compare.indicators import Indicators, effort, measure, reference
from sims.compare.locking import PlainLocking
from sims.compare.problems import FAMILIES, Family, Problem, problems
from sims.compare.switching import limit_jump, task_jump
from sims.resolvers import FIXED, make_resolver
from wbc import Resolver
from wbc.arrays import Array

__all__ = ["LOCKING", "Finding", "Study", "study"]

COUNT = 20
"""Problems of each family."""
SWEPT = 3
"""Of them, so many are swept into their limits."""
LOCKING = PlainLocking.name
Show: TypeAlias = Callable[[str], None]


@final
@dataclass(frozen=True, slots=True)
class Finding:
    """One family under one resolver.

    Attributes:
        family, resolver: names.
        leak: worst.
        gap: worst.
        typical_gap: median.
        violation: worst.
        gauss, acceleration, torque: median, relative to the optimum's.
        limit_jump: worst of the problems that were swept, NaN without limits.
        task_jump: median.
        microseconds: median of a solver that starts cold [us].
        failures: problems without an answer, or with one given up before the end.
    """

    family: str
    resolver: str
    leak: float
    gap: float
    typical_gap: float
    violation: float
    gauss: float
    acceleration: float
    torque: float
    limit_jump: float
    task_jump: float
    microseconds: float
    failures: int


@final
@dataclass(frozen=True, slots=True, eq=False)
class Study:
    """All findings.

    Attributes:
        seed: of the problems.
        count: problems of each family.
        families: what they are.
        resolvers: names, in order.
        findings: one for each pair.
        proof: worst residual of the certificates of the optima compared with.
    """

    seed: int
    count: int
    families: tuple[Family, ...]
    resolvers: tuple[str, ...]
    findings: tuple[Finding, ...]
    proof: float

    def of(
        self, resolver: str, family: str | None = None, limits: bool | None = None
    ) -> list[Finding]:
        """Findings of a resolver: of one family, or of those with or without limits."""
        kinds = {f.name: f.limits > 0.0 for f in self.families}
        return [
            f
            for f in self.findings
            if f.resolver == resolver
            and family in (None, f.family)
            and limits in (None, kinds[f.family])
        ]

    def worst(self, indicator: str, resolver: str, limits: bool | None = None) -> float:
        """Largest value of an indicator; there must be such families."""
        found = [getattr(f, indicator) for f in self.of(resolver, limits=limits)]
        return float(np.max(found))


def study(
    seed: int = 0,
    count: int = COUNT,
    names: Sequence[str] = (),
    families: Sequence[Family] = FAMILIES,
    show: Show = lambda _: None,
) -> Study:
    """Resolve random problems of every family by every resolver.

    Args:
        seed: of everything random.
        count: problems of each family.
        names: of resolvers; those of the papers, the weighted QP and the strict one by
            default. Plain locking is always added.
        families: kinds of problems.
        show: told of every family as it begins.
    """
    resolvers = {name: make_resolver(name) for name in names or FIXED}
    resolvers[LOCKING] = PlainLocking()
    findings: list[Finding] = []
    proof = 0.0
    for family in families:
        show(family.name)
        cases = [_Case(p, *reference(p)) for p in problems(family, count, seed)]
        proof = max(proof, *(case.proof for case in cases))
        findings += [
            _finding(family, name, resolver, cases, np.random.default_rng(seed))
            for name, resolver in resolvers.items()
        ]
    return Study(seed, count, tuple(families), tuple(resolvers), tuple(findings), proof)


@dataclass(frozen=True, slots=True, eq=False)
class _Case:
    """A problem, its optimum vdot (n,), and the residual of the proof of that."""

    problem: Problem
    best: Array
    proof: float


def _finding(
    family: Family,
    name: str,
    resolver: Resolver,
    cases: list[_Case],
    rng: np.random.Generator,
) -> Finding:
    found = [measure(case.problem, resolver, case.best, rng) for case in cases]
    ideal = [effort(case.problem, case.best) for case in cases]
    ratios = [
        np.array([f.gauss, f.acceleration, f.torque]) / best
        for f, best in zip(found, ideal, strict=True)
    ]
    gauss, acceleration, torque = np.nanmedian(ratios, axis=0)
    swept = [case.problem for case in cases[: SWEPT * (family.limits > 0.0)]]
    return Finding(
        family=family.name,
        resolver=name,
        leak=_worst(found, "leak"),
        gap=_worst(found, "gap"),
        typical_gap=float(np.nanmedian([f.gap for f in found])),
        violation=_worst(found, "violation"),
        gauss=float(gauss),
        acceleration=float(acceleration),
        torque=float(torque),
        limit_jump=max((limit_jump(p, resolver) for p in swept), default=np.nan),
        task_jump=float(np.median([task_jump(c.problem, resolver) for c in cases])),
        microseconds=float(np.nanmedian([f.seconds for f in found]) * 1e6),
        failures=sum(f.failed for f in found),
    )


def _worst(found: list[Indicators], indicator: str) -> float:
    return float(np.nanmax([getattr(f, indicator) for f in found]))
