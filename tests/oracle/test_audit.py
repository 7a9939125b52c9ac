"""The audit finds nothing in a clean arm and names each trap in a broken one."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from robots import racer
from sims.audit import Audit, Check, Finding, audit
from wbc.errors import InputError, ModelError

EXACT = 1e-10  # M [kg m^2], h [Nm], J, drift [m/s^2] and poses of the racer
PLACES = {
    "compiler": "",
    "option": "",
    "default": "",
    "root": "",
    "upper": "",
    "inertial": '<inertial mass="3" pos=".2 0 .02" diaginertia=".05 .04 .03"/>',
    "j1": "",
    "j2": "",
    "geom": "",
    "wrap": "",
    "unwrap": "",
    "second": "",
    "motors": '<actuator><motor joint="j1" ctrlrange="-90 90"/>'
    '<motor joint="j2" ctrlrange="-40 40"/></actuator>',
    "extra": "",
}
TWO_AXES = """<mujoco model="two">
  <compiler angle="radian" {compiler}/> {option} <default>{default}</default>
  <worldbody>
    <body name="base" {root}>
      <inertial mass="1" pos="0 0 0" diaginertia=".01 .01 .01"/>
      <body name="upper" pos="0 0 .3" {upper}> {inertial} {geom}
        <joint name="j1" axis="0 1 0" range="-2 2" {j1}/>
        {wrap}
        <body name="fore" pos=".4 0 0">
          <inertial mass="2" pos=".1 .05 0" diaginertia=".02 .03 .04"/>
          <joint name="j2" axis="0 0 1" range="-1 2" {j2}/>
          <site name="tip" pos=".3 0 0"/>
        </body>
        {unwrap}
      </body>
    </body>
    {second}
  </worldbody>
  {motors} {extra}
  <custom><numeric name="velocity_limit" data="3 3"/></custom>
</mujoco>"""
SECOND = """<body name="other"><joint name="j3"/>
  <inertial mass="1" pos="0 0 0" diaginertia=".01 .01 .01"/></body>"""
# What breaks the file, what the finding is called, and what its place must mention.
BROKEN: dict[str, tuple[dict[str, str], str, str]] = {
    "second root": ({"second": SECOND}, "second root dropped", "other"),
    "moved root": ({"root": 'pos="0 .4 0"'}, "root pose ignored", "base"),
    "turned root": ({"root": 'euler=".3 0 0"'}, "root pose ignored", "base"),
    "gravcomp": ({"upper": 'gravcomp="1"'}, "gravcomp", "upper"),
    "spring": ({"j1": 'stiffness="5"'}, "spring", "j1"),
    "gravity": ({"option": '<option gravity="0 0 -1.6"/>'}, "gravity", "option"),
    "no gravity": (
        {"option": '<option><flag gravity="disable"/></option>'},
        "gravity",
        "disable",
    ),
    "fluid": ({"option": '<option viscosity="1"/>'}, "fluid", "j1"),
    "mesh inertia": (
        {
            "inertial": "",
            "geom": '<geom type="mesh" mesh="m"/>',
            "extra": '<asset><mesh name="m" '
            'vertex="0 0 0 .1 0 0 0 .2 0 0 0 .3"/></asset>',
        },
        "inertial missing",
        "upper",
    ),
    "scaled mass": ({"compiler": 'settotalmass="12"'}, "settotalmass", "settotal"),
    "balanced inertia": (
        {
            "compiler": 'balanceinertia="true"',
            "inertial": '<inertial mass="3" pos="0 0 0" diaginertia=".05 .01 .01"/>',
        },
        "inertia",
        "inertias",
    ),
    "tendon armature": (
        {
            "extra": '<tendon><fixed armature=".2"><joint joint="j1" coef="1"/>'
            "</fixed></tendon>"
        },
        "tendon or actuator armature",
        "tendon",
    ),
    "equality": (
        {
            "extra": '<equality><joint name="loop" joint1="j1" joint2="j2"/></equality>'
        },
        "equality constraints",
        "loop",
    ),
    "frame": ({"wrap": '<frame pos="0 0 .1">', "unwrap": "</frame>"},
              "bodies or frames missing", "fore"),
    "long axis": ({"upper": 'axisangle="0 1 1 .4"'}, "orientation is no rotation",
                  "j1"),
    "unlimited": ({"j1": 'limited="false"'}, "position limits", "j1"),
    "reference": ({"j1": 'ref=".3"'}, "position limits", "j1"),
    "clipped torque": (
        {"j1": 'actuatorfrcrange="-95 95"'}, "torque limits", "j1"
    ),
}  # fmt: skip
REMARKS: dict[str, tuple[dict[str, str], str, str]] = {
    "damping": ({"j1": 'damping=".5"'}, "damping", "j1"),
    "friction": ({"j2": 'frictionloss=".7"'}, "frictionloss", "j2"),
    "no motors": ({"motors": ""}, "no torque limits", "j1, j2"),
    "servo": (
        {"motors": '<actuator><position name="s" joint="j1"/></actuator>'},
        "actuators other than motors",
        "s",
    ),
    "box inertia": (
        {"inertial": "", "geom": '<geom type="box" size=".1 .1 .1"/>'},
        "inertial missing",
        "upper",
    ),
    "two joints": (
        {"geom": '<joint name="j0" axis="1 0 0" range="-1 1"/>'},
        "joints merged",
        "Composite",
    ),
}
URDF = """<robot name="branches">
  <link name="base">{base}</link>
  <joint name="zed" type="revolute"><parent link="base"/><child link="a"/>
    <origin xyz="0 0 .3"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="30" velocity="3"/><dynamics damping=".4"/>
  </joint>
  <link name="a"><inertial><origin xyz=".2 0 .02" rpy=".1 .2 .3"/><mass value="3"/>
    <inertia ixx=".05" iyy=".04" izz=".03" ixy=".001" ixz=".002" iyz="0"/></inertial>
    <visual><geometry><mesh filename="package://cell/a.dae"/></geometry></visual></link>
  <joint name="{second}" type="{kind}"><parent link="base"/><child link="b"/>
    <origin xyz=".4 0 0" rpy=".3 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="20" velocity="2"/></joint>
  <link name="b">{b}</link>
  <joint name="mount" type="fixed"><parent link="b"/><child link="tool"/>
    <origin xyz="0 0 .2"/></joint>
  <link name="tool"/>
</robot>"""
LINK = """<inertial><origin xyz=".1 .05 0"/><mass value="2"/>
  <inertia ixx=".02" iyy=".03" izz=".04" ixy="0" ixz="0" iyz="0"/></inertial>"""


def broken(folder: Path, **changes: str) -> Path:
    path = folder / "two.xml"
    path.write_text(TWO_AXES.format(**(PLACES | changes)))
    return path


def urdf(folder: Path, **changes: str) -> Path:
    path = folder / "branches.urdf"
    base = {"base": LINK, "b": LINK, "second": "zulu", "kind": "revolute"}
    path.write_text(URDF.format(**(base | changes)))
    return path


def check(report: Audit, start: str) -> Check:
    return next(c for c in report.checks if c.name.startswith(start))


def finding(report: Audit, what: str) -> Finding:
    found = [f for f in report.findings if f.what == what]
    assert found, f"{what} is not among {[f.what for f in report.findings]}"
    return found[0]


@pytest.fixture(scope="module")
def clean(tmp_path_factory) -> Audit:
    path = tmp_path_factory.mktemp("racer") / "racer.xml"
    path.write_text(racer.mjcf())
    return audit(path)


def test_the_racer_agrees(clean):
    assert clean.agrees
    assert all(c.ok for c in clean.checks)
    assert not [f for f in clean.findings if f.severity == "error"]


@pytest.mark.parametrize(
    "name", ["M", "h", "frame positions", "frame orientations", "J", "Jdot", "wbc"]
)
def test_the_racer_agrees_to_round_off(clean, name):
    assert check(clean, name).worst < EXACT


def test_the_racer_is_really_compared(clean):
    for name in ("M", "h", "J", "Jdot"):
        assert check(clean, name).worst > 0, "round-off of exactly 0: empty arrays?"


def test_the_racer_loads_in_wbc_which_reads_the_torque_limits_of_its_motors(clean):
    assert finding(clean, "wbc loads the file").severity == "note"
    unread = finding(clean, "torque limits not read")
    assert "no limit" in unread.pin
    assert "600, 950, 400, 60, 60, 30 Nm" in unread.mujoco


def test_the_intact_file_of_two_axes_agrees(tmp_path):
    report = audit(broken(tmp_path))
    assert report.agrees, report.text()
    assert all(c.ok for c in report.checks)


@pytest.mark.parametrize("trap", BROKEN)
def test_each_trap_is_an_error_with_its_name_and_its_place(tmp_path, trap):
    changes, what, where = BROKEN[trap]
    report = audit(broken(tmp_path, **changes))
    found = finding(report, what)
    assert found.severity == "error"
    assert where in found.where
    assert found.pin
    assert found.mujoco
    assert found.advice
    assert not report.agrees
    assert not [f.what for f in report.findings if "unexplained" in f.what]


@pytest.mark.parametrize("trap", BROKEN)
def test_every_check_that_differs_is_answered_by_an_error(tmp_path, trap):
    report = audit(broken(tmp_path, **BROKEN[trap][0]))
    errors = {f.what for f in report.findings if f.severity == "error"}
    for failed in (c for c in report.checks if not c.ok):
        assert set(failed.because) <= errors
        assert failed.where
    assert errors


@pytest.mark.parametrize("trap", BROKEN)
def test_wbc_mends_or_refuses_each_trap(tmp_path, trap):
    report = audit(broken(tmp_path, **BROKEN[trap][0]))
    assert "wbc's own model differs" not in {f.what for f in report.findings}
    refused = any(f.what == "wbc refuses the file" for f in report.findings)
    assert refused or check(report, "wbc's own model").ok


@pytest.mark.parametrize("trait", REMARKS)
def test_a_trait_that_both_engines_read_alike_is_a_note(tmp_path, trait):
    changes, what, where = REMARKS[trait]
    report = audit(broken(tmp_path, **changes))
    found = finding(report, what)
    assert found.severity == "note"
    assert where in found.where
    assert report.agrees, report.text()


@pytest.mark.parametrize(
    ("changes", "name", "because"),
    [
        ({"root": 'euler=".3 0 0"'}, "h", "root pose ignored"),
        ({"root": 'pos="0 .4 0"'}, "frame positions", "root pose ignored"),
        ({"option": '<option gravity="0 0 -1.6"/>'}, "h", "gravity"),
        ({"compiler": 'settotalmass="12"'}, "M", "settotalmass"),
        ({"second": SECOND}, "moving mass", "second root dropped"),
        ({"j1": 'stiffness="5"'}, "springs", "spring"),
    ],
)
def test_a_difference_is_traced_to_the_trait_that_makes_it(
    tmp_path, changes, name, because
):
    assert check(audit(broken(tmp_path, **changes)), name).because == (because,)


def test_two_traits_that_make_one_difference_are_both_named(tmp_path):
    option = '<option gravity="0 0 -1.6"/>'
    report = audit(broken(tmp_path, root='euler=".3 0 0"', option=option))
    assert check(report, "h").because == ("root pose ignored", "gravity")
    assert check(report, "frame positions").because == ("root pose ignored",)


def test_armature_that_both_engines_read_is_no_finding(tmp_path):
    report = audit(broken(tmp_path, j1='armature=".2"'))
    assert report.agrees
    assert check(report, "M").worst < EXACT


def test_armature_that_pinocchio_lacks_is_named_with_its_joint(tmp_path, monkeypatch):
    read = pin.buildModelFromMJCF

    def without_armature(path: str) -> pin.Model:
        model = read(path)
        model.armature = np.zeros(model.nv)
        return model

    monkeypatch.setattr("sims.audit.load.pin.buildModelFromMJCF", without_armature)
    report = audit(broken(tmp_path, j2='armature=".2"'))
    found = finding(report, "armature")
    assert found.where == "joint j2"
    assert (found.pin, found.mujoco) == ("0 kg m^2", "0.2 kg m^2")
    M = check(report, "M")
    assert M.where == "j2, j2"
    assert M.because == ("armature",)
    np.testing.assert_allclose(M.worst, 0.2)


def test_a_difference_without_a_known_cause_is_named_by_its_entry(
    tmp_path, monkeypatch
):
    read = pin.buildModelFromMJCF

    def with_another_axis(path: str) -> pin.Model:
        model = read(path)
        model.jointPlacements[2] = model.jointPlacements[2] * pin.SE3(
            pin.utils.rotate("x", 0.1), np.zeros(3)
        )
        return model

    monkeypatch.setattr("sims.audit.load.pin.buildModelFromMJCF", with_another_axis)
    report = audit(broken(tmp_path))
    found = finding(report, "M, joint-space inertia: unexplained")
    assert found.where in {"j1, j1", "j1, j2", "j2, j2"}
    assert found.pin.endswith("kg m^2")


def test_the_second_root_leaves_the_first_to_be_compared(tmp_path):
    report = audit(broken(tmp_path, second=SECOND))
    assert check(report, "joints known to one engine").where == "j3"
    assert check(report, "M").ok
    assert check(report, "frame positions").ok


def test_a_free_base_is_a_note_on_conventions(tmp_path):
    path = broken(tmp_path, root='pos="0 0 1"')
    text = path.read_text().replace(
        '<body name="base" pos="0 0 1">',
        '<body name="base" pos=".1 0 1" euler=".2 0 .3"><freejoint name="float"/>',
    )
    path.write_text(text)
    report = audit(path)
    assert finding(report, "free joint").where == "float"
    assert report.agrees, report.text()
    assert check(report, "frame positions").worst < EXACT


def test_slides_are_read_in_degrees_by_pinocchio(tmp_path):
    path = broken(tmp_path, j2='type="slide"')
    path.write_text(path.read_text().replace('angle="radian"', 'angle="degree"'))
    found = finding(audit(path), "position limits")
    assert found.where == "joint j2"
    assert "radian" in found.advice


def test_missing_mesh_files_are_named_and_the_rest_is_compared(tmp_path):
    asset = '<asset><mesh name="m" file="nowhere.stl"/></asset>'
    report = audit(
        broken(tmp_path, extra=asset, geom='<geom type="mesh" mesh="m"/>')
    )  # fmt: skip
    assert "nowhere.stl" in finding(report, "mesh files missing").mujoco
    assert check(report, "M").worst < EXACT


def test_what_wbc_refuses_is_reported_in_its_words(tmp_path):
    report = audit(broken(tmp_path, upper='gravcomp="1"'))
    said = finding(report, "wbc refuses the file")
    assert said.where == "Robot.from_mjcf"
    assert "gravcomp on body upper" in said.advice


def test_limits_that_nobody_gives_make_wbc_refuse(tmp_path):
    report = audit(broken(tmp_path, motors=""))
    assert "torque_limit" in finding(report, "wbc refuses the file").advice


def test_a_urdf_agrees_although_mujoco_needs_it_without_its_meshes(tmp_path):
    report = audit(urdf(tmp_path, second="zulu"))
    assert report.agrees, report.text()
    assert check(report, "M").worst < EXACT
    assert check(report, "torque limits").ok
    assert finding(report, "damping").where == "joint zed"
    assert finding(report, "velocity limits").severity == "note"
    assert finding(report, "wbc loads the file").where == "Robot.from_urdf"


def test_branches_of_a_urdf_come_in_another_order(tmp_path):
    report = audit(urdf(tmp_path, second="alpha"))
    found = finding(report, "joint order")
    assert found.pin == "alpha, zed"
    assert found.mujoco == "zed, alpha"
    assert found.severity == "error"
    assert check(report, "M").worst < EXACT


def test_a_continuous_joint_is_compared_by_its_angle(tmp_path):
    report = audit(urdf(tmp_path, kind="continuous"))
    assert report.agrees, report.text()
    assert finding(report, "no position limits").where == "joint zulu"


def test_a_massless_moving_link_is_refused_by_mujoco_alone(tmp_path):
    report = audit(urdf(tmp_path, b=""))
    assert "mjMINVAL" in finding(report, "MuJoCo cannot read the file").mujoco
    assert report.checks == ()
    assert not report.agrees


def test_what_pinocchio_alone_cannot_read_is_a_finding(tmp_path):
    path = tmp_path / "empty.xml"
    path.write_text("<mujoco/>")
    report = audit(path)
    assert "no body" in finding(report, "Pinocchio cannot read the file").pin
    assert not report.agrees


def test_malformed_xml_is_a_finding_of_each_engine(tmp_path):
    path = tmp_path / "torn.xml"
    path.write_text("<mujoco><worldbody>")
    report = audit(path)
    assert finding(report, "Pinocchio cannot read the file").pin
    assert finding(report, "MuJoCo cannot read the file").mujoco


def test_a_missing_file_is_a_model_error(tmp_path):
    with pytest.raises(ModelError, match=r"no model file '.*nowhere\.xml'"):
        audit(tmp_path / "nowhere.xml")


def test_a_file_of_another_kind_is_a_model_error(tmp_path):
    path = tmp_path / "notes.txt"
    path.write_text("no robot here")
    with pytest.raises(ModelError, match="neither an MJCF nor a URDF"):
        audit(path)


def test_no_states_are_refused(tmp_path):
    with pytest.raises(InputError, match="states"):
        audit(broken(tmp_path), states=0)


def test_the_same_seed_gives_the_same_audit(tmp_path):
    path = broken(tmp_path, root='euler=".3 0 0"')
    assert audit(path, seed=3) == audit(path, seed=3)
    assert audit(path, seed=3).checks != audit(path, seed=4).checks


def test_the_text_has_the_verdict_the_table_and_each_finding(tmp_path):
    report = audit(broken(tmp_path, root='euler=".3 0 0"'))
    text = report.text()
    assert "THEY DISAGREE (1 error" in text
    assert "because of: root pose ignored" in text
    for found in report.findings:
        assert found.what in text
    assert max(len(line) for line in text.splitlines()[1:]) <= 88


def test_an_infinite_limit_is_written_as_no_limit(tmp_path):
    text = audit(broken(tmp_path, j1='limited="false"')).text()
    assert "MuJoCo     no limit" in text


def test_auditing_leaves_standard_output_alone(tmp_path):
    code = "import sys; from sims.audit import audit; audit(sys.argv[1])"
    path = str(broken(tmp_path, second=SECOND))
    run = subprocess.run(
        [sys.executable, "-c", code, path], capture_output=True, text=True, check=True
    )
    assert run.stdout == ""
