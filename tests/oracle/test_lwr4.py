"""The LWR 4+ against its MDH table, MuJoCo and published gravity torques."""

from __future__ import annotations

import mujoco
import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

from robots import lwr4
from tests.tolerances import ROUND_OFF

DYNAMICS = 1e-10  # inertia [kg m^2], torque [Nm], acceleration [m/s^2]
RTOL = 1e-12
STATES = 20

#  alpha [deg], r [m]
TABLE = ((0, 0.3105), (90, 0), (-90, 0.40), (-90, 0), (90, 0.39), (90, 0), (-90, 0))
FLANGE = 0.078
TIP = 0.2
RANGE = np.radians([170, 120, 170, 120, 170, 120, 170])
SPEED = np.radians([110, 110, 128, 128, 204, 184, 184])
TORQUE = np.array([176.0, 176, 100, 100, 100, 38, 38])


def mdh_poses(q: np.ndarray) -> dict[str, np.ndarray]:
    """Poses (4, 4) of link1 .. link7, flange and knife tip: Rx(alpha) Rz(q) Tz(r)."""
    X, poses = np.eye(4), {}
    for i, (qi, (alpha, r)) in enumerate(zip(q, TABLE, strict=True), start=1):
        a = np.radians(alpha)
        c, s, ca, sa = np.cos(qi), np.sin(qi), np.cos(a), np.sin(a)
        X = X @ [
            [c, -s, 0, 0],
            [s * ca, c * ca, -sa, -r * sa],
            [s * sa, c * sa, ca, r * ca],
            [0, 0, 0, 1],
        ]
        poses[f"link{i}"] = X
    for name, z in (("flange", FLANGE), ("knife_tip", FLANGE + TIP)):
        offset = np.eye(4)
        offset[2, 3] = z
        poses[name] = X @ offset
    return poses


def random_states(seed: int) -> list[tuple[np.ndarray, np.ndarray]]:
    rng = np.random.default_rng(seed)
    return [
        (rng.uniform(-RANGE, RANGE), rng.uniform(-SPEED, SPEED)) for _ in range(STATES)
    ]


def simulated(engine: mujoco.MjModel, q, v) -> mujoco.MjData:
    data = mujoco.MjData(engine)
    data.qpos[:], data.qvel[:] = q, v
    mujoco.mj_forward(engine, data)
    return data


def test_both_engines_place_every_frame_as_the_mdh_table_does():
    robot = lwr4.load()
    engine = mujoco.MjModel.from_xml_string(robot.mjcf)
    for q, v in random_states(seed=1):
        state, data = robot.state(q, v), simulated(engine, q, v)
        for name, X in mdh_poses(q).items():
            seen = data.body(name) if name.startswith("link") else data.site(name)
            assert_allclose(state.frame(name).p, X[:3, 3], atol=ROUND_OFF)
            assert_allclose(state.frame(name).R, X[:3, :3], atol=ROUND_OFF)
            assert_allclose(seen.xpos, X[:3, 3], atol=ROUND_OFF)
            assert_allclose(seen.xmat.reshape(3, 3), X[:3, :3], atol=ROUND_OFF)


@pytest.mark.parametrize("rotors", [True, False])
@pytest.mark.parametrize("tool", ["knife", "bracket", None])
def test_engines_agree_on_inertia_forces_and_jacobian(tool, rotors):
    robot = lwr4.load(tool, rotors=rotors)
    engine = mujoco.MjModel.from_xml_string(robot.mjcf)
    for q, v in random_states(seed=2):
        state, data = robot.state(q, v), simulated(engine, q, v)
        M, J = np.zeros((7, 7)), np.zeros((6, 7))
        mujoco.mj_fullM(engine, data, M)
        mujoco.mj_jacSite(engine, data, J[:3], J[3:], engine.site("flange").id)
        assert_allclose(state.M, M, atol=DYNAMICS, rtol=RTOL)
        assert_allclose(state.h, data.qfrc_bias, atol=DYNAMICS, rtol=RTOL)
        assert_allclose(state.frame("flange").J, J, atol=DYNAMICS, rtol=RTOL)


def test_gravity_torques_are_those_of_the_identified_arm():
    robot = lwr4.load(None)
    stretched = np.array([0, np.pi / 2, 0, 0, 0, 0, 0])
    forearm = np.array([0, 0, 0, np.pi / 2, 0, 0, 0])
    assert abs(robot.state(stretched).h[1]) == pytest.approx(46.4, abs=0.05)
    assert abs(robot.state(forearm).h[3]) == pytest.approx(14.03, abs=0.005)


def test_rotors_add_to_the_diagonal_of_M_alone():
    q = random_states(seed=3)[0][0]
    difference = lwr4.load().state(q).M - lwr4.load(rotors=False).state(q).M
    rotors = [3.1, 3.1, 2.01, 1.92, 0.776, 0.391, 0.399]
    assert_allclose(difference, np.diag(rotors), atol=ROUND_OFF)


def test_friction_is_simulated_and_said_in_the_notes():
    robot = lwr4.load(friction=True)
    engine = mujoco.MjModel.from_xml_string(robot.mjcf)
    v = np.full(7, 0.1)
    drag = simulated(engine, robot.q_home, v).qfrc_passive
    assert_allclose(drag, -0.1 * np.array(lwr4.VISCOUS), atol=ROUND_OFF)
    assert_allclose(engine.dof_frictionloss, lwr4.COULOMB)
    assert any("frictionloss" in note for note in robot.notes)
    assert lwr4.load().notes == ()


def test_inertias_are_those_of_solid_bodies():
    for tool in ("knife", "bracket"):
        engine = mujoco.MjModel.from_xml_string(lwr4.mjcf(tool))
        for body in range(1, engine.nbody):
            principal = np.sort(engine.body_inertia[body])
            assert principal[0] > 0
            assert principal[0] + principal[1] >= principal[2]


def test_limits_reach_the_robot():
    robot = lwr4.load()
    assert_allclose(robot.q_max, RANGE, atol=ROUND_OFF)
    assert_allclose(robot.q_min, -RANGE, atol=ROUND_OFF)
    assert_allclose(robot.v_max, SPEED, atol=ROUND_OFF)
    assert_allclose(robot.tau_max, TORQUE)


def test_at_home_the_tool_points_down_as_in_the_paper():
    state = lwr4.load().state(lwr4.load().q_home)
    assert_allclose(state.frame("knife_tip").R, np.diag([-1, 1, -1]), atol=ROUND_OFF)


def test_generalised_gravity_is_what_pinocchio_alone_computes():
    robot = lwr4.load("bracket")
    q = random_states(seed=4)[0][0]
    g = pin.computeGeneralizedGravity(robot.model, robot.model.createData(), q)
    assert_allclose(robot.state(q).h, g, atol=DYNAMICS)
