"""A Panda-class seven-axis arm, once or several times, as one URDF for everybody."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

__all__ = ["Arm", "arms_urdf"]

SPACING = 1.2  # between two bases, along y [m]


class Link(NamedTuple):
    """A joint and the solid cylinder behind it, in the joint's frame (modified DH)."""

    twist: float  # alpha [deg]
    offset: float  # r, along the joint's axis [m]
    limit: float  # [deg]
    speed: float  # [rad/s]
    torque: float  # [Nm]
    mass: float  # [kg]
    com: tuple[float, float, float]  # [m]
    length: float  # [m]
    radius: float  # [m]
    axis: int  # of the cylinder


LINKS = (
    Link(0, 0.3105, 170, 1.92, 176, 2.35, (0, -0.020, -0.090), 0.24, 0.060, 2),
    Link(90, 0, 120, 1.92, 176, 2.70, (0, 0.110, 0.010), 0.24, 0.060, 1),
    Link(-90, 0.40, 170, 2.23, 100, 2.40, (0, 0.020, -0.090), 0.23, 0.060, 2),
    Link(-90, 0, 120, 2.23, 100, 2.05, (0, -0.100, 0.010), 0.23, 0.060, 1),
    Link(90, 0.39, 170, 3.56, 100, 1.70, (0, 0.020, -0.120), 0.20, 0.055, 2),
    Link(90, 0, 120, 3.21, 38, 1.60, (0, 0.0045, 0), 0.12, 0.060, 2),
    Link(-90, 0, 170, 3.21, 38, 0.30, (0, 0, 0.060), 0.04, 0.040, 2),
)
TOOL = Link(0, 0.078, 0, 0, 0, 1.0, (0, 0, 0.05), 0.10, 0.050, 2)
TIP = 0.12  # from the flange to the tip [m]
HOME = (0.2, 0.6, 0.0, -1.4, 0.3, 0.9, 0.0)  # [rad]
BRAKING = (30.0, 30.0, 45.0, 45.0, 60.0, 60.0, 60.0)  # [rad/s^2]


class Arm(NamedTuple):
    """What goes with the URDF of `count` arms.

    Attributes:
        urdf: the text.
        tips: name of the tip's frame of every arm.
        home: (n,) [rad].
        acceleration: (n,) limits [rad/s^2].
    """

    urdf: str
    tips: list[str]
    home: list[float]
    acceleration: list[float]


def arms_urdf(count: int = 1) -> Arm:
    """`count` arms side by side on one base."""
    parts = ['<link name="base"/>']
    for arm in range(count):
        parts += _arm(f"a{arm}_", (0.0, SPACING * arm, 0.0))
    return Arm(
        '<robot name="arms">\n' + "\n".join(parts) + "\n</robot>\n",
        [f"a{arm}_tip" for arm in range(count)],
        [*HOME] * count,
        [*BRAKING] * count,
    )


def _arm(prefix: str, base: tuple[float, float, float]) -> list[str]:
    parts, parent = [], "base"
    for j, link in enumerate(LINKS, 1):
        alpha, r = np.radians(link.twist), link.offset
        origin = np.array([0.0, -r * np.sin(alpha), r * np.cos(alpha)])
        origin += base if j == 1 else 0.0
        child, limit = f"{prefix}link{j}", np.radians(link.limit)
        parts += [
            f'<joint name="{prefix}joint{j}" type="revolute">',
            f'  <parent link="{parent}"/><child link="{child}"/>',
            f'  <origin xyz="{_text(origin)}" rpy="{alpha:.12g} 0 0"/>',
            '  <axis xyz="0 0 1"/>',
            f'  <limit lower="{-limit:.12g}" upper="{limit:.12g}" '
            f'velocity="{link.speed}" effort="{link.torque}"/>',
            "</joint>",
            _link(child, link),
        ]
        parent = child
    flange, tip = (0, 0, TOOL.offset), (0, 0, TIP)
    parts += [_fixed(parent, f"{prefix}tool", flange), _link(f"{prefix}tool", TOOL)]
    parts += [_fixed(f"{prefix}tool", f"{prefix}tip", tip)]
    return [*parts, f'<link name="{prefix}tip"/>']


def _link(name: str, link: Link) -> str:
    """A link of the inertia of a solid cylinder."""
    across = link.mass * (3 * link.radius**2 + link.length**2) / 12
    moments = [across] * 3
    moments[link.axis] = link.mass * link.radius**2 / 2
    xx, yy, zz = (f"{moment:.12g}" for moment in moments)
    return (
        f'<link name="{name}"><inertial><origin xyz="{_text(link.com)}"/>'
        f'<mass value="{link.mass}"/><inertia ixx="{xx}" iyy="{yy}" izz="{zz}" '
        'ixy="0" ixz="0" iyz="0"/></inertial></link>'
    )


def _fixed(parent: str, child: str, xyz: tuple[float, float, float]) -> str:
    return (
        f'<joint name="{child}_joint" type="fixed"><parent link="{parent}"/>'
        f'<child link="{child}"/><origin xyz="{_text(xyz)}"/></joint>'
    )


def _text(xyz: object) -> str:
    return " ".join(f"{x:.12g}" for x in np.asarray(xyz, dtype=float))
