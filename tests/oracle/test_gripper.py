"""The gripper as a rigid tool for Pinocchio, and as a mechanism in MuJoCo."""

from __future__ import annotations

import mujoco
import numpy as np
import pinocchio as pin
from numpy.testing import assert_allclose

from robots import racer
from sims import grasping
from sims.grasping.gripper import JOINTS, OPENED

ATOL = 1e-10  # inertia [kg m^2], torque [Nm]
SAMPLES = 500
SHIFT = 1e-12  # of the gripper's centre of mass along the fingers' way [m]


def random_posture(robot, rng):
    return rng.uniform(np.maximum(robot.q_min, -np.pi), np.minimum(robot.q_max, np.pi))


def test_engines_agree_on_the_arm_with_the_rigid_gripper():
    robot, rng = racer.load("gripper"), np.random.default_rng(0)
    engine = mujoco.MjModel.from_xml_string(racer.mjcf("gripper"))
    data, M = mujoco.MjData(engine), np.zeros((6, 6))
    for _ in range(10):
        q, v = random_posture(robot, rng), rng.uniform(-2.0, 2.0, 6)
        data.qpos[:], data.qvel[:] = q, v
        mujoco.mj_forward(engine, data)
        mujoco.mj_fullM(engine, data, M)
        state = robot.state(q, v)
        assert_allclose(np.triu(state.M), np.triu(M), atol=ATOL)
        assert_allclose(state.h, data.qfrc_bias, atol=ATOL)
        assert_allclose(state.frame("tcp").p, data.site("tcp").xpos, atol=ATOL)


def test_moving_fingers_shift_no_mass_sideways_and_change_gravity_torques_of_none():
    robot, rng = racer.load("gripper"), np.random.default_rng(1)
    cell = grasping.cell(robot, None)
    fingers = [cell.model.joint(name).qposadr[0] for name in JOINTS]
    q = random_posture(robot, rng)
    for half in (0.0, 0.5 * OPENED, OPENED):
        cell.reset(q)
        cell.data.qpos[fingers] = half
        mujoco.mj_forward(cell.model, cell.data)
        assert_allclose(cell.data.qfrc_bias[:6], robot.state(q).gravity(), atol=ATOL)


def test_acceleration_limits_are_always_deliverable_at_once_with_the_gripper():
    robot, rng = racer.load("gripper"), np.random.default_rng(2)
    data = robot.model.createData()
    for _ in range(SAMPLES):
        q = random_posture(robot, rng)
        upper = np.triu(pin.crba(robot.model, data, q))
        M = upper + np.triu(upper, 1).T
        g = pin.computeGeneralizedGravity(robot.model, data, q)
        assert np.all(np.abs(M) @ robot.a_max + np.abs(g) <= robot.tau_max)
