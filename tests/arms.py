"""Arms for the tests: seven axes on LWR kinematics, and random ones, as MJCF text."""

from __future__ import annotations

import copy
import xml.etree.ElementTree as ET
from functools import cache

import numpy as np

from robots import racer
from wbc import Robot

#            alpha, r [m], mass [kg], centre of mass [m], length, radius [m], axis
LINKS = (
    (0, 0.3105, 2.35, (0.0, -0.020, -0.090), 0.24, 0.060, 2),
    (90, 0.00, 2.70, (0.0, 0.110, 0.010), 0.24, 0.060, 1),
    (-90, 0.40, 2.40, (0.0, 0.020, -0.090), 0.23, 0.060, 2),
    (-90, 0.00, 2.05, (0.0, -0.100, 0.010), 0.23, 0.060, 1),
    (90, 0.39, 1.70, (0.0, 0.020, -0.120), 0.20, 0.055, 2),
    (90, 0.00, 1.60, (0.0, 0.0045, 0.0), 0.12, 0.060, 2),
    (-90, 0.00, 0.30, (0.0, 0.0, 0.060), 0.04, 0.040, 2),
)
RANGE = np.radians([170, 120, 170, 120, 170, 120, 170])
SPEED = np.radians([110, 110, 128, 128, 204, 184, 184])
TORQUE = np.array([176.0, 176, 100, 100, 100, 38, 38])
HOME = np.array([0.0, 0.5, 0.0, -1.2, 0.0, 0.9, 0.0])
TIP = 0.178
ARMATURE = 0.01
UPPER, LOWER = 0.5, 0.3


def _numbers(values) -> str:
    return " ".join(f"{value:.17g}" for value in np.atleast_1d(values))


def _cylinder(mass: float, length: float, radius: float, axis: int) -> np.ndarray:
    inertia = np.full(3, mass * (3.0 * radius**2 + length**2) / 12.0)
    inertia[axis] = 0.5 * mass * radius**2
    return inertia


def seven_axis_mjcf() -> str:
    """T(j-1, j) = Rx(alpha) Rz(theta) Tz(r), tip along the last z axis."""
    opening, closing = "", ""
    for j, (alpha, r, mass, com, length, radius, axis) in enumerate(LINKS, 1):
        a = np.radians(alpha)
        pos = _numbers([0.0, -r * np.sin(a), r * np.cos(a)])
        quat = _numbers([np.cos(a / 2), np.sin(a / 2), 0.0, 0.0])
        opening += (
            f'<body name="link{j}" pos="{pos}" quat="{quat}">'
            f'<inertial mass="{mass}" pos="{_numbers(com)}" '
            f'diaginertia="{_numbers(_cylinder(mass, length, radius, axis))}"/>'
            f'<joint name="a{j}" axis="0 0 1" armature="{ARMATURE}" '
            f'range="{_numbers([-RANGE[j - 1], RANGE[j - 1]])}"/>'
        )
        closing += "</body>"
    motors = "".join(
        f'<motor name="m{j}" joint="a{j}" ctrlrange="{-tau} {tau}"/>'
        for j, tau in enumerate(TORQUE, 1)
    )
    return (
        '<mujoco model="seven"><compiler angle="radian"/><custom>'
        f'<numeric name="velocity_limit" data="{_numbers(SPEED)}"/></custom>'
        f'<worldbody><body name="base">{opening}'
        f'<site name="tip" pos="0 0 {TIP}"/>{closing}</body></worldbody>'
        f"<actuator>{motors}</actuator>"
        f'<keyframe><key name="home" qpos="{_numbers(HOME)}"/></keyframe></mujoco>'
    )


def random_mjcf(rng: np.random.Generator, n: int) -> str:
    """A chain of hinges about random axes, links of random size and weight."""
    opening, closing, motors = "", "", ""
    for j in range(1, n + 1):
        axis = rng.normal(size=3)
        low, high = -rng.uniform(0.6, 2.8), rng.uniform(0.6, 2.8)
        inertia = _cylinder(1.0, 0.2, 0.05, int(rng.integers(3)))
        mass = rng.uniform(0.5, 4.0)
        offset = _numbers(rng.uniform(-0.25, 0.25, 3)) if j > 1 else "0 0 0.3"
        opening += (
            f'<body name="link{j}" pos="{offset}">'
            f'<inertial mass="{mass}" pos="{_numbers(rng.uniform(-0.1, 0.1, 3))}" '
            f'diaginertia="{_numbers(mass * inertia)}"/>'
            f'<joint name="a{j}" axis="{_numbers(axis / np.linalg.norm(axis))}" '
            f'armature="0.05" range="{_numbers([low, high])}"/>'
        )
        closing += "</body>"
        motors += f'<motor joint="a{j}" ctrlrange="-{200 // j + 60} {200 // j + 60}"/>'
    return (
        f'<mujoco model="random{n}"><compiler angle="radian"/><worldbody>'
        f'<body name="base">{opening}<site name="tip" pos="0.1 0 0.2"/>{closing}'
        f"</body></worldbody><actuator>{motors}</actuator></mujoco>"
    )


@cache
def seven_axis() -> Robot:
    return Robot.from_mjcf(seven_axis_mjcf(), name="seven")


@cache
def six_axis() -> Robot:
    return racer.load()


def random_arm(rng: np.random.Generator, n: int) -> Robot:
    return Robot.from_mjcf(random_mjcf(rng, n), velocity_limit=rng.uniform(1.0, 4.0, n))


ROBOTS = {"racer": six_axis, "seven": seven_axis}
TIPS = {"racer": "torch_tip", "seven": "tip"}


def two_arms_mjcf() -> str:
    """Two of the seven-axis arms in one model, face to face: left_* and right_*."""
    arm = ET.fromstring(seven_axis_mjcf())
    world, motors = arm.find("worldbody"), arm.find("actuator")
    assert world is not None
    assert motors is not None
    left = world[0]
    right = copy.deepcopy(left)
    right.set("pos", "1.1 0 0")
    right.set("quat", "0 0 0 1")
    world.remove(left)
    ET.SubElement(world, "body", name="floor").extend([left, right])
    for side, base in (("left", left), ("right", right)):
        for element in base.iter():
            if "name" in element.attrib:
                element.set("name", f"{side}_{element.get('name')}")
    for motor in list(motors):
        other = copy.deepcopy(motor)
        for side, one in (("left", motor), ("right", other)):
            one.set("name", f"{side}_{one.get('name')}")
            one.set("joint", f"{side}_{one.get('joint')}")
        motors.append(other)
    for numeric in arm.iter("numeric"):
        numeric.set("data", f"{numeric.get('data')} {numeric.get('data')}")
    for key in arm.iter("key"):
        key.set("qpos", f"{key.get('qpos')} {key.get('qpos')}")
    return ET.tostring(arm, encoding="unicode")


@cache
def two_arms() -> Robot:
    return Robot.from_mjcf(two_arms_mjcf(), name="two arms")


def two_link(low: float = -3.1, high: float = 3.1) -> Robot:
    """A planar arm about z, links of 0.5 and 0.3 m; limits of its elbow [rad]."""
    inertial = '<inertial mass="1" pos="0.1 0 0" diaginertia="0.01 0.01 0.01"/>'
    return Robot.from_mjcf(
        '<mujoco model="2R"><compiler angle="radian"/><option gravity="0 0 0"/>'
        f'<worldbody><body name="upper">{inertial}'
        '<joint name="shoulder" axis="0 0 1" range="-3.1 3.1"/>'
        f'<body name="lower" pos="{UPPER} 0 0">{inertial}'
        f'<joint name="elbow" axis="0 0 1" range="{low} {high}"/>'
        f'<site name="tip" pos="{LOWER} 0 0"/></body></body></worldbody>'
        '<actuator><motor joint="shoulder" ctrlrange="-50 50"/>'
        '<motor joint="elbow" ctrlrange="-50 50"/></actuator></mujoco>',
        velocity_limit=3.0,
    )
