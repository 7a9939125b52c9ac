"""Reading robots: what their files leave out or mean otherwise is never lost."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.arms import HOME, RANGE, SPEED, TORQUE, random_mjcf, seven_axis
from wbc import InputError, ModelError, Robot, StaleError, State, UnknownName, WbcError

INERTIAL = '<inertial mass="2" pos="0 0 .1" diaginertia=".02 .02 .01"/>'
JOINTS = ("shoulder", "elbow")


def model(
    *,
    top: str = "",
    root: str = "",
    root_inside: str = "",
    upper: str = "",
    upper_joint: str = 'axis="0 1 0" range="-2 2"',
    upper_inertial: str = INERTIAL,
    inside: str = "",
    lower_joint: str = 'axis="0 1 0" range="-1 1"',
    beside: str = "",
    actuators: str = (
        '<motor joint="shoulder" ctrlrange="-50 50"/>'
        '<motor joint="elbow" ctrlrange="-20 20"/>'
    ),
    bottom: str = "",
    compiler: str = '<compiler angle="radian"/>',
) -> str:
    """A planar arm of two hinges, with a place for everything that can go wrong."""
    return f"""<mujoco model="planar">{compiler}{top}<worldbody>
      <body name="base" {root}>{root_inside}
        <body name="upper" {upper}>{upper_inertial}
          <joint name="shoulder" {upper_joint}/>{inside}
          <body name="lower" pos="0 0 .3">{INERTIAL}
            <joint name="elbow" {lower_joint}/><site name="tip" pos="0 0 .2"/>
          </body>
        </body>
      </body>{beside}
    </worldbody><actuator>{actuators}</actuator>{bottom}</mujoco>"""


def load(text: str | None = None, **options) -> Robot:
    return Robot.from_mjcf(
        model() if text is None else text, **({"velocity_limit": 3.0} | options)
    )


def refused(message: str, **changes) -> None:
    with pytest.raises(ModelError, match=message):
        load(model(**changes))


def assert_same_as_mujoco(text: str, robot: Robot) -> None:
    """Tip, inertia and bias of both engines at random states."""
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    rng = np.random.default_rng(0)
    for _ in range(5):
        d.qpos[:], d.qvel[:] = rng.uniform(-1, 1, (2, m.nv))
        mujoco.mj_forward(m, d)
        state = robot.state(d.qpos, d.qvel)
        M = np.zeros((m.nv, m.nv))
        mujoco.mj_fullM(m, d, M)
        assert_allclose(state.frame("tip").p, d.site("tip").xpos, atol=1e-12)
        assert_allclose(
            state.frame("tip").R, d.site("tip").xmat.reshape(3, 3), atol=1e-12
        )
        assert_allclose(state.M, M, atol=1e-12)
        assert_allclose(state.h, d.qfrc_bias, atol=1e-11)


# ----------------------------------------------------------------- what is read right


def test_names_limits_and_home_are_read():
    robot = seven_axis()
    assert robot.joint_names == tuple(f"a{j}" for j in range(1, 8))
    assert_allclose(robot.q_max, RANGE)
    assert_allclose(robot.q_min, -RANGE)
    assert_allclose(robot.v_max, SPEED)
    assert_allclose(robot.tau_max, TORQUE)
    assert_allclose(robot.q_home, HOME)
    assert robot.name == "seven"
    assert robot.nv == 7


def test_bodies_joints_and_sites_are_frames():
    frames = load().frames
    assert {"base", "upper", "lower", "shoulder", "elbow", "tip"} <= set(frames)


def test_the_two_engines_agree_on_the_plain_model():
    assert_same_as_mujoco(model(), load())


@pytest.mark.parametrize("n", [2, 5, 8])
def test_the_two_engines_agree_on_random_arms(n):
    text = random_mjcf(np.random.default_rng(n), n)
    assert_same_as_mujoco(text, load(text))


def test_degrees_are_the_default_of_a_file_that_does_not_say():
    robot = load(
        model(
            compiler="",
            upper_joint='axis="0 1 0" range="-90 90"',
            lower_joint='axis="0 1 0" range="-45 45"',
        )
    )
    assert_allclose(robot.q_max, [np.pi / 2, np.pi / 4])


def test_a_file_is_read_like_its_text(tmp_path):
    path = tmp_path / "planar.xml"
    path.write_text(model())
    for source in (path, str(path)):
        assert load(source).joint_names == JOINTS


def test_the_text_of_the_model_is_kept():
    assert load().mjcf == model()


def test_the_name_is_the_models_unless_given():
    assert load().name == "planar"
    assert load(name="mine").name == "mine"


def test_the_text_of_a_robot_names_its_joints():
    assert repr(load()) == "Robot('planar', 2 joints: shoulder, elbow)"


# ------------------------------------------------------------- traps that are mended

POSE = 'pos=".1 .2 .3" quat=".5 .5 .5 .5"'


def test_the_pose_of_the_root_is_kept():
    text = model(root=POSE)
    assert_same_as_mujoco(text, load(text))


@pytest.mark.parametrize(
    "pose",
    [
        'euler=".1 .2 .3"',
        'axisangle="0 1 0 .5"',
        'zaxis="1 1 1"',
        'xyaxes="0 1 0 -1 0 0"',
    ],
)
def test_every_way_to_turn_the_root_is_kept(pose):
    text = model(root=f'pos="0 0 1" {pose}')
    assert_same_as_mujoco(text, load(text))


def test_a_joint_on_the_root_body_moves_it():
    text = model(
        root_inside=f'{INERTIAL}<joint name="turn" axis="0 0 1" range="-1 1"/>'
    )
    robot = load(text, torque_limit={"turn": 30.0})
    assert robot.joint_names == ("turn", *JOINTS)
    assert_same_as_mujoco(text, robot)


def test_a_joint_on_a_root_body_with_a_pose_moves_it_there():
    joint = '<joint name="turn" axis="0 0 1" range="-1 1"/>'
    text = model(root=POSE, root_inside=INERTIAL + joint)
    assert_same_as_mujoco(text, load(text, torque_limit={"turn": 30.0}))


@pytest.mark.parametrize("gravity", ["0 0 -1.62", "0 0 0", "1 2 3"])
def test_the_gravity_of_the_file_is_kept(gravity):
    text = model(top=f'<option gravity="{gravity}"/>')
    assert_same_as_mujoco(text, load(text))


def test_armature_is_part_of_the_inertia():
    text = model(upper_joint='axis="0 1 0" range="-2 2" armature=".7"')
    assert_same_as_mujoco(text, load(text))


def test_default_classes_are_followed():
    top = (
        '<default><joint axis="0 1 0" range="-2 2"/><motor ctrlrange="-50 50"/>'
        '<default class="weak"><joint range="-1 1" actuatorfrcrange="-7 7"/></default>'
        "</default>"
    )
    text = model(
        top=top,
        upper_joint="",
        lower_joint='class="weak"',
        actuators='<motor joint="shoulder"/><motor joint="elbow"/>',
    )
    robot = load(text)
    assert_allclose(robot.q_max, [2.0, 1.0])
    assert_allclose(robot.tau_max, [50.0, 7.0])
    assert_same_as_mujoco(text, robot)


def test_a_childclass_reaches_the_joints_below_it():
    top = (
        '<default><default class="small"><joint axis="0 1 0" range="-.5 .5" '
        'actuatorfrcrange="-9 9"/></default></default>'
    )
    text = model(top=top, upper='childclass="small"', upper_joint="", lower_joint="")
    robot = load(text)
    assert_allclose(robot.q_max, [0.5, 0.5])
    assert_allclose(robot.tau_max, [9.0, 9.0])


def test_motor_gears_multiply_the_torque():
    robot = load(
        model(
            actuators='<motor joint="shoulder" ctrlrange="-1 1" gear="80"/>'
            '<motor joint="elbow" ctrlrange="-2 2" gear="-10"/>'
        )
    )
    assert_allclose(robot.tau_max, [80.0, 20.0])


def test_position_actuators_limit_the_torque_by_their_force():
    robot = load(
        model(
            actuators='<position joint="shoulder" kp="9" ctrlrange="-2 2" '
            'forcerange="-40 40"/><motor joint="elbow" forcerange="-8 8"/>'
        )
    )
    assert_allclose(robot.tau_max, [40.0, 8.0])


def test_the_force_range_of_a_joint_bounds_its_motors():
    robot = load(
        model(upper_joint='axis="0 1 0" range="-2 2" actuatorfrcrange="-33 33"')
    )
    assert_allclose(robot.tau_max, [33.0, 20.0])


def test_the_smaller_side_of_a_lopsided_motor_counts():
    robot = load(
        model(
            actuators='<motor joint="shoulder" ctrlrange="-50 30"/>'
            '<motor joint="elbow" ctrlrange="-20 20"/>'
        )
    )
    assert robot.tau_max[0] == 30.0


def test_limits_may_stand_in_the_file():
    top = (
        '<custom><numeric name="velocity_limit" data="1 2"/>'
        '<numeric name="acceleration_limit" data="5 6"/></custom>'
    )
    robot = Robot.from_mjcf(model(top=top))
    assert_allclose(robot.v_max, [1.0, 2.0])
    assert_allclose(robot.a_max, [5.0, 6.0])


def test_limits_that_are_given_win_over_the_file():
    top = '<custom><numeric name="velocity_limit" data="1 2"/></custom>'
    robot = Robot.from_mjcf(
        model(top=top),
        velocity_limit=[7.0, 8.0],
        position_limit={"elbow": 0.4},
        torque_limit=60.0,
    )
    assert_allclose(robot.v_max, [7.0, 8.0])
    assert_allclose(robot.q_max, [2.0, 0.4])
    assert_allclose(robot.q_min, [-2.0, -0.4])
    assert_allclose(robot.tau_max, [60.0, 60.0])


def test_a_mapping_may_give_some_limits_and_the_file_the_rest():
    robot = load(model(), torque_limit={"elbow": 11.0, "shoulder": 44.0})
    assert_allclose(robot.tau_max, [44.0, 11.0])


def test_a_mapping_for_one_joint_keeps_the_motors_of_the_others():
    robot = load(model(), torque_limit={"elbow": 11.0})
    assert_allclose(robot.tau_max, [50.0, 11.0])


def test_no_limit_may_be_meant():
    robot = load(velocity_limit=np.inf, torque_limit=np.inf, acceleration_limit=np.inf)
    assert np.isinf(robot.v_max).all()
    assert np.isinf(robot.tau_max).all()
    assert np.isinf(robot.a_max).all()


def test_no_position_limit_may_be_meant():
    robot = load(model(lower_joint='axis="0 1 0"'), position_limit={"elbow": np.inf})
    assert_allclose(robot.q_max, [2.0, np.inf])
    assert_allclose(robot.q_min, [-2.0, -np.inf])


def test_acceleration_limits_are_what_the_torques_can_always_brake_with():
    robot = load()
    assert (robot.a_max > 0).all()
    rng = np.random.default_rng(1)
    for q in rng.uniform(robot.q_min, robot.q_max, (100, 2)):
        state = robot.state(q)
        need = np.abs(state.M) @ robot.a_max + np.abs(state.gravity())
        assert (need <= robot.tau_max).all()


def test_the_home_posture_is_zero_within_the_limits_where_there_is_none():
    robot = load(model(upper_joint='axis="0 1 0" range=".5 2"'))
    assert_allclose(robot.q_home, [0.5, 0.0])


def test_the_keyframe_called_home_is_the_home_posture():
    bottom = (
        '<keyframe><key name="other" qpos="0 0"/><key name="home" qpos=".3 .4"/>'
        "</keyframe>"
    )
    assert_allclose(load(model(bottom=bottom)).q_home, [0.3, 0.4])


def test_a_home_that_is_given_wins_over_the_keyframe():
    bottom = '<keyframe><key name="home" qpos=".3 .4"/></keyframe>'
    assert_allclose(load(model(bottom=bottom), q_home=[0.1, 0.2]).q_home, [0.1, 0.2])


@pytest.mark.parametrize("trait", ["damping", "frictionloss"])
def test_what_only_the_simulator_applies_is_noted(trait):
    text = model(upper_joint=f'axis="0 1 0" range="-2 2" {trait}=".5"')
    (note,) = load(text).notes
    assert note.startswith(f"joint 'shoulder' has {trait}")


def test_equalities_of_the_file_are_noted():
    bottom = '<equality><joint joint1="shoulder" joint2="elbow"/></equality>'
    (note,) = load(model(bottom=bottom)).notes
    assert "equality constraints of the file are not part" in note


def test_a_clean_model_has_no_notes():
    assert load().notes == ()


# ----------------------------------------------------------- traps that are refused


def test_a_second_root_is_refused():
    refused(
        "exactly one root body, found 'base', 'table'",
        beside=f'<body name="table">{INERTIAL}</body>',
    )


def test_a_world_without_bodies_is_refused():
    with pytest.raises(ModelError, match="exactly one root body, found none"):
        load("<mujoco><worldbody/></mujoco>")


def test_a_missing_inertial_is_refused():
    refused("no <inertial> on body upper", upper_inertial="")


def test_a_geom_without_an_inertial_beside_it_is_refused():
    refused(
        "no <inertial> on body finger",
        inside='<body name="finger"><geom size=".1"/></body>',
    )


def test_a_body_that_carries_nothing_needs_no_inertial():
    robot = load(model(inside='<body name="mark"><site name="here"/></body>'))
    assert "here" in robot.frames


def test_inertias_from_geoms_are_refused():
    refused(
        "inertiafromgeom", compiler='<compiler angle="radian" inertiafromgeom="true"/>'
    )


def test_an_include_is_refused():
    refused("uses <include>", top='<include file="other.xml"/>')


def test_a_frame_element_is_refused():
    refused(
        "uses <frame>",
        inside=f'<frame pos="0 0 1"><body name="b">{INERTIAL}</body></frame>',
    )


def test_a_replicate_element_is_refused():
    refused(
        "uses <replicate>",
        inside=f'<replicate count="2"><body name="b">{INERTIAL}</body></replicate>',
    )


def test_a_free_joint_is_refused():
    refused("uses <freejoint>", root_inside=f"{INERTIAL}<freejoint/>")


@pytest.mark.parametrize("kind", ["free", "ball"])
def test_a_joint_of_several_degrees_of_freedom_is_refused(kind):
    refused(f"joint 'shoulder' is of type '{kind}'", upper_joint=f'type="{kind}"')


def test_a_joint_type_in_a_default_class_is_refused_as_well():
    refused(
        "joint 'shoulder' is of type 'ball'",
        top='<default><joint type="ball"/></default>',
        lower_joint='type="hinge" axis="0 1 0"',
        upper_joint="",
    )


def test_gravity_compensation_is_refused():
    refused("gravcomp on body upper", upper='gravcomp="1"')


def test_gravity_compensation_of_a_fixed_tool_is_refused():
    refused(
        "gravcomp on body tool",
        inside=f'<body name="tool" gravcomp="1">{INERTIAL}</body>',
    )


def test_a_spring_is_refused():
    refused(
        r"joint 'shoulder' has a spring \(stiffness\)",
        upper_joint='axis="0 1 0" range="-2 2" stiffness="5"',
    )


def test_a_spring_in_a_default_class_is_refused():
    refused("has a spring", top='<default><joint stiffness="5"/></default>')


def test_a_missing_velocity_limit_is_refused_and_says_how_to_give_it():
    with pytest.raises(
        ModelError, match=r"no velocity_limit for joint shoulder, elbow\. Pass velocity"
    ):
        Robot.from_mjcf(model())


def test_a_missing_torque_limit_is_refused():
    refused(
        "no torque_limit for joint elbow",
        actuators='<motor joint="shoulder" ctrlrange="-5 5"/>',
    )


def test_a_position_actuator_without_a_force_range_gives_no_torque_limit():
    refused(
        "no torque_limit for joint shoulder",
        actuators='<position joint="shoulder" ctrlrange="-2 2"/>'
        '<motor joint="elbow" ctrlrange="-20 20"/>',
    )


def test_a_missing_position_limit_is_refused():
    refused("no position_limit for joint elbow", lower_joint='axis="0 1 0"')


def test_torques_that_cannot_hold_the_arm_are_refused():
    refused(
        "cannot hold joint",
        actuators='<motor joint="shoulder" ctrlrange="-5 5"/>'
        '<motor joint="elbow" ctrlrange="-20 20"/>',
    )


def test_a_missing_file_is_refused_by_its_name(tmp_path):
    with pytest.raises(ModelError, match=r"there is no model file '.*nowhere.xml'"):
        load(tmp_path / "nowhere.xml")


def test_a_folder_is_no_model_file(tmp_path):
    with pytest.raises(ModelError, match="there is no model file"):
        load(tmp_path)


def test_malformed_xml_is_refused():
    with pytest.raises(ModelError, match="not well-formed XML"):
        load("<mujoco><worldbody>")


def test_a_model_without_joints_is_refused():
    text = f'<mujoco><worldbody><body name="b">{INERTIAL}</body></worldbody></mujoco>'
    with pytest.raises(ModelError, match="the model has no joints"):
        load(text)


def test_limits_for_an_unknown_joint_are_refused_with_those_that_exist():
    with pytest.raises(
        UnknownName, match=r"unknown joint 'elbo'.*Did you mean 'elbow'"
    ):
        load(torque_limit={"elbo": 5.0})


@pytest.mark.parametrize(
    "limit", ["velocity_limit", "torque_limit", "acceleration_limit", "position_limit"]
)
def test_limits_of_the_wrong_length_are_refused(limit):
    with pytest.raises(InputError, match=rf"{limit} has shape \(3,\)"):
        load(**{limit: [1.0, 2.0, 3.0]})


@pytest.mark.parametrize(
    "limit", ["velocity_limit", "torque_limit", "acceleration_limit", "position_limit"]
)
@pytest.mark.parametrize("value", [0.0, -1.0, {"elbow": -1.0, "shoulder": 1.0}])
def test_limits_that_are_not_positive_are_refused(limit, value):
    with pytest.raises(InputError, match=rf"{limit} of joint '.*' must be greater"):
        load(**{limit: value})


def test_a_limit_that_is_nan_counts_as_missing():
    with pytest.raises(ModelError, match="no velocity_limit for joint elbow"):
        load(velocity_limit=[1.0, np.nan])


@pytest.mark.parametrize("home", [[0.0], [np.nan, 0.0], [np.inf, 0.0], "home"])
def test_a_home_that_is_no_posture_is_refused(home):
    with pytest.raises(InputError, match="q_home"):
        load(q_home=home)


# ----------------------------------------------------------------------------- URDF

LIMIT = '<limit lower="-1" upper="1" effort="50" velocity="3"/>'


def urdf(limit: str = LIMIT, kind: str = "revolute") -> str:
    link = (
        '<inertial><mass value="1"/><origin xyz="0 0 .1"/><inertia ixx=".01" '
        'iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    return f"""<robot name="one"><link name="base"/><link name="arm">{link}</link>
      <joint name="hinge" type="{kind}"><parent link="base"/><child link="arm"/>
        <axis xyz="0 1 0"/>{limit}</joint></robot>"""


@pytest.fixture
def urdf_file(tmp_path):
    def write(text: str):
        path = tmp_path / "one.urdf"
        path.write_text(text)
        return path

    return write


def test_a_urdf_is_read_with_its_limits(urdf_file):
    robot = Robot.from_urdf(urdf_file(urdf()))
    assert robot.joint_names == ("hinge",)
    assert_allclose(
        [robot.q_min, robot.q_max, robot.v_max, robot.tau_max],
        [[-1.0], [1.0], [3.0], [50.0]],
    )
    assert robot.mjcf is None
    assert robot.name == "one"


@pytest.mark.parametrize(
    ("limit", "missing"),
    [
        ('<limit lower="-1" upper="1" effort="0" velocity="3"/>', "torque_limit"),
        ('<limit lower="-1" upper="1" effort="50" velocity="0"/>', "velocity_limit"),
    ],
)
def test_a_zero_in_a_urdf_counts_as_missing(urdf_file, limit, missing):
    with pytest.raises(ModelError, match=f"no {missing} for joint hinge"):
        Robot.from_urdf(urdf_file(urdf(limit)))


def test_what_a_urdf_leaves_out_may_be_given(urdf_file):
    limit = '<limit lower="-1" upper="1" effort="0" velocity="0"/>'
    robot = Robot.from_urdf(
        urdf_file(urdf(limit)), torque_limit=40.0, velocity_limit={"hinge": 2.0}
    )
    assert_allclose([robot.tau_max, robot.v_max], [[40.0], [2.0]])


def test_a_continuous_joint_of_a_urdf_is_refused(urdf_file):
    with pytest.raises(ModelError, match=r"^continuous joint 'hinge'.*revolute"):
        Robot.from_urdf(urdf_file(urdf(kind="continuous")))


def test_a_floating_joint_of_a_urdf_is_refused(urdf_file):
    with pytest.raises(ModelError, match=r"'hinge' has 6.*fixed-base.*Fix the base"):
        Robot.from_urdf(urdf_file(urdf(kind="floating")))


def test_a_missing_urdf_is_refused_by_its_name(tmp_path):
    with pytest.raises(ModelError, match=r"there is no model file '.*nowhere.urdf'"):
        Robot.from_urdf(tmp_path / "nowhere.urdf")


def test_a_malformed_urdf_is_refused(urdf_file):
    with pytest.raises(ModelError, match=r"Pinocchio cannot read '.*one.urdf'"):
        Robot.from_urdf(urdf_file("<robot>"))


# ------------------------------------------------------------------ names and states


def test_a_joint_is_found_by_its_name():
    assert load().joint_index("elbow") == 1


def test_an_unknown_joint_lists_those_that_exist():
    with pytest.raises(UnknownName, match="Valid names: shoulder, elbow") as caught:
        load().joint_index("hip")
    assert (caught.value.kind, caught.value.name) == ("joint", "hip")
    assert caught.value.valid == JOINTS


def test_an_unknown_frame_lists_those_that_exist():
    with pytest.raises(UnknownName, match=r"unknown frame 'tpi'\. Did you mean 'tip'"):
        load().state([0, 0]).frame("tpi")


@pytest.mark.parametrize(
    "name", ["q_min", "q_max", "v_max", "a_max", "tau_max", "q_home"]
)
def test_the_arrays_of_a_robot_cannot_be_written(name):
    with pytest.raises(ValueError, match="read-only"):
        getattr(load(), name)[0] = 1.0


def test_a_robot_cannot_be_changed():
    with pytest.raises(AttributeError):
        load().name = "other"


@pytest.mark.parametrize("which", ["q", "v"])
@pytest.mark.parametrize(
    "bad", [[0.0], [[0.0, 0.0]], [np.nan, 0.0], [np.inf, 0.0], "ab", None]
)
def test_a_state_of_unusable_numbers_is_refused(which, bad):
    if which == "v" and bad is None:
        assert_array_equal(load().state([0, 0], None).v, [0.0, 0.0])
        return
    values = {"q": [0.0, 0.0], "v": [0.0, 0.0]} | {which: bad}
    with pytest.raises(InputError, match=f"^{which} "):
        load().state(**values)


@pytest.mark.parametrize("bad", [[0.0] * 3, [np.nan] * 6])
def test_a_wrench_of_unusable_numbers_is_refused(bad):
    with pytest.raises(InputError, match="wrench 'wrist'"):
        load().state([0, 0], wrenches={"wrist": bad})


def test_a_state_copies_what_it_is_made_of():
    q = np.array([0.1, 0.2])
    state = load().state(q)
    q[:] = 9.0
    assert_array_equal(state.q, [0.1, 0.2])


def test_the_drift_of_a_frame_is_its_acceleration_without_joint_acceleration():
    robot, h = load(), 1e-6
    q, v = np.array([0.3, -0.4]), np.array([1.0, -2.0])
    ahead, behind = (robot.state(q + s * h * v, v).frame("tip").V for s in (1, -1))
    drift = robot.state(q, v).frame("tip").drift
    assert_allclose((ahead - behind) / (2 * h), drift, atol=1e-7)


def test_parts_of_a_frame_may_be_asked_for_alone_and_first():
    robot, q, v = load(), [0.3, -0.4], [1.0, -2.0]
    whole = robot.state(q, v).frame("tip")
    assert_array_equal(robot.state(q, v).position("tip"), whole.p)
    assert_array_equal(robot.state(q, v).jacobian("tip"), whole.J)
    for ask in (State.position, State.jacobian):
        with pytest.raises(UnknownName, match="tpi"):
            ask(robot.state(q, v), "tpi")


def test_a_part_of_a_frame_that_was_asked_for_stays_as_it_was():
    robot = load()
    state = robot.state([0.3, -0.4])
    p, J = state.position("tip"), state.jacobian("tip")
    before = p.copy(), J.copy()
    state.refresh(np.array([1.0, 1.0]), np.zeros(2), 0.0)
    assert np.abs(state.position("tip") - p).max() > 0.1
    assert_array_equal(p, before[0])
    assert_array_equal(J, before[1])


def test_the_bias_at_rest_is_gravity():
    state: State = load().state([0.3, -0.4])
    assert_allclose(state.h, state.gravity(), atol=1e-12)


def test_every_error_of_the_library_has_one_base():
    for kind in (InputError, ModelError, UnknownName, StaleError):
        assert issubclass(kind, WbcError)
