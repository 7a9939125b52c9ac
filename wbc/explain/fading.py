"""Which tasks come and go while a hierarchy hands over to another one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

if TYPE_CHECKING:
    from wbc.hierarchy import Hierarchy

__all__ = ["Fading", "fading"]

WHOLE = 1.0 - 1e-9
"""A task with so much of the torque is there."""


@final
@dataclass(frozen=True, slots=True)
class Fading:
    """A change of hierarchy that is under way (`Controller.change`).

    Attributes:
        share: of the new hierarchy in the torque, below 1.
        coming: (name, share) of the tasks that have not been there all the time.
        going: (name, share) of the tasks that the new hierarchy does not have.
    """

    share: float
    coming: tuple[tuple[str, float], ...]
    going: tuple[tuple[str, float], ...]

    def __str__(self) -> str:
        said = f"a ramp is under way: the new hierarchy has a share of {self.share:.1%}"
        for word, tasks in (("fades in", self.coming), ("fades out", self.going)):
            said += "".join(f"; '{n}' {word}, at {share:.1%}" for n, share in tasks)
        return said


def fading(parts: Sequence[tuple[Hierarchy, float]]) -> Fading | None:
    """What a blend of hierarchies, oldest first, with their shares, means for tasks.

    None where there is nothing to blend.
    """
    if len(parts) < 2:
        return None
    newest, share = parts[-1]
    names: dict[int, str] = {}
    shares: dict[int, float] = {}
    for hierarchy, part in parts:
        for task in hierarchy.tasks():
            names[id(task)] = task.name
            shares[id(task)] = shares.get(id(task), 0.0) + part
    wanted = {id(task) for task in newest.tasks()}
    partial = {key: value for key, value in shares.items() if value < WHOLE}
    return Fading(
        share,
        tuple((names[k], x) for k, x in partial.items() if k in wanted),
        tuple((names[k], x) for k, x in partial.items() if k not in wanted),
    )
