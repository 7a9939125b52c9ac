"""An audit as text for a terminal."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from importlib.metadata import version

from sims.audit.result import Audit, Check, Finding, value

__all__ = ["render"]

WIDTH = 88
LABEL = 11


def render(audit: Audit) -> str:
    """Verdict, checks, findings, in this order."""
    lines = [
        f"{audit.source}",
        f"Pinocchio {version('pin')} against MuJoCo {version('mujoco')}: "
        f"{_verdict(audit)}",
    ]
    if audit.checks:
        lines += ["", *_table(audit.checks)]
    for number, finding in enumerate(audit.findings, start=1):
        lines += ["", *_paragraph(number, finding)]
    return "\n".join(lines) + "\n"


def _verdict(audit: Audit) -> str:
    errors = sum(f.severity == "error" for f in audit.findings)
    counts = [_count(errors, "error"), _count(len(audit.findings) - errors, "note")]
    head = "THEY AGREE" if audit.agrees else "THEY DISAGREE"
    return f"{head} ({', '.join(counts)})"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


def _table(checks: tuple[Check, ...]) -> Iterator[str]:
    name = max(len(c.name) for c in checks)
    yield f"{'compared':<{name}}  {'worst':>8}  {'allowed':>8}  {'unit':<8}"
    for check in checks:
        verdict = "ok" if check.ok else "DIFFERS"
        worst, allowed = _size(check.worst), _size(check.tolerance)
        yield (
            f"{check.name:<{name}}  {worst:>8}  {allowed:>8}  "
            f"{check.unit:<8}  {verdict}"
        )
        if not check.ok:
            yield from _detail(check)


def _size(number: float) -> str:
    return f"{number:.0f}" if number == round(number, 0) else f"{number:.1e}"


def _detail(check: Check) -> Iterator[str]:
    values = f"Pinocchio {value(check.pin)}, MuJoCo {value(check.mujoco)}"
    if check.where:
        yield f"    at {check.where}" + (f": {values}" * (check.pin != check.mujoco))
    if check.because:
        yield f"    because of: {', '.join(check.because)}"


def _paragraph(number: int, finding: Finding) -> Iterator[str]:
    mark = "ERROR" if finding.severity == "error" else "note"
    yield f"{number}. {mark}: {finding.what}"
    advises = finding.pin or finding.mujoco
    for label, text in (
        ("where", finding.where),
        ("Pinocchio", finding.pin),
        ("MuJoCo", finding.mujoco),
        ("do" if advises else "says", finding.advice),
    ):
        if text:
            yield textwrap.fill(
                text,
                WIDTH,
                initial_indent=f"   {label:<{LABEL}}",
                subsequent_indent=" " * (LABEL + 3),
                break_long_words=False,
                break_on_hyphens=False,
            )
