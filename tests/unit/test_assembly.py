"""Mounting a tool on an arm."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from numpy.testing import assert_allclose

from robots import tools
from robots.assembly import mount
from wbc.errors import ModelError

ATOL = 1e-12  # poses [m]

INERTIAL = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
ARM = f"""
<mujoco model="arm">
  <compiler angle="radian"/>
  <worldbody>
    <site name="corner"/>
    <body name="base">{INERTIAL}
      <body name="link" pos="0 0 1">{INERTIAL}
        <joint name="hinge" axis="0 1 0"/>
        <site name="plain"/>
        <site name="tilted" pos=".1 .2 .3" euler="0.5 0 0.2"/>
        <site name="line" fromto="0 0 0 0 0 1" size=".1" type="capsule"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
FRAGMENT = f'<body name="tool">{INERTIAL}<site name="tip" pos="0 0 .1"/></body>'


def whole(content: str) -> str:
    return f"<mujoco>{content}<worldbody>{FRAGMENT}</worldbody></mujoco>"


def compiled(text: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return model, data


def test_tool_takes_the_pose_of_the_site():
    _, data = compiled(mount(ARM, FRAGMENT, at="tilted"))
    site, tool = data.site("tilted"), data.body("tool")
    assert_allclose(tool.xpos, site.xpos, atol=ATOL)
    assert_allclose(tool.xmat, site.xmat, atol=ATOL)


def test_tool_becomes_a_child_of_the_body_of_the_site():
    model, _ = compiled(mount(ARM, FRAGMENT, at="plain"))
    assert model.body(model.body("tool").parentid[0]).name == "link"


def test_total_mass_is_that_of_arm_and_tool():
    model, _ = compiled(mount(ARM, FRAGMENT, at="plain"))
    assert_allclose(np.sum(model.body_mass), 3.0)


def test_assets_defaults_and_sensors_of_the_tool_come_along():
    tool = whole(
        '<default><default class="t"><site rgba="1 0 0 1"/></default></default>'
        '<asset><material name="red" rgba="1 0 0 1"/></asset>'
        '<sensor><force name="wrist" site="tip"/></sensor>'
    )
    model, _ = compiled(mount(ARM, tool, at="plain"))
    assert model.material("red").id == 0
    assert model.sensor("wrist").id == 0


def test_every_tool_of_the_catalogue_can_be_mounted():
    for name in tools.names():
        model, _ = compiled(mount(ARM, tools.mjcf(name), at="tilted"))
        assert model.nbody > 3


def test_missing_site_lists_the_valid_ones():
    with pytest.raises(ModelError, match=r"'flange'.*plain, tilted, line"):
        mount(ARM, FRAGMENT)


def test_site_of_the_world_cannot_carry_a_tool():
    with pytest.raises(ModelError, match="corner"):
        mount(ARM, FRAGMENT, at="corner")


def test_site_placed_by_two_points_is_refused():
    with pytest.raises(ModelError, match="fromto"):
        mount(ARM, FRAGMENT, at="line")


@pytest.mark.parametrize(
    ("tool", "message"),
    [
        (FRAGMENT.replace("tip", "plain"), "site 'plain'"),
        (FRAGMENT.replace('"tool"', '"link"'), "body 'link'"),
        (FRAGMENT.replace("<body ", '<body pos="0 0 1" '), "own pose"),
        ("<mujoco><worldbody/></mujoco>", "exactly one root body"),
        ("<body", "not well-formed"),
        (whole("<option timestep='0.1'/>"), "cannot bring <option>"),
        (whole('<compiler angle="degree"/>'), "angle='degree'"),
        (whole("<default><geom group='1'/></default>"), "in classes"),
    ],
)
def test_tool_that_would_change_meaning_is_refused(tool, message):
    with pytest.raises(ModelError, match=message):
        mount(ARM, tool, at="plain")


def test_second_copy_of_a_tool_is_refused():
    once = mount(ARM, FRAGMENT, at="plain")
    with pytest.raises(ModelError, match="body 'tool', site 'tip'"):
        mount(once, FRAGMENT, at="tilted")
