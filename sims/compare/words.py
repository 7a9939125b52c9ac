"""What the numbers of a study mean, every one of them taken from the data."""

from __future__ import annotations

from sims.compare.study import LOCKING, Study

__all__ = ["explain"]


def explain(study: Study) -> str:
    """Data first, then meaning; paragraphs for a report."""
    parts = [
        _what(study),
        _soundness(study),
        _optimality(study),
        _limits(study),
        _effort(study),
        _smoothness(study),
        _cost(study),
    ]
    return "\n\n".join(part for part in parts if part)


def _what(study: Study) -> str:
    families = len(study.families)
    return (
        f"{study.count} random stacks in each of {families} families, seed "
        f"{study.seed}, each resolved by {len(study.resolvers)} resolvers. Leak: what "
        "changes for a level when one below it wants something else. Gap: distance of "
        "a level from its lexicographic optimum. Both are relative, so 1 means as much "
        "as was asked for. Optima come from a cascade of small QPs, which on "
        "equalities is WBCF's own recursion (hence its exact zeros), and are proven: "
        f"the worst residual of their certificates is {study.proof:.0e}. Efforts are "
        "relative to the optimum's; a jump is what stays of a step of the torque "
        "however finely it is divided, relative to "
        "|tau - h|."
    )


def _soundness(study: Study) -> str:
    leaks = [f"{name} {study.worst('leak', name):.0e}" for name in study.resolvers]
    free = [
        f"{name} {study.worst('leak', name, limits=False):.0e}"
        for name in study.resolvers
    ]
    return (
        f"Sound. Worst leak without limits: {', '.join(free)}. With limits too: "
        f"{', '.join(leaks)}. Projection keeps lower levels out of higher ones by "
        "construction. A weighted sum has no levels, only prices: as soon as tasks "
        "compete, the lower one buys its share. A projection that decides which limits "
        "to hold after having resolved all levels is sound no more, because lower "
        "levels have a say in that decision."
    )


def _optimality(study: Study) -> str:
    gaps = [
        f"{name} {study.worst('gap', name, limits=False):.0e}"
        for name in study.resolvers
    ]
    return (
        f"Optimal, no limits active. Worst gap: {', '.join(gaps)}. WBCF and TSID "
        "correct each level for what those above do already, and invert what is left "
        "to it; that is lexicographic least squares, conflicts and singularities "
        "included. The UF solves each task as if alone and projects afterwards: what "
        "the projection takes away is not asked for again, even where all tasks could "
        "be met."
    )


def _limits(study: Study) -> str:
    if not any(family.limits > 0.0 for family in study.families):
        return ""
    gaps = [
        f"{name} {study.worst('gap', name, limits=True):.0e}"
        for name in study.resolvers
    ]
    text = f"Optimal, limits active. Worst gap: {', '.join(gaps)}."
    if LOCKING in study.resolvers:
        text += (
            " Plain locking, the projection papers' way, keeps limits but holds the "
            "wrong ones: no law says which to let go."
        )
    if {"nullspace", "hqp"} <= set(study.resolvers):
        slower = _times(study, "nullspace", "hqp", limits=True)
        text += (
            " NullSpace here is more than the published law: it saturates and releases "
            "by the multipliers of a QP, and takes the set from the strict QP where "
            "that goes round in circles. So its gap is the QP's, at "
            f"{slower:.0f} times its time."
        )
    return text


def _effort(study: Study) -> str:
    if not {"nullspace", "nullspace:tsid"} <= set(study.resolvers):
        return ""
    pairs = [
        f"{f.family} {f.gauss:.2f} and {f.acceleration:.2f}"
        for f in study.of("nullspace:tsid", limits=False)
    ]
    return (
        "Effort. TSID's Gauss effort (tau - h)^T M^-1 (tau - h) and |vdot|, relative "
        f"to those of WBCF and the strict QP: {', '.join(pairs)}. Task errors are the "
        "same; each law makes its own norm least in the motion that no task uses. Less "
        "effort of the UF is no merit: it leaves tasks unmet."
    )


def _smoothness(study: Study) -> str:
    limited = [family.name for family in study.families if family.limits > 0.0]
    if not limited:
        return ""
    jumps = [
        f"{name} {study.worst('limit_jump', name, limits=True):.0e}"
        for name in study.resolvers
    ]
    return (
        "Smooth. Worst jump while growing targets drive the robot into its limits: "
        f"{', '.join(jumps)}. The optimum is a continuous function of targets as long "
        "as ranks stay; laws that switch rows by other rules jump. Removing a task "
        "jumps under every resolver: that is what Controller.change ramps."
    )


def _cost(study: Study) -> str:
    if "hqp" not in study.resolvers:
        return ""
    ratios = [
        f"{name} {_times(study, name, 'hqp', limits=False):.1f}"
        for name in study.resolvers
        if name != "hqp"
    ]
    return (
        "Time without limits, relative to the compiled strict QP, starting cold: "
        f"{', '.join(ratios)}. That is this implementation (plain locking in numpy, "
        "the others compiled), not the laws' count of operations."
    )


def _times(study: Study, name: str, other: str, *, limits: bool) -> float:
    """Largest ratio of two resolvers' times over the families."""
    ours, theirs = study.of(name, limits=limits), study.of(other, limits=limits)
    pairs = zip(ours, theirs, strict=True)
    return max(a.microseconds / b.microseconds for a, b in pairs)
