"""What MuJoCo's step does and the controller's model does not contain, in sentences."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from wbc.mjcf.limits import is_motor, torque_ranges
from wbc.mjcf.source import Source, label

__all__ = ["notes"]


def notes(source: Source) -> Iterator[str]:
    """One sentence for each such trait of a text that was not refused."""
    yield from _losses(source)
    for actuator in source.root.iterfind("actuator/*"):
        joint = actuator.get("joint") or actuator.get("jointinparent")
        if joint is None or not is_motor(source, actuator):
            yield (
                f"{label(actuator)} is not a motor on a joint: its control is not a "
                "torque, and what it does by itself is not in the controller's model"
            )
    for name, (lower, upper) in torque_ranges(source).items():
        if -lower != upper:
            yield (
                f"joint '{name}' can be driven from {lower:.6g} to {upper:.6g}; the "
                f"controller keeps within +-{min(-lower, upper):.6g}, the smaller side"
            )
    if source.root.find("equality/*") is not None:
        yield "equality constraints of the file are not part of the controller's model"


def _losses(source: Source) -> Iterator[str]:
    elements = [
        *source.joints(),
        *source.root.iterfind("tendon/*"),
        *source.root.iterfind("actuator/*"),
    ]
    for element in elements:
        for key in ("damping", "frictionloss"):
            if np.any(source.floats(element, key)):
                yield (
                    f"{label(element)} has {key}, which MuJoCo applies and the "
                    "controller's model does not contain"
                )
    for tendon in source.root.iterfind("tendon/*"):
        if source.limits(tendon):
            yield (
                f"{label(tendon)} has a range, which MuJoCo holds and the "
                "controller's model does not contain"
            )
