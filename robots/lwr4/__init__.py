"""The KUKA LWR 4+: a seven-axis light-weight arm with torque sensors, 7 kg payload.

Joints ``joint1`` to ``joint7``, bodies ``base`` and ``link1`` to ``link7``, site
``flange`` with z out of the flange. The top of ``lwr4.xml`` says what the frames are
and where the numbers come from.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from importlib.resources import files
from typing import Final

from robots import tools
from robots.assembly import mount
from wbc import Robot
from wbc.checks import flag

__all__ = ["COULOMB", "VISCOUS", "load", "mjcf"]

COULOMB: Final = (11.9, 11.5, 8.98, 8.35, 8.31, 4.72, 6.04)
"""Dry friction of the joints [Nm], identified by Jubien, Gautier and Janot (2014)."""
VISCOUS: Final = (14.4, 15.3, 6.55, 11.0, 4.29, 2.26, 1.6)
"""Viscous friction of the joints [Nm s/rad], from the same identification."""


def mjcf(
    tool: str | None = "knife", *, rotors: bool = True, friction: bool = False
) -> str:
    """Return the MJCF text of the arm, the same for MuJoCo and for Pinocchio.

    Args:
        tool: name of a tool of ``robots.tools`` to mount at the flange, or None for the
            bare arm.
        rotors: whether M contains the reflected inertia of the motors' rotors, which is
            larger than that of the links at most joints.
        friction: whether the simulated joints rub. No controller's model contains it.

    Raises:
        UnknownName: there is no tool of that name.
        InputError: `rotors` or `friction` is not True or False.
    """
    flag(rotors=rotors, friction=friction)
    arm = files(__name__).joinpath("lwr4.xml").read_text(encoding="utf-8")
    arm = _with_joints(arm, rotors, friction)
    return arm if tool is None else mount(arm, tools.mjcf(tool), at="flange")


def load(
    tool: str | None = "knife", *, rotors: bool = True, friction: bool = False
) -> Robot:
    """Load the arm as a ``Robot``, with the limits and home posture of its model.

    Args:
        tool: name of a tool of ``robots.tools``, or None for the bare arm.
        rotors: as for ``mjcf``.
        friction: as for ``mjcf``; the robot's notes then say so.

    Raises:
        UnknownName: there is no tool of that name.
    """
    return Robot.from_mjcf(mjcf(tool, rotors=rotors, friction=friction), name="lwr4")


def _with_joints(arm: str, rotors: bool, friction: bool) -> str:
    root = ET.fromstring(arm)
    for joint, dry, viscous in zip(root.iter("joint"), COULOMB, VISCOUS, strict=True):
        if not rotors:
            del joint.attrib["armature"]
        if friction:
            joint.set("frictionloss", str(dry))
            joint.set("damping", str(viscous))
    return ET.tostring(root, encoding="unicode")
