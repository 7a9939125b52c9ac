"""A six-axis "Racer-class" industrial arm: 7 kg payload, 1.4 m reach.

Joints ``joint1`` to ``joint6``, bodies ``base`` and ``link1`` to ``link6``, site
``flange`` with z out of the flange. The top of ``racer.xml`` says what the frames are
and which numbers are assumed.
"""

from __future__ import annotations

from importlib.resources import files

from robots import tools
from robots.assembly import mount
from wbc import Robot

__all__ = ["load", "mjcf"]


def mjcf(tool: str | None = "torch") -> str:
    """Return the MJCF text of the arm, the same for MuJoCo and for Pinocchio.

    Args:
        tool: name of a tool of ``robots.tools`` to mount at the flange, or None for the
            bare arm.

    Raises:
        UnknownName: there is no tool of that name.
    """
    arm = files(__name__).joinpath("racer.xml").read_text(encoding="utf-8")
    return arm if tool is None else mount(arm, tools.mjcf(tool), at="flange")


def load(tool: str | None = "torch") -> Robot:
    """Load the arm as a ``Robot``, with the limits and home posture of its model.

    Args:
        tool: name of a tool of ``robots.tools``, or None for the bare arm.

    Raises:
        UnknownName: there is no tool of that name.
    """
    return Robot.from_mjcf(mjcf(tool), name="racer")
