"""What the response of the optimum says about every task and every bound in force."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from wbc.arrays import Array
from wbc.certificate import Certificate
from wbc.explain.data import (
    ActiveBound,
    Blocker,
    Explanation,
    Reason,
    Side,
    TaskExplanation,
)
from wbc.explain.fading import Fading, fading
from wbc.explain.response import NEGLIGIBLE, Response, Tick, responses
from wbc.linalg import factorise, norm
from wbc.stack import Stack
from wbc.task import MotionTask
from wbc.term import Term

if TYPE_CHECKING:
    from wbc.transition import Transition

__all__ = ["OPTIMAL", "explain"]

OPTIMAL = 1e-6
"""A level whose proof leaves more than this is not optimal."""


def explain(
    stack: Stack, vdot: Array, certificate: Certificate, ramp: Transition | None = None
) -> Explanation:
    """Explain what joint accelerations vdot (n,) make of the stack's present rows.

    They come from a blend of hierarchies while there is a ramp from one to another.
    """
    change = None if ramp is None else fading(ramp.parts)
    tick = Tick(stack, vdot)
    levels = list(responses(tick))
    proofs = [proof.residual for proof in certificate.levels]
    tasks = tuple(
        _task(tick, term, levels[term.level], proofs[term.level], change)
        for term in stack.terms
    )
    if proofs[-1] > OPTIMAL:  # another notion of least than ours: it pays no price
        levels[-1].slope[:] = 0.0
    bounds = tuple(_bounds(tick, levels))
    return Explanation(tasks, bounds, len(stack.levels), change)


def _task(
    tick: Tick, term: Term, level: Response, proof: float, change: Fading | None
) -> TaskExplanation:
    where, raw = term.where, term.rows
    value = raw.A @ (tick.torque if term.task.space == "torque" else tick.vdot)
    wanted = np.clip(value, raw.lower, raw.upper)
    missed = tick.missed[where]
    met = not missed.any()
    units = term.task.wish_units(len(term.names))
    lost = 0.0 if met else _lost(tick, where) / term.weight
    blockers = () if met else tuple(_blockers(tick, term, level))
    return TaskExplanation(
        name=term.task.name,
        level=term.level + 1,
        unit=units[0] if len(set(units)) == 1 else "",
        rows=term.names,
        units=units,
        met=met,
        missing=np.where(tick.equal[where] | missed, wanted - value, 0.0),
        wanted=wanted,
        error=_error(term),
        error_unit=term.task.unit,
        lost=lost,
        reasons=() if met else _reasons(term, blockers, lost, proof, change),
        blockers=blockers,
        unique=level.unique,
        proof=proof,
    )


def _error(term: Term) -> float | None:
    if not isinstance(term.task, MotionTask):
        return None
    return float(np.linalg.norm(term.rows.error))


def _lost(tick: Tick, where: slice) -> float:
    """What of the weighted slack no motion at all could remove from these rows."""
    wish = tick.wish[where]
    A, slack = tick.A[where][wish], tick.slack[where][wish]
    U = factorise(A, norm(A)).U
    lost = float(np.linalg.norm(slack - U @ (U.T @ slack)))
    return lost if lost > float(tick.near[where].max()) else 0.0


def _blockers(tick: Tick, term: Term, level: Response) -> Iterator[Blocker]:
    where, weights = term.where, tick.stack.weights
    length = float(np.linalg.norm(tick.slack[where]))
    slope = tick.slope(where, level.R) / length
    slope[where] = 0.0
    strength = np.abs(slope) * tick.norm
    tiny = NEGLIGIBLE * norm(tick.A[where])
    tiny += 0.01 * norm(tick.A[where]) * float(tick.near[where].max()) / length
    for j in np.argsort(-strength, kind="stable").tolist():
        if strength[j] <= tiny:
            return
        owner, i = tick.owner[j]
        towards = -int(np.sign(slope[j]))
        side = int(tick.side[j])
        yield Blocker(
            level=owner.level + 1,
            task=owner.task.name,
            row=owner.names[i],
            unit=owner.task.wish_units(len(owner.names))[i],
            side=_side(tick, j),
            towards=towards,
            relief=float(abs(slope[j]) * weights[j] / term.weight),
            price=float(-towards * level.slope[j] * weights[j]),
            held_for=int(level.held[j]) if side == -towards else 0,
        )


def _side(tick: Tick, j: int) -> Side:
    if tick.equal[j]:
        return "equality"
    if tick.missed[j]:
        return "cannot be met itself"
    return "upper" if tick.side[j] > 0 else "lower"


def _reasons(
    term: Term,
    blockers: tuple[Blocker, ...],
    lost: float,
    proof: float,
    change: Fading | None,
) -> tuple[Reason, ...]:
    causes = {_cause(blocker, term.level + 1) for blocker in blockers}
    order: tuple[Reason, ...] = ("bounds", "tasks", "conflict")
    found: list[Reason] = [reason for reason in order if reason in causes]
    if lost > 0.0 or not (found or proof > OPTIMAL):
        found.append("lost")
    if proof > OPTIMAL:
        found.append("resolver" if change is None else "ramp")
    return tuple(found)


def _cause(blocker: Blocker, level: int) -> Reason:
    """What a blocker stands for, seen from a task of this level."""
    if level in (blocker.level, blocker.held_for):
        return "conflict"
    if blocker.side == "equality" or blocker.held_for:
        return "tasks"
    return "bounds"


def _bounds(tick: Tick, levels: list[Response]) -> Iterator[ActiveBound]:
    for j in np.flatnonzero(tick.side).tolist():
        term, i = tick.owner[j]
        prices = [-tick.side[j] * k.slope[j] * tick.stack.weights[j] for k in levels]
        yield ActiveBound(
            level=term.level + 1,
            task=term.task.name,
            row=term.names[i],
            unit=term.task.wish_units(len(term.names))[i],
            side=_side(tick, j),
            payers=tuple((k, float(p)) for k, p in enumerate(prices, 1) if p > 0.0),
        )
