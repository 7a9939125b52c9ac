"""Position and torque limits and gravity as MuJoCo takes them from the text.

Pinocchio shifts a range by the joint's ref, although q means the same to both; it
takes a slide's metres for degrees, keeps the range of a joint that is not limited, and
reads neither actuators nor gravity.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from typing import Final

import numpy as np

from wbc.arrays import Array
from wbc.errors import ModelError
from wbc.mjcf.source import Source, label

__all__ = ["gravity", "is_motor", "position_limits", "torque_limits", "torque_ranges"]

Range = tuple[float, float]

ANY: Final[Range] = (-np.inf, np.inf)
MOTOR: Final = {"dyntype": "none", "gaintype": "fixed", "biastype": "none"}


def gravity(source: Source) -> Array:
    """Gravity (3,) [m/s^2]: of several options the last, none if a flag disables it."""
    values, enabled = np.array([0.0, 0.0, -9.81]), True
    for option in source.root.iterfind("option"):
        if "gravity" in option.attrib:
            values = source.floats(option, "gravity", size=3)
        for flag in option.iterfind("flag"):
            enabled = flag.get("gravity", "enable" if enabled else "") == "enable"
    return values if enabled else np.zeros(3)


def position_limits(source: Source) -> dict[str, Range]:
    """Joint name -> lower and upper limit [rad or m], infinite where there is none.

    Raises:
        ModelError: a limit without a range, or the like.
    """
    found = {}
    for joint in source.joints():
        lower, upper = source.limits(joint) or ANY
        hinge = (source.get(joint, "type") or "hinge") == "hinge"
        if hinge and source.degrees:
            lower, upper = float(np.radians(lower)), float(np.radians(upper))
        found[joint.get("name", "")] = (lower, upper)
    return found


def torque_limits(source: Source) -> dict[str, float]:
    """Joint name -> torque that its motors can apply either way [Nm or N].

    A range that is not symmetric counts with its smaller side. Joints without any
    limit are absent.

    Raises:
        ModelError: motors that push a joint one way only.
    """
    limits = {}
    for name, (lower, upper) in torque_ranges(source).items():
        if lower >= 0 or upper <= 0:
            raise ModelError(
                f"the motors of joint '{name}' push one way only ({lower:.6g} to "
                f"{upper:.6g}): give them a ctrlrange with both signs."
            )
        if np.isfinite(limit := min(-lower, upper)):
            limits[name] = limit
    return limits


def torque_ranges(source: Source) -> dict[str, Range]:
    """Joint name -> least and largest torque of its actuators in sum [Nm or N].

    Raises:
        ModelError: a limit without a range, or the like.
    """
    ranges: dict[str, Range] = {}
    for name, actuator in _drivers(source):
        lower, upper = _actuator_range(source, actuator)
        before = ranges.get(name, (0.0, 0.0))
        ranges[name] = (before[0] + lower, before[1] + upper)
    for joint in source.joints():
        total = source.limits(joint, "actuatorfrc")
        if total is not None:
            name = joint.get("name", "")
            ranges[name] = _within(ranges.get(name, ANY), total)
    return ranges


def _drivers(source: Source) -> Iterator[tuple[str, ET.Element]]:
    names = {joint.get("name", "") for joint in source.joints()}
    for actuator in source.root.iterfind("actuator/*"):
        name = actuator.get("joint") or actuator.get("jointinparent")
        if name in names:
            yield name, actuator
        elif name is not None:
            raise ModelError(f"{label(actuator)} drives joint '{name}': no such joint.")


def is_motor(source: Source, actuator: ET.Element) -> bool:
    """Whether an actuator's force is its gain times its control."""
    return all(
        (source.get(actuator, key) or value) == value for key, value in MOTOR.items()
    )


def _actuator_range(source: Source, actuator: ET.Element) -> Range:
    """Torque at the joint; the control of a servo is no force and limits none."""
    bounds = source.limits(actuator, "force") or ANY
    control = source.limits(actuator, "ctrl")
    if control is not None and is_motor(source, actuator):
        gain = source.floats(actuator, "gainprm", "1")[0]
        bounds = _within(bounds, _scaled(control, float(gain)))
    gear = source.floats(actuator, "gear", "1")[0]
    return _scaled(bounds, float(gear))


def _scaled(bounds: Range, factor: float) -> Range:
    if factor == 0.0:
        return 0.0, 0.0  # not nan, which infinity times 0 is
    low, high = bounds[0] * factor, bounds[1] * factor
    return min(low, high), max(low, high)


def _within(a: Range, b: Range) -> Range:
    return max(a[0], b[0]), min(a[1], b[1])
