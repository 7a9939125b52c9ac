"""Names of MuJoCo's joints and bodies, for those without one what Pinocchio says."""

from __future__ import annotations

import mujoco

__all__ = ["body_name", "dof_names", "joint_names"]

FREE = int(mujoco.mjtJoint.mjJNT_FREE)


def body_name(engine: mujoco.MjModel, index: int) -> str:
    """Name of a body, or its number where it has none."""
    return engine.body(index).name or f"(body {index})"


def joint_names(engine: mujoco.MjModel) -> list[str]:
    """MuJoCo's joint names; one without a name is called what Pinocchio calls it."""
    names = []
    for i in range(engine.njnt):
        body = engine.jnt_bodyid[i]
        free = engine.jnt_type[i] == FREE
        suffix = "_free" if free else f"Joint_{i - engine.body_jntadr[body]}"
        names.append(engine.joint(i).name or f"{engine.body(body).name}{suffix}")
    return names


def dof_names(engine: mujoco.MjModel) -> list[str]:
    """Joint name of every degree of freedom (nv,) of MuJoCo."""
    names = joint_names(engine)
    return [names[i] for i in engine.dof_jntid]
