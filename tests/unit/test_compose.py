"""Several arms in one model: block diagonal, and the same to both engines."""

from __future__ import annotations

import mujoco
import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

from robots import compose, lwr4, racer
from robots.compose import Placed
from tests.tolerances import ROUND_OFF
from wbc import Robot
from wbc.errors import InputError, ModelError

DYNAMICS = 1e-10  # inertia [kg m^2], torque [Nm], Jacobian [m]
R = np.array(pin.rpy.rpyToMatrix(0.2, -0.1, 0.7))


def pair() -> dict[str, Placed]:
    return {
        "cutter": Placed(lwr4.mjcf("knife")),
        "puller": Placed(lwr4.mjcf("bracket"), (0.0, 0.4, 0.1), R),
    }


def random_state(robot: Robot, seed: int):
    rng = np.random.default_rng(seed)
    q = rng.uniform(robot.q_min, robot.q_max)
    return robot.state(q, rng.uniform(-1, 1, robot.nv))


def test_dynamics_are_the_block_diagonal_of_the_single_arms():
    both = random_state(compose.load(pair()), seed=1)
    M, h = np.zeros((14, 14)), np.zeros(14)
    for i, (name, placed) in enumerate(pair().items()):
        own = slice(7 * i, 7 * i + 7)
        alone = compose.load({name: placed}).state(both.q[own], both.v[own])
        M[own, own], h[own] = alone.M, alone.h
    assert_allclose(both.M, M, atol=ROUND_OFF)
    assert_allclose(both.h, h, atol=DYNAMICS)


def test_an_arm_at_the_origin_is_the_arm_itself():
    alone = lwr4.load("knife")
    placed = compose.load({"cutter": Placed(lwr4.mjcf("knife"))})
    a = random_state(alone, seed=2)
    b = placed.state(a.q, a.v)
    assert_allclose(b.M, a.M, atol=ROUND_OFF)
    assert_allclose(b.h, a.h, atol=DYNAMICS)
    assert_allclose(b.frame("cutter_knife_tip").p, a.frame("knife_tip").p)


def test_engines_agree_on_the_composed_arms():
    robot = compose.load(pair())
    engine = mujoco.MjModel.from_xml_string(robot.mjcf)
    data = mujoco.MjData(engine)
    for seed in range(5):
        state = random_state(robot, seed)
        data.qpos[:], data.qvel[:] = state.q, state.v
        mujoco.mj_forward(engine, data)
        M, J = np.zeros((14, 14)), np.zeros((6, 14))
        mujoco.mj_fullM(engine, data, M)
        assert_allclose(state.M, M, atol=DYNAMICS)
        assert_allclose(state.h, data.qfrc_bias, atol=DYNAMICS)
        for tip in ("cutter_knife_tip", "puller_grip"):
            mujoco.mj_jacSite(engine, data, J[:3], J[3:], engine.site(tip).id)
            assert_allclose(state.frame(tip).p, data.site(tip).xpos, atol=ROUND_OFF)
            assert_allclose(state.frame(tip).J, J, atol=DYNAMICS)


def test_base_stands_where_it_was_placed():
    state = random_state(compose.load(pair()), seed=3)
    base = state.frame("puller")
    assert_allclose(base.p, [0.0, 0.4, 0.1], atol=ROUND_OFF)
    assert_allclose(base.R, R, atol=ROUND_OFF)


def test_limits_and_home_are_those_of_the_arms_in_order():
    robot = compose.load(
        {"a": Placed(lwr4.mjcf()), "b": Placed(racer.mjcf(), (2, 0, 0))}
    )
    singles = [lwr4.load(), racer.load()]
    assert robot.joint_names[6:8] == ("a_joint7", "b_joint1")
    for what in ("q_min", "q_max", "v_max", "a_max", "tau_max", "q_home"):
        joined = np.concatenate([getattr(single, what) for single in singles])
        assert_allclose(getattr(robot, what), joined, rtol=1e-12)


def test_sensors_of_both_tools_can_be_told_apart():
    engine = mujoco.MjModel.from_xml_string(compose.mjcf(pair()))
    names = [engine.sensor(i).name for i in range(engine.nsensor)]
    assert names[0] == "cutter_wrist_force"
    assert names[-1] == "puller_wrist_torque"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("angle='radian'", "angle='degree'"), "compiler"),
        (("<option/>", "<option gravity='0 0 -1'/>"), "different gravity"),
        (("<option/>", "<option timestep='0.005'/>"), "timestep"),
        (("<default/>", "<default><geom group='1'/></default>"), "in classes"),
        (("<worldbody>", "<worldbody><body name='second'/>"), "arm 'b'.*one root"),
    ],
)
def test_arms_that_would_change_each_other_are_refused(change, message):
    text = (
        "<mujoco><compiler angle='radian'/><option/><default/><worldbody>"
        "<body name='base'><body name='link'><joint name='j' range='-1 1'/>"
        "<inertial mass='1' pos='0 0 0' diaginertia='1 1 1'/></body></body>"
        "</worldbody><actuator><motor joint='j' ctrlrange='-9 9'/></actuator><custom>"
        "<numeric name='velocity_limit' data='1'/></custom></mujoco>"
    )
    first = text.replace("<option/>", "<option timestep='0.001'/>")
    with pytest.raises(ModelError, match=message):
        compose.mjcf({"a": Placed(first), "b": Placed(text.replace(*change))})


def test_a_mesh_without_a_name_is_still_found():
    text = lwr4.mjcf().replace("<asset>", "<asset><mesh file='shapes/lid.stl'/>")
    whole = compose.mjcf({"a": Placed(text.replace('"knife_blade" m', '"lid" m'))})
    assert 'name="a_lid"' in whole
    assert 'mesh="a_lid"' in whole


def test_nothing_to_compose_is_refused():
    with pytest.raises(ModelError, match="no arm"):
        compose.load({})
    with pytest.raises(ModelError, match="body of all arms"):
        compose.load({"arms": Placed(lwr4.mjcf())})


@pytest.mark.parametrize("position", [(0, 0), (0, 0, np.nan)])
def test_a_position_that_is_none_is_refused(position):
    with pytest.raises(InputError, match="position"):
        Placed(lwr4.mjcf(), position)


def test_a_base_that_is_mirrored_is_refused():
    with pytest.raises(InputError, match="rotation"):
        Placed(lwr4.mjcf(), R=np.diag([1.0, 1.0, -1.0]))
