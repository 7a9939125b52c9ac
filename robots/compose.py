"""Several arms in one model, so that one stack of tasks can span them all."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import Final, final

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from robots.assembly import add_section, parse
from wbc import ModelError, Robot
from wbc.arrays import Array, frozen, rotation
from wbc.checks import expect, text

__all__ = ["Placed", "load", "mjcf"]

ROOT: Final = "arms"
"""Body that carries the bases; it sits at the origin of the world."""

NAMES: Final = frozenset(
    [
        *("name", "class", "childclass", "material", "mesh", "texture", "hfield"),
        *("joint", "joint1", "joint2", "jointinparent", "body", "body1", "body2"),
        *("site", "site1", "site2", "refsite", "cranksite", "slidersite", "sidesite"),
        *("geom", "geom1", "geom2", "tendon", "tendon1", "tendon2", "actuator"),
        *("target", "objname", "refname"),
    ]
)
"""Attributes that name an element of the model, or refer to one."""

FILES: Final = ("mesh", "texture", "hfield")
"""Assets that are called like their file where they have no name."""
APART: Final = ("worldbody", "compiler", "option", "keyframe", "custom")
"""Sections that are not appended: home and limits are written anew for all arms."""
SCENE: Final = ("statistic", "visual", "size")
"""Sections that belong to a scene, and are dropped."""


@final
@dataclass(frozen=True, slots=True, eq=False)
class Placed:
    """An arm and where its base stands.

    Attributes:
        mjcf: the arm's MJCF text, of which its home and limits are read.
        position: (3,) of the base in the world [m].
        R: (3, 3) orientation of the base in the world.

    Raises:
        InputError: a position that is not finite, or an R that is no rotation.
    """

    mjcf: str
    position: ArrayLike = (0.0, 0.0, 0.0)
    R: Array = field(default_factory=lambda: np.eye(3))

    def __post_init__(self) -> None:
        text(self.mjcf, "mjcf of a placed arm")
        object.__setattr__(self, "position", frozen(self.position, (3,), "position"))
        object.__setattr__(self, "R", rotation(self.R, "R of a placed arm"))


def mjcf(arms: Mapping[str, Placed]) -> str:
    """Return one MJCF text of several arms, for MuJoCo and for Pinocchio.

    Every name of an arm is preceded by the arm's own name and an underscore: joint
    ``joint1`` of arm ``puller`` is ``puller_joint1``. Body ``puller`` is where its base
    stands. The scene is to be made from this text, or from `Robot.mjcf`, and other
    things added to it.

    Args:
        arms: name -> arm, in the order of the joints.

    Raises:
        InputError: not a mapping from names to arms.
        ModelError: no arm, one called "arms", arms that disagree about compiler or
            options, or one that cannot be read.
    """
    expect(Mapping, arms=arms)
    for name, placed in arms.items():
        expect(Placed, **{f"arm '{text(name, 'name of an arm')}'": placed})
    if not arms:
        raise ModelError("there is no arm in arms: give at least one.")
    if ROOT in arms:
        raise ModelError(f"'{ROOT}' is the body of all arms: call that arm otherwise.")
    robots = [_single(name, placed) for name, placed in arms.items()]
    parsed = {name: _prefixed(placed.mjcf, name) for name, placed in arms.items()}
    whole = ET.Element("mujoco", model="_".join(arms))
    _write_settings(whole, parsed, robots)
    root = ET.SubElement(ET.SubElement(whole, "worldbody"), "body", name=ROOT)
    for name, arm in parsed.items():
        for section in arm:
            if section.tag not in (*APART, *SCENE):
                add_section(whole, section, f"arm '{name}'")
        base = ET.SubElement(root, "body", {"name": name, **_pose(arms[name])})
        base.extend(arm.findall("worldbody/body"))
    _write_limits(whole, robots)
    ET.indent(whole)
    return ET.tostring(whole, encoding="unicode")


def load(arms: Mapping[str, Placed], *, name: str | None = None) -> Robot:
    """Compose several arms, or place a single one, as one ``Robot``.

    Its limits and home posture are those of the arms, one after the other.

    Args:
        arms: name -> arm, in the order of the joints.
        name: of the robot; the arms' names by default.

    Raises:
        InputError, ModelError: as for ``mjcf``.
    """
    text_of = mjcf(arms)
    return Robot.from_mjcf(text_of, name="_".join(arms) if name is None else name)


def _single(name: str, placed: Placed) -> Robot:
    try:
        return Robot.from_mjcf(placed.mjcf, name=name)
    except ModelError as error:
        raise ModelError(f"arm '{name}': {error}") from error


def _prefixed(text: str, name: str) -> ET.Element:
    arm = parse(text, f"arm '{name}'")
    for element in arm.iter():
        if element.tag in FILES and "file" in element.attrib:
            element.attrib.setdefault("name", PurePath(element.attrib["file"]).stem)
        for key in NAMES & element.attrib.keys():
            element.set(key, f"{name}_{element.attrib[key]}")
    return arm


def _write_settings(
    whole: ET.Element, arms: Mapping[str, ET.Element], robots: list[Robot]
) -> None:
    """One compiler, to which all must agree, and options that do not conflict."""
    compilers = {name: _attributes(arm, "compiler") for name, arm in arms.items()}
    options: dict[str, str] = {}
    first = next(iter(arms))
    for (name, arm), robot in zip(arms.items(), robots, strict=True):
        if compilers[name] != compilers[first]:
            raise ModelError(
                f"arm '{name}' is written for compiler {compilers[name]}, arm "
                f"'{first}' for {compilers[first]}: write one of them anew."
            )
        for key, value in _attributes(arm, "option").items():
            if options.setdefault(key, value) != value and key != "gravity":
                raise ModelError(
                    f"arm '{name}' wants option {key}='{value}', another one "
                    f"'{options[key]}': leave it to the scene."
                )
        if not np.array_equal(_gravity(robot), _gravity(robots[0])):
            raise ModelError(
                f"arms '{first}' and '{name}' are under different gravity: "
                f"{_gravity(robots[0])} and {_gravity(robot)}."
            )
    options["gravity"] = _text(_gravity(robots[0]))
    ET.SubElement(whole, "compiler", compilers[first])
    ET.SubElement(whole, "option", options)


def _attributes(arm: ET.Element, tag: str) -> dict[str, str]:
    """What all elements of a tag say together; the last one counts."""
    return {k: v for element in arm.iterfind(tag) for k, v in element.attrib.items()}


def _gravity(robot: Robot) -> Array:
    return np.array(robot.model.gravity.linear)


def _pose(placed: Placed) -> dict[str, str]:
    quat = pin.Quaternion(placed.R)
    return {
        "pos": _text(placed.position),
        "quat": _text([quat.w, quat.x, quat.y, quat.z]),
    }


def _write_limits(whole: ET.Element, robots: list[Robot]) -> None:
    custom = ET.SubElement(whole, "custom")
    for key, values in (
        ("velocity_limit", [robot.v_max for robot in robots]),
        ("acceleration_limit", [robot.a_max for robot in robots]),
    ):
        if np.isfinite(joined := np.concatenate(values)).all():
            ET.SubElement(custom, "numeric", name=key, data=_text(joined))
    home = _text(np.concatenate([robot.q_home for robot in robots]))
    ET.SubElement(ET.SubElement(whole, "keyframe"), "key", name="home", qpos=home)


def _text(values: ArrayLike) -> str:
    return " ".join(repr(float(x)) for x in np.asarray(values, dtype=np.float64))
