"""The racer against its DH table, and MuJoCo against Pinocchio on the same text."""

from __future__ import annotations

import mujoco
import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

from robots import racer
from wbc.errors import UnknownName

ATOL = 1e-10  # poses [m, -], inertia [kg m^2], torque [Nm], acceleration [m/s^2]
RTOL = 1e-12
ANGLE = 1e-6  # limits are written with 7 decimals [rad]
RATE = 1e-4  # and velocity limits with 4 [rad/s]
STATES = 20
SAMPLES = 2000

#      theta0 [deg], d [m], a [m], alpha [deg], direction of rotation
TABLE = (
    (0, 0.43, 0.15, -90, -1),
    (-90, 0.0, 0.59, 0, 1),
    (-90, 0.0, 0.13, -90, -1),
    (0, 0.684, 0.0, 90, -1),
    (0, 0.0, 0.0, -90, 1),
    (180, 0.10, 0.0, 0, -1),
)
LOWER = np.radians([-165, -85, -168, -210, -135, -2700])
UPPER = np.radians([165, 155, 0, 210, 135, 2700])
SPEED = np.radians([220, 250, 300, 550, 550, 600])
TORQUE = np.array([600.0, 950, 400, 60, 60, 30])
HOME = np.radians([0, 0, -90, 0, 0, 0])


def rotation(axis: int, angle: float) -> np.ndarray:
    X = np.eye(4)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    X[i, i] = X[j, j] = np.cos(angle)
    X[j, i] = np.sin(angle)
    X[i, j] = -X[j, i]
    return X


def shift(x: float, z: float) -> np.ndarray:
    X = np.eye(4)
    X[0, 3], X[2, 3] = x, z
    return X


def dh_poses(q: np.ndarray) -> dict[str, np.ndarray]:
    """Poses (4, 4) of link1 .. link6 and of the flange, from the table alone."""
    X, poses = np.eye(4), {}
    rows = zip(q, TABLE, strict=True)
    for i, (qi, (theta0, d, a, alpha, sign)) in enumerate(rows, start=1):
        X = X @ rotation(2, np.radians(theta0) + sign * qi)
        poses[f"link{i}"] = X
        X = X @ shift(a, d) @ rotation(0, np.radians(alpha))
    return {**poses, "flange": X}


def pin_model(tmp_path, tool: str | None = "torch") -> pin.Model:
    path = tmp_path / "racer.xml"
    path.write_text(racer.mjcf(tool))
    return pin.buildModelFromMJCF(str(path))


@pytest.fixture
def model(tmp_path) -> pin.Model:
    return pin_model(tmp_path)


@pytest.fixture
def engine() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(racer.mjcf())


def random_states(seed: int) -> list[tuple[np.ndarray, np.ndarray]]:
    rng = np.random.default_rng(seed)
    return [
        (rng.uniform(LOWER, UPPER), rng.uniform(-SPEED, SPEED)) for _ in range(STATES)
    ]


def simulated(engine: mujoco.MjModel, q, v) -> mujoco.MjData:
    data = mujoco.MjData(engine)
    data.qpos[:], data.qvel[:] = q, v
    mujoco.mj_forward(engine, data)
    return data


def frame_id(model: pin.Model, name: str) -> int:
    kind = pin.FrameType.BODY if name.startswith("link") else pin.FrameType.OP_FRAME
    return model.getFrameId(name, kind)


def test_pinocchio_poses_follow_the_dh_table(model):
    data = model.createData()
    for q, _ in random_states(seed=1):
        pin.framesForwardKinematics(model, data, q)
        for name, X in dh_poses(q).items():
            placed = data.oMf[frame_id(model, name)].homogeneous
            assert_allclose(placed, X, atol=ATOL, rtol=0)


def test_mujoco_poses_follow_the_dh_table(engine):
    for q, v in random_states(seed=2):
        data = simulated(engine, q, v)
        for name, X in dh_poses(q).items():
            found = data.site(name) if name == "flange" else data.body(name)
            assert_allclose(found.xpos, X[:3, 3], atol=ATOL, rtol=0)
            assert_allclose(found.xmat.reshape(3, 3), X[:3, :3], atol=ATOL, rtol=0)


def test_engines_agree_on_inertia_and_bias(model, engine):
    data = model.createData()
    for q, v in random_states(seed=3):
        other = simulated(engine, q, v)
        M = np.zeros((6, 6))
        mujoco.mj_fullM(engine, other, M)
        upper = np.triu(pin.crba(model, data, q))
        assert_allclose(upper + np.triu(upper, 1).T, M, atol=ATOL, rtol=RTOL)
        h = pin.nonLinearEffects(model, data, q, v)
        assert_allclose(h, other.qfrc_bias, atol=ATOL, rtol=RTOL)


@pytest.mark.parametrize("site", ["flange", "torch_tip", "wrist_sensor"])
def test_engines_agree_on_jacobian_and_drift(model, engine, site):
    data, frame = model.createData(), frame_id(model, site)
    for q, v in random_states(seed=4):
        other = simulated(engine, q, v)
        J, J_dot = np.zeros((6, 6)), np.zeros((6, 6))
        found, body = other.site(site), engine.site(site).bodyid[0]
        mujoco.mj_jacSite(engine, other, J[:3], J[3:], found.id)
        mujoco.mj_jacDot(engine, other, J_dot[:3], J_dot[3:], found.xpos, body)
        pin.forwardKinematics(model, data, q, v, np.zeros(6))
        aligned = pin.LOCAL_WORLD_ALIGNED
        drift = pin.getFrameClassicalAcceleration(model, data, frame, aligned)
        J_pin = pin.computeFrameJacobian(model, data, q, frame, aligned)
        assert_allclose(J_pin, J, atol=ATOL, rtol=RTOL)
        assert_allclose(drift.vector, J_dot @ v, atol=ATOL, rtol=RTOL)


def test_engines_agree_without_a_tool(tmp_path):
    model = pin_model(tmp_path, tool=None)
    engine = mujoco.MjModel.from_xml_string(racer.mjcf(None))
    q, v = random_states(seed=5)[0]
    h = pin.nonLinearEffects(model, model.createData(), q, v)
    assert_allclose(h, simulated(engine, q, v).qfrc_bias, atol=ATOL, rtol=RTOL)


def test_inertias_are_those_of_solid_bodies(engine):
    for body in range(1, engine.nbody):
        principal = np.sort(engine.body_inertia[body])
        assert principal[0] > 0
        assert principal[0] + principal[1] >= principal[2]


def test_flange_at_home_is_forward_and_z_out():
    X = dh_poses(HOME)["flange"]
    assert_allclose(X[:3, 3], [0.934, 0, 1.15], atol=ATOL)
    assert_allclose(X[:3, 2], [1, 0, 0], atol=ATOL)
    assert_allclose(X[:3, 0], [0, 0, -1], atol=ATOL)


def test_torch_tip_is_35_centimetres_and_35_degrees_from_the_flange(engine):
    data = simulated(engine, HOME, np.zeros(6))
    tip, flange = data.site("torch_tip"), data.site("flange")
    R, R_tip = flange.xmat.reshape(3, 3), tip.xmat.reshape(3, 3)
    assert_allclose(R.T @ (tip.xpos - flange.xpos), [0.1, 0, 0.335], atol=ATOL)
    assert_allclose(R[:, 2] @ R_tip[:, 2], np.cos(np.radians(35)), atol=ATOL)
    assert R_tip[2, 2] < 0  # at home the wire points down


def test_limits_and_home_reach_the_robot():
    robot = racer.load()
    assert robot.joint_names == tuple(f"joint{i}" for i in range(1, 7))
    assert_allclose(robot.q_min, LOWER, atol=ANGLE)
    assert_allclose(robot.q_max, UPPER, atol=ANGLE)
    assert_allclose(robot.v_max, SPEED, atol=RATE)
    assert_allclose(robot.tau_max, TORQUE)
    assert_allclose(robot.q_home, HOME)


def test_acceleration_limits_are_always_deliverable_at_once_with_the_torch(tmp_path):
    model = pin_model(tmp_path, "torch")
    data, a_max = model.createData(), racer.load().a_max
    rng = np.random.default_rng(6)
    for q in rng.uniform(LOWER, UPPER, (SAMPLES, 6)):
        upper = np.triu(pin.crba(model, data, q))
        M = upper + np.triu(upper, 1).T
        g = pin.computeGeneralizedGravity(model, data, q)
        assert np.all(np.abs(M) @ a_max + np.abs(g) <= TORQUE)


def test_unknown_tool_is_refused_with_the_valid_names():
    with pytest.raises(UnknownName, match="torch") as caught:
        racer.mjcf("torhc")
    assert caught.value.kind == "tool"
