"""Random arms of any number of axes, as a stage for random stacks."""

from __future__ import annotations

import numpy as np

from wbc import Robot, State
from wbc.arrays import Array

__all__ = ["random_arm", "random_state"]

SPEED = 2.0
"""Velocity limit of every joint [rad/s]."""
REACH = 2.4
"""Position limit of every joint, both ways [rad]."""


def random_arm(rng: np.random.Generator, axes: int) -> Robot:
    """A chain of hinges about random axes, links of random size and mass."""
    opening, motors = "", ""
    for j in range(1, axes + 1):
        axis = rng.normal(size=3)
        mass, offset = rng.uniform(0.5, 4.0), rng.uniform(-0.25, 0.25, 3)
        opening += (
            f'<body name="link{j}" pos="{_text(offset)}">'
            f'<inertial mass="{mass}" pos="{_text(rng.uniform(-0.1, 0.1, 3))}" '
            f'diaginertia="{_text(0.01 * mass * rng.uniform(0.6, 1.0, 3))}"/>'
            f'<joint name="a{j}" axis="{_text(axis / np.linalg.norm(axis))}" '
            f'armature="0.05" range="{-REACH} {REACH}"/>'
        )
        motors += f'<motor joint="a{j}" ctrlrange="-{400 // j} {400 // j}"/>'
    return Robot.from_mjcf(
        f'<mujoco model="random {axes}"><compiler angle="radian"/><worldbody>'
        f'{opening}<site name="tip" pos="0.1 0 0.2"/>{"</body>" * axes}'
        f"</worldbody><actuator>{motors}</actuator></mujoco>",
        velocity_limit=SPEED,
        acceleration_limit=20.0,
    )


def random_state(robot: Robot, rng: np.random.Generator) -> State:
    """Anywhere within the position limits, at up to half of the velocity limits."""
    q = rng.uniform(robot.q_min, robot.q_max)
    return robot.state(q, 0.5 * rng.uniform(-robot.v_max, robot.v_max))


def _text(values: Array) -> str:
    return " ".join(f"{value:.17g}" for value in values)
