"""What Pinocchio reads differently from MuJoCo is mended, or refused by name."""

from __future__ import annotations

import warnings

import mujoco
import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

from sims.audit import Check, audit
from wbc import ModelError, Robot
from wbc.mjcf import read_mjcf

EXACT = 1e-12
INERTIAL = '<inertial mass="2" pos=".1 .05 0" diaginertia=".02 .03 .04"/>'
MOTORS = """<motor joint="j1" ctrlrange="-90 90"/>
  <motor joint="j2" ctrlrange="-40 40"/>"""
ORIENTATIONS = {
    "quat": 'quat="2 .3 .1 0"',
    "axisangle": 'axisangle="0 3 4 {angle}"',
    "euler": 'euler="{angle} .2 -.5"',
    "xyaxes": 'xyaxes="1 1 0 0 1 1"',
    "zaxis": 'zaxis="1 2 -3"',
    "zaxis up": 'zaxis="0 0 2"',
    "zaxis down": 'zaxis="0 0 -2"',
}


def text(
    *,
    compiler: str = '<compiler angle="radian"/>',
    top: str = "",
    upper: str = "",
    upper_name: str = 'name="upper"',
    inertial: str = INERTIAL,
    j1: str = 'axis="0 1 0" range="-2 2"',
    j2: str = 'axis="0 0 1" range="-1 2"',
    site: str = 'pos=".3 0 0"',
    inside: str = "",
    motors: str = MOTORS,
    bottom: str = "",
) -> str:
    """Two axes, with a place for each trait."""
    return f"""<mujoco model="two">{compiler}{top}
  <worldbody>
    <body name="base">
      <body {upper_name} pos="0 0 .3" {upper}>
        {inertial}<joint name="j1" {j1}/>{inside}
        <body name="fore" pos=".4 0 0">{INERTIAL}
          <joint name="j2" {j2}/><site name="tip" {site}/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>{motors}</actuator>{bottom}
</mujoco>"""


def load(**changes) -> Robot:
    return Robot.from_mjcf(text(**changes), velocity_limit=3.0)


def refused(*said: str, **changes) -> None:
    with pytest.raises(ModelError) as caught:
        load(**changes)
    for words in said:
        assert words in str(caught.value)


@pytest.fixture
def own(tmp_path):
    """Audit a text: the worst check of wbc's model against MuJoCo's."""

    def compare(**changes) -> Check:
        path = tmp_path / "two.xml"
        path.write_text(text(**changes))
        checks = audit(path).checks
        return next(c for c in checks if c.name == "wbc's own model")

    return compare


def assert_ok(check: Check) -> None:
    assert check.ok, check


def limits_of_mujoco(**changes) -> tuple[np.ndarray, np.ndarray]:
    engine = mujoco.MjModel.from_xml_string(text(**changes))
    return engine.jnt_range[:, 0], engine.jnt_range[:, 1]


# ----------------------------------------------------------------- position limits


@pytest.mark.parametrize("kind", ["hinge", "slide"])
@pytest.mark.parametrize("unit", ["radian", "degree"])
def test_a_range_is_not_shifted_by_the_reference_of_its_joint(own, kind, unit):
    changes = {
        "compiler": f'<compiler angle="{unit}"/>',
        "j1": f'type="{kind}" axis="0 1 0" ref=".3" range="-2 2"',
    }
    robot = load(**changes)
    lower, upper = limits_of_mujoco(**changes)
    assert_allclose(robot.q_min, lower, atol=EXACT)
    assert_allclose(robot.q_max, upper, atol=EXACT)
    assert_ok(own(**changes))


def test_the_range_of_a_slide_is_in_metres_whatever_the_unit_of_angles():
    robot = load(compiler="", j2='type="slide" range="-.5 .7"')
    assert robot.q_min[1] == -0.5
    assert robot.q_max[1] == 0.7
    assert_allclose(robot.q_max[0], np.radians(2))


@pytest.mark.parametrize(
    "changes",
    [
        {"j1": 'limited="false" axis="0 1 0" range="-2 2"'},
        {"top": '<default><joint limited="false"/></default>'},
    ],
)
def test_a_joint_that_is_not_limited_has_no_limit_although_it_has_a_range(changes):
    refused("no position_limit for joint j1", **changes)


@pytest.mark.parametrize("flag", ["true", "auto"])
def test_a_limited_joint_has_the_limits_of_its_range(flag):
    assert_allclose(load(j1=f'limited="{flag}" range="-2 1"').q_max[0], 1.0)


def test_without_autolimits_a_range_needs_limited():
    off = '<compiler angle="radian" autolimits="false"/>'
    said = "joint 'j1' has range but not limited"
    refused(said, "write limited='true'", compiler=off, motors="")
    limited = {
        "j1": 'limited="true" range="-2 2"',
        "j2": 'limited="true" range="-1 2"',
        "motors": "",
    }
    model = read_mjcf(text(compiler=off, **limited)).model
    assert_allclose(model.upperPositionLimit, [2, 2])


def test_a_limit_without_a_range_is_refused():
    refused("joint 'j1' has limited='true' but no proper range", j1='limited="true"')


# -------------------------------------------------------------------- orientations


@pytest.mark.parametrize("unit", ["radian", "degree"])
@pytest.mark.parametrize("name", ORIENTATIONS)
@pytest.mark.parametrize("place", ["upper", "site", "inertial"])
def test_every_orientation_means_to_wbc_what_it_means_to_mujoco(own, place, name, unit):
    pose = ORIENTATIONS[name].format(angle=".4" if unit == "radian" else "23")
    value = INERTIAL.replace("/>", f" {pose}/>") if place == "inertial" else pose
    check = own(compiler=f'<compiler angle="{unit}"/>', **{place: value})
    assert_ok(check)


@pytest.mark.parametrize("sequence", ["xyz", "XYZ", "zyx", "ZXY", "xyX", "zYz"])
def test_every_euler_sequence_means_to_wbc_what_it_means_to_mujoco(own, sequence):
    compiler = f'<compiler angle="radian" eulerseq="{sequence}"/>'
    assert_ok(own(compiler=compiler, upper='euler=".3 -.5 .7"'))


def test_a_word_that_is_no_euler_sequence_is_refused():
    refused(
        "eulerseq='xya'", compiler='<compiler eulerseq="xya"/>', upper='euler="1 2 3"'
    )


@pytest.mark.parametrize(
    "pose", ['pos=".1 .2 .3"', 'pos=".1 0 0" quat="1 1 0 0"', 'axisangle="0 1 1 .4"']
)
def test_a_site_takes_the_pose_of_its_default_class(own, pose):
    assert_ok(own(top=f"<default><site {pose}/></default>", site=""))


@pytest.mark.parametrize("own_pose", ['quat="1 1 0 0"', 'euler=".1 .2 .3"'])
def test_a_sites_own_orientation_wins_over_that_of_its_class(own, own_pose):
    top = '<default><site axisangle="0 1 0 .4"/></default>'
    assert_ok(own(top=top, site=own_pose))


def test_two_orientations_of_one_element_are_refused():
    refused("more than one orientation (euler, zaxis)",
            upper='euler="1 0 0" zaxis="1 0 0"')  # fmt: skip


@pytest.mark.parametrize(
    ("place", "value", "what"),
    [
        ("upper", 'quat="0 0 0 0"', "quat of body 'upper'"),
        ("upper", 'axisangle="0 0 0 1"', "axisangle of body 'upper'"),
        ("j1", 'axis="0 0 0" range="-1 1"', "axis of joint 'j1'"),
    ],
)
def test_a_direction_of_length_zero_is_refused(place, value, what):
    refused(f"{what} has length 0", **{place: value})


@pytest.mark.parametrize(
    "changes",
    [
        {"site": 'fromto="0 0 0 .1 .2 .3"'},
        {"top": '<default><site fromto="0 0 0 .1 .2 .3"/></default>'},
    ],
)
def test_a_site_placed_by_fromto_is_refused(changes):
    refused("site 'tip' is placed by fromto", "write pos and zaxis", **changes)


def test_a_joint_away_from_its_body_about_a_long_axis_agrees_with_mujoco(own):
    assert_ok(own(j1='axis="0 3 4" pos=".1 .2 .3" ref=".2" range="-2 2"'))


# ------------------------------------------------- order, classes, names, numbers


def test_a_compiler_and_defaults_that_come_last_count(own):
    late = '<compiler angle="radian"/><default><joint armature=".2"/></default>'
    assert_ok(own(compiler="", bottom=late))
    assert_allclose(read_mjcf(text(compiler="", bottom=late)).model.armature, [0.2] * 2)


def test_of_several_compilers_the_last_word_counts(own):
    several = '<compiler angle="degree"/><compiler angle="radian"/><compiler/>'
    assert_ok(own(compiler=several))
    assert_allclose(load(compiler=several).q_max, [2, 2])


def test_defaults_may_come_in_several_sections(own):
    top = (
        '<default><joint armature=".2"/></default>'
        '<default><default class="k"><joint damping=".1"/></default></default>'
    )
    assert_ok(own(top=top, j1='class="k" axis="0 1 0" range="-2 2"'))
    assert_allclose(read_mjcf(text(top=top)).model.armature, [0.2, 0.2])


def test_an_unknown_default_class_is_refused_with_those_that_exist():
    refused("joint 'j1'", "class 'nope'", "Classes: main",
            j1='class="nope" range="-1 1"')  # fmt: skip


def test_a_body_without_a_name_is_still_a_body(own):
    assert_ok(own(upper_name=""))


def test_a_joint_without_a_name_is_refused():
    with pytest.raises(ModelError, match="joint of body 'upper' has no name"):
        read_mjcf(text().replace('name="j1"', ""))


def test_two_joints_in_one_body_are_refused():
    refused("body 'upper' has 2 joints (j1, j0)", "write one body for each",
            inside='<joint name="j0" axis="1 0 0"/>')  # fmt: skip


def test_two_joints_of_one_name_are_refused():
    with pytest.raises(ModelError, match="joint 'j1' exists more than once"):
        read_mjcf(text().replace('name="j2"', 'name="j1"'))


@pytest.mark.parametrize(
    ("place", "value"),
    [("j1", 'axis="0 1" range="-1 1"'), ("upper", 'quat="1 0 0 x"'),
     ("j1", 'range="-1"'), ("inertial", '<inertial mass="two" pos="0 0 0"/>')],
)  # fmt: skip
def test_what_are_not_the_right_numbers_is_refused(place, value):
    refused("must be", **{place: value})


def test_a_urdf_is_refused_with_the_reader_for_it():
    with pytest.raises(ModelError, match=r"<robot> file.*Robot\.from_urdf"):
        Robot.from_mjcf('<robot name="r"><link name="a"/></robot>')


# --------------------------------------------------------------- masses and inertias


@pytest.mark.parametrize(
    "said",
    ["settotalmass='12'", "balanceinertia='true'", "boundmass='.1'",
     "boundinertia='.1'"],
)  # fmt: skip
def test_a_compiler_that_changes_masses_is_refused(said):
    refused(f"<compiler {said}>", "Remove it", compiler=f"<compiler {said}/>")


@pytest.mark.parametrize(
    "said", ["settotalmass='-1'", "balanceinertia='false'", "boundmass='0'"]
)
def test_a_compiler_that_changes_nothing_is_read(said):
    assert load(compiler=f"<compiler angle='radian' {said}/>").nv == 2


def test_inertias_from_geoms_are_refused_for_what_they_are():
    refused("infers every inertia from geoms", "not for meshes", "write <inertial>",
            compiler='<compiler inertiafromgeom="true"/>')  # fmt: skip


def test_a_full_inertia_agrees_with_mujoco(own):
    full = 'fullinertia=".05 .04 .03 .001 .002 -.003"'
    assert_ok(own(inertial=f'<inertial mass="3" pos=".2 0 .02" {full}/>'))


@pytest.mark.parametrize(
    ("bottom", "motors", "what"),
    [
        ('<tendon><fixed name="t" armature=".2"><joint joint="j1" coef="1"/></fixed>'
         "</tendon>", MOTORS, "fixed 't' of <tendon>"),
        ("", '<motor name="m" joint="j1" armature=".1"/>', "motor 'm' of <actuator>"),
    ],
)  # fmt: skip
def test_armature_that_is_not_on_a_joint_is_refused(bottom, motors, what):
    refused(what, "put it on the joints", bottom=bottom, motors=motors)


@pytest.mark.parametrize("tag", ["tendon", "general"])
def test_armature_of_tendons_and_actuators_is_found_in_their_defaults(tag):
    tendon = '<tendon><fixed><joint joint="j1" coef="1"/></fixed></tendon>'
    top = f'<default><{tag} armature=".1"/></default>'
    refused("has armature", top=top, bottom=tendon)


# ---------------------------------------------------------- passive torques, gravity


def test_a_spring_on_a_tendon_is_refused():
    tendon = '<fixed name="t" stiffness="3"><joint joint="j1" coef="1"/></fixed>'
    refused("fixed 't'", "has a spring", bottom=f"<tendon>{tendon}</tendon>")


def test_a_spring_given_by_its_time_constant_is_refused():
    refused("joint 'j1' has a spring (springdamper)", j1='springdamper=".1 1"')


@pytest.mark.parametrize("what", ["density", "viscosity"])
def test_a_fluid_is_refused(what):
    refused(f"<option {what}='1'>", "fluid", top=f"<option {what}='1'/>")


def test_a_fluid_that_a_later_option_takes_away_is_none():
    assert load(top='<option density="1"/><option density="0"/>').nv == 2


@pytest.mark.parametrize(
    "option", ['actuatorgroupdisable="2"/>', '><flag actuation="disable"/></option>']
)
def test_disabled_actuators_are_refused(option):
    refused("disables actuators", top=f"<option {option}")


def test_losses_of_joints_tendons_and_actuators_are_noted():
    tendon = '<fixed name="t" damping="2"><joint joint="j1" coef="1"/></fixed>'
    notes = load(
        j1='axis="0 1 0" range="-2 2" frictionloss=".1"',
        motors=MOTORS.replace("<motor", '<motor name="m" damping=".1"', 1),
        bottom=f"<tendon>{tendon}</tendon>",
    ).notes
    assert [note.split(",")[0] for note in notes] == [
        "joint 'j1' has frictionloss",
        "fixed 't' has damping",
        "motor 'm' has damping",
    ]


def test_the_range_of_a_tendon_is_noted():
    tendon = '<fixed name="t" range="-1 1"><joint joint="j1" coef="1"/></fixed>'
    (note,) = load(bottom=f"<tendon>{tendon}</tendon>").notes
    assert note.startswith("fixed 't' has a range")


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ("", -9.81),
        ('<option gravity="0 0 -1.6"/>', -1.6),
        ('<option gravity="0 0 -1"/><option gravity="0 0 -2"/>', -2.0),
        ('<option><flag gravity="disable"/></option>', 0.0),
        ('<option><flag gravity="disable"/></option><option gravity="0 0 -3"/>', 0.0),
        ('<option gravity="0 0 -3"><flag gravity="disable"/></option>'
         '<option><flag gravity="enable"/></option>', -3.0),
    ],
)  # fmt: skip
def test_gravity_is_what_mujoco_applies(own, options, expected):
    linear = read_mjcf(text(top=options)).model.gravity.linear
    assert_allclose(linear, [0, 0, expected])
    assert_ok(own(top=options))


# --------------------------------------------------------------------- torque limits

J2 = '<motor joint="j2" ctrlrange="-40 40"/>'
TORQUES = {
    "a second motor adds up": (
        "", MOTORS + '<motor joint="j1" ctrlrange="-10 10" gear="2"/>', 110.0),
    "opposing motors add up": (
        "", '<motor joint="j1" ctrlrange="0 30"/>'
        '<motor joint="j1" ctrlrange="0 30" gear="-1"/>', 30.0),
    "general defaults reach motors": (
        '<default><general ctrlrange="-7 7" gear="3"/></default>',
        '<motor joint="j1"/>', 21.0),
    "motor defaults reach generals": (
        '<default><motor ctrlrange="-7 7" gear="3"/></default>',
        '<general joint="j1"/>', 21.0),
    "a motor has no gain of its class": (
        '<default><general gainprm="5"/></default>',
        '<motor joint="j1" ctrlrange="-7 7"/>', 7.0),
    "a position default is reset by a motor": (
        '<default><position kp="5" ctrlrange="-7 7"/></default>',
        '<motor joint="j1"/>', 7.0),
    "a general without bias is a motor": (
        "", '<general joint="j1" ctrlrange="-2 2" gainprm="50" gear="-3"/>', 300.0),
    "a general without bias keeps the gain of a position default": (
        '<default><position kp="5" ctrlrange="-7 7"/></default>',
        '<general joint="j1" biastype="none"/>',
        35.0,
    ),
    "a servo is limited by force alone": (
        "", '<position joint="j1" ctrlrange="-2 2" forcerange="-5 5" gear="2"/>', 10.0),
    "the tighter of force and control": (
        "", '<motor joint="j1" ctrlrange="-9 9" forcerange="-5 5"/>', 5.0),
    "forcelimited false": (
        "", '<motor joint="j1" ctrlrange="-9 9" forcerange="-5 5" '
        'forcelimited="false"/>', 9.0),
    "ctrllimited false": (
        "", '<motor joint="j1" ctrlrange="-3 3" ctrllimited="false" '
        'forcerange="-5 5"/>', 5.0),
    "the joint within its parent": (
        "", '<motor jointinparent="j1" ctrlrange="-3 3"/>', 3.0),
    "a lopsided motor counts with its smaller side": (
        "", '<motor joint="j1" ctrlrange="-3 8"/>', 3.0),
}  # fmt: skip


@pytest.mark.parametrize("case", TORQUES)
def test_torque_limits_are_those_of_mujocos_actuators(own, case):
    top, motors, expected = TORQUES[case]
    motors = motors if "j2" in motors else motors + J2
    assert read_mjcf(text(top=top, motors=motors)).torque["j1"] == pytest.approx(
        expected
    )
    assert_ok(own(top=top, motors=motors))


def test_a_motor_without_a_limit_leaves_its_joint_without_one():
    free = '<motor joint="j1" ctrlrange="-3 3" ctrllimited="false"/>'
    refused("no torque_limit for joint j1", motors=free + J2)


def test_an_unlimited_motor_makes_the_others_on_its_joint_no_limit():
    refused("no torque_limit for joint j1", motors=f'{MOTORS}<motor joint="j1"/>')


def test_the_force_range_of_a_joint_bounds_the_sum_of_its_motors(own):
    changes = {"j1": 'axis="0 1 0" range="-2 2" actuatorfrcrange="-50 50"'}
    assert load(**changes).tau_max[0] == 50.0
    assert_ok(own(**changes))
    ignored = changes["j1"] + ' actuatorfrclimited="false"'
    assert load(j1=ignored).tau_max[0] == 90.0
    assert_ok(own(j1=ignored))


def test_a_lopsided_motor_is_noted_with_the_side_that_counts():
    lopsided = '<motor joint="j1" ctrlrange="-50 80"/>'
    (note,) = load(motors=lopsided + J2).notes
    assert note.startswith("joint 'j1' can be driven from -50 to 80")
    assert "+-50, the smaller side" in note


def test_motors_that_push_one_way_only_are_refused():
    refused("motors of joint 'j1' push one way only (0 to 30)", "both signs",
            motors='<motor joint="j1" ctrlrange="0 30"/>' + J2)  # fmt: skip


def test_an_actuator_of_an_unknown_joint_is_refused():
    refused("motor 'm' drives joint 'j3': no such joint",
            motors=MOTORS + '<motor name="m" joint="j3"/>')  # fmt: skip


def test_a_servo_is_noted():
    servo = '<position name="s" joint="j1" forcerange="-90 90"/>'
    (note,) = load(motors=servo + J2).notes
    assert note.startswith("position 's' is not a motor on a joint")


# ------------------------------------------------------------- one joint, no inertia

ONE = f"""<mujoco><compiler angle="radian"/><worldbody><body name="base">
  <body name="arm">{INERTIAL}<joint name="j" axis="0 1 0" range="-2 2"/>
    <site name="tip" pos=".3 0 0"/></body></body></worldbody>
  <actuator><motor joint="j" ctrlrange="-40 40"/></actuator></mujoco>"""


def test_a_robot_of_one_joint_has_matrices_of_one_column():
    robot = Robot.from_mjcf(ONE, velocity_limit=3.0)
    state = robot.state([0.4], [1.5])
    tip = state.frame("tip")
    assert tip.J.shape == (6, 1)
    assert state.M.shape == (1, 1)
    assert state.h.shape == state.gravity().shape == robot.a_max.shape == (1,)
    assert_allclose(tip.V, tip.J[:, 0] * 1.5, atol=EXACT)


def test_a_robot_of_one_joint_agrees_with_mujoco():
    engine = mujoco.MjModel.from_xml_string(ONE)
    data, J = mujoco.MjData(engine), np.zeros((6, 1))
    data.qpos[:], data.qvel[:] = 0.4, 1.5
    mujoco.mj_forward(engine, data)
    mujoco.mj_jacSite(engine, data, J[:3], J[3:], data.site("tip").id)
    state = Robot.from_mjcf(ONE, velocity_limit=3.0).state([0.4], [1.5])
    assert_allclose(state.frame("tip").J, J, atol=EXACT)
    assert_allclose(state.h, data.qfrc_bias, atol=EXACT)


LINK = """<inertial><mass value="2"/><origin xyz=".1 0 0"/>
  <inertia ixx=".02" iyy=".03" izz=".04" ixy="0" ixz="0" iyz="0"/></inertial>"""
CHAIN = """<robot name="chain"><link name="base"/>
  <joint name="a" type="revolute"><parent link="base"/><child link="one"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="9" velocity="2"/></joint>
  <link name="one">{one}</link>
  <joint name="b" type="revolute"><parent link="one"/><child link="two"/>
    <axis xyz="{axis}"/><limit lower="-1" upper="1" effort="9" velocity="2"/></joint>
  <link name="two">{two}</link></robot>"""


@pytest.mark.parametrize(
    ("one", "two", "axis", "joint"),
    [
        (LINK, "", "0 1 0", "b"),
        ("", LINK, "0 0 1", "[ab]"),
        ("", "", "0 1 0", "[ab]"),
    ],
)
def test_a_joint_that_moves_no_inertia_is_refused_by_its_name(
    tmp_path, one, two, axis, joint
):
    path = tmp_path / "chain.urdf"
    path.write_text(CHAIN.format(one=one, two=two, axis=axis))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(ModelError, match=f"joint '{joint}' moves no inertia"):
            Robot.from_urdf(path)


def test_a_massless_link_between_joints_is_fine_if_the_next_has_inertia(tmp_path):
    path = tmp_path / "chain.urdf"
    path.write_text(CHAIN.format(one="", two=LINK, axis="0 1 0"))
    assert Robot.from_urdf(path, acceleration_limit=1.0).nv == 2


def test_torques_that_cannot_hold_a_joint_name_it():
    refused("cannot hold joint 'j1'",
            motors=MOTORS.replace("-90 90", "-1 1"))  # fmt: skip


def test_the_mended_text_reaches_pinocchio_and_the_robot_keeps_the_users():
    robot = load(upper='axisangle="0 3 4 .4"')
    assert robot.mjcf == text(upper='axisangle="0 3 4 .4"')
    R = robot.model.jointPlacements[1].rotation
    assert_allclose(R @ R.T, np.eye(3), atol=EXACT)
    assert isinstance(robot.model, pin.Model)
