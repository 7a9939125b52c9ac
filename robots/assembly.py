"""Mounting a tool on an arm: two MJCF texts in, one MJCF text out."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterator

from wbc.checks import expect
from wbc.errors import ModelError

__all__ = ["add_section", "mount", "parse"]

POSE = ("pos", "quat", "axisangle", "euler", "xyaxes", "zaxis")
"""Attributes that place a site or a body in its parent."""

MERGED = ("default", "asset", "contact", "equality", "tendon", "actuator", "sensor")
"""Sections of a tool that are appended to the same section of the arm."""


def mount(arm_xml: str, tool_xml: str, at: str = "flange") -> str:
    """Put a tool on an arm: its body becomes a child of the body that holds a site.

    The tool's frame takes the pose of the site. Both models stay readable by MuJoCo and
    Pinocchio, which has no notion of attachment.

    Args:
        arm_xml: MJCF text of the arm.
        tool_xml: a single ``<body>`` without pose, or an ``<mujoco>`` whose world holds
            one; its defaults, assets, sensors, actuators and the like come along.
        at: name of the site of the arm that receives the tool.

    Returns:
        MJCF text of the arm with the tool.

    Raises:
        ModelError: there is no such site, a name exists twice, or the tool says
            something about the whole model that the arm does not say.
        InputError: an argument is no text.
    """
    expect(str, arm_xml=arm_xml, tool_xml=tool_xml, at=at)
    arm, tool = parse(arm_xml, "arm_xml"), parse(tool_xml, "tool_xml")
    body = _tool_body(tool)
    parent, site = _site(arm, at)
    _check_names(arm, tool)
    if tool.tag == "mujoco":
        _merge_sections(arm, tool)
    body.attrib.update({key: site.attrib[key] for key in POSE if key in site.attrib})
    parent.append(body)
    ET.indent(arm)
    return ET.tostring(arm, encoding="unicode")


def parse(text: str, what: str) -> ET.Element:
    """Return the root element of an XML text.

    Raises:
        ModelError: the text is not well-formed.
    """
    try:
        return ET.fromstring(text)
    except ET.ParseError as error:
        raise ModelError(f"the {what} is not well-formed XML: {error}") from error


def _tool_body(tool: ET.Element) -> ET.Element:
    bodies = [tool] if tool.tag == "body" else tool.findall("worldbody/body")
    if len(bodies) != 1:
        raise ModelError(f"a tool has exactly one root body, this one {len(bodies)}")
    placed = [key for key in POSE if key in bodies[0].attrib]
    if placed:
        raise ModelError(
            f"the tool's root body has its own pose ({', '.join(placed)}): "
            "the site places it; move the tool's content instead"
        )
    return bodies[0]


def _site(arm: ET.Element, at: str) -> tuple[ET.Element, ET.Element]:
    sites = {
        site.get("name", ""): (body, site)
        for body in arm.iter("body")
        for site in body.findall("site")
    }
    if at not in sites:
        valid = ", ".join(name for name in sites if name) or "(none)"
        raise ModelError(f"the arm has no site '{at}'. Sites on its bodies: {valid}.")
    if "fromto" in sites[at][1].attrib:
        raise ModelError(f"site '{at}' is placed by fromto: give it pos and quat")
    return sites[at]


def _names(root: ET.Element) -> Iterator[tuple[str, str]]:
    """(kind, name) of every named element; actuators and sensors are one kind each."""
    for section in root if root.tag == "mujoco" else [root]:
        shared = section.tag if section.tag in {"actuator", "sensor"} else None
        for element in section.iter():
            name = element.get("class" if element.tag == "default" else "name")
            if name and name != "main":
                yield shared or element.tag, name


def _check_names(arm: ET.Element, tool: ET.Element) -> None:
    clashes = sorted(set(_names(arm)) & set(_names(tool)))
    if clashes:
        listed = ", ".join(f"{kind} '{name}'" for kind, name in clashes)
        raise ModelError(f"arm and tool both define {listed}: rename one of them")


def _merge_sections(arm: ET.Element, tool: ET.Element) -> None:
    for section in tool:
        if section.tag == "compiler":
            _check_compiler(arm, section)
        elif section.tag != "worldbody":
            add_section(arm, section, "the tool")


def _check_compiler(arm: ET.Element, compiler: ET.Element) -> None:
    theirs = {} if (found := arm.find("compiler")) is None else found.attrib
    for key, value in compiler.attrib.items():
        if theirs.get(key) != value:
            raise ModelError(
                f"the tool is written for compiler {key}='{value}', "
                f"the arm for {key}='{theirs.get(key, '(default)')}'"
            )


def add_section(model: ET.Element, section: ET.Element, whose: str) -> None:
    """Append a section, such as <asset>, to the same section of another model.

    Raises:
        ModelError: the section speaks of the whole model.
    """
    if section.tag not in MERGED:
        raise ModelError(
            f"{whose} cannot bring <{section.tag}>, only {', '.join(MERGED)}"
        )
    if section.tag == "default" and any(child.tag != "default" for child in section):
        raise ModelError(f"{whose}'s defaults must be in classes, or they hit the rest")
    _section(model, section.tag).extend(section)


def _section(arm: ET.Element, tag: str) -> ET.Element:
    """Find a section of the arm, or start it before the world: readers go in order."""
    found = arm.find(tag)
    if found is None:
        found = ET.Element(tag)
        world = arm.find("worldbody")
        arm.insert(0 if world is None else list(arm).index(world), found)
    return found
