"""The robot's tree written anew, in words that Pinocchio and MuJoCo read alike.

Pinocchio's reader ignores the pose of the root, uppercase eulerseq, the pose that a
default class gives a site, and defaults or compiler that come late; it takes an
axisangle for a unit vector and a slide's metres for degrees. So it is given bodies,
inertials, joints and sites alone, with every default resolved, every orientation a
unit quaternion, every angle in radians, and no limits: wbc reads those itself.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping
from itertools import count
from typing import Final

import numpy as np
import pinocchio as pin

from wbc.arrays import Array
from wbc.errors import ModelError
from wbc.linalg import cross
from wbc.mjcf.source import Source, label

__all__ = ["quaternion", "robot_tree"]

ORIENTATIONS: Final = {"quat": 4, "axisangle": 4, "euler": 3, "xyaxes": 6, "zaxis": 3}
AXES: Final = {"x": np.eye(3)[0], "y": np.eye(3)[1], "z": np.eye(3)[2]}
PARALLEL = 1e-10  # sine of an angle that MuJoCo takes for 0 or pi
ROOT: Final = "wbc_root"


def robot_tree(source: Source) -> ET.Element:
    """A <mujoco> element of the one robot and nothing else.

    Raises:
        ModelError: a pose, an axis or a mass is not what it must be.
    """
    root = ET.Element("mujoco", model=source.root.get("model", "robot"))
    ET.SubElement(root, "compiler", angle="radian")
    world = ET.SubElement(root, "worldbody")
    given = source.root.findall("worldbody/body")[0]
    body = _body(source, given, count(1))
    # Pinocchio drops the pose of a root body, and a joint on it.
    if _placed(body) or body.find("joint") is not None:
        world = ET.SubElement(world, "body", name=ROOT)
    world.append(body)
    return root


def _placed(body: ET.Element) -> bool:
    pose = [float(x) for x in f"{body.get('pos')} {body.get('quat')}".split()]
    return not np.allclose(pose, [0, 0, 0, 1, 0, 0, 0], rtol=0, atol=0)


def _body(source: Source, body: ET.Element, unnamed: Iterable[int]) -> ET.Element:
    name = body.get("name") or f"(unnamed body {next(iter(unnamed))})"
    tree = ET.Element("body", {"name": name} | _pose(source, body))
    for inertial in body.iterfind("inertial"):
        tree.append(_inertial(source, inertial))
    for joint in body.iterfind("joint"):
        tree.append(_joint(source, joint))
    for site in body.iterfind("site"):
        if site.get("name"):  # nobody can ask for the others
            named = {"name": site.attrib["name"]}
            tree.append(ET.Element("site", named | _pose(source, site)))
    for child in body.iterfind("body"):
        tree.append(_body(source, child, unnamed))
    return tree


def _inertial(source: Source, inertial: ET.Element) -> ET.Element:
    pose = _pose(source, inertial)
    if "fullinertia" in inertial.attrib:
        moments = source.floats(inertial, "fullinertia", size=6)
        del pose["quat"]  # MuJoCo allows none beside fullinertia
        pose["fullinertia"] = _text(moments)
    else:
        moments = source.floats(inertial, "diaginertia", "0 0 0", 3)
        pose["diaginertia"] = _text(moments)
    mass = source.floats(inertial, "mass", size=1)
    return ET.Element("inertial", {"mass": _text(mass)} | pose)


def _joint(source: Source, joint: ET.Element) -> ET.Element:
    kind = source.get(joint, "type") or "hinge"
    reference = source.floats(joint, "ref", size=1)
    if kind == "hinge" and source.degrees:
        reference = np.radians(reference)
    axis = _unit(source.floats(joint, "axis", "0 0 1", 3), f"axis of {label(joint)}")
    return ET.Element(
        "joint",
        name=joint.attrib["name"],
        type=kind,
        pos=_text(source.floats(joint, "pos", "0 0 0", 3)),
        axis=_text(axis),
        ref=_text(reference),
        armature=_text(source.floats(joint, "armature", size=1)),
    )


def _pose(source: Source, element: ET.Element) -> dict[str, str]:
    pos = source.floats(element, "pos", "0 0 0", 3)
    return {"pos": _text(pos), "quat": _text(quaternion(source, element))}


def quaternion(source: Source, element: ET.Element) -> Array:
    """Orientation (4,), w first, of length 1, of a body, site or inertial.

    Raises:
        ModelError: more than one orientation, or one that is none.
    """
    own, inherited = source.own(element), source.inherited(element)
    given = _orientations(own) or _orientations(inherited)
    if len(given) > 1:
        raise ModelError(
            f"{label(element)} has more than one orientation ({', '.join(given)}), "
            "counting its default classes: keep one."
        )
    if not given:
        return np.array([1.0, 0.0, 0.0, 0.0])
    kind = given[0]
    values = source.floats(element, kind, size=ORIENTATIONS[kind])
    what = f"{kind} of {label(element)}"
    if kind == "quat":
        return _unit(values, what)
    if kind == "axisangle":
        angle = np.radians(values[3]) if source.degrees else values[3]
        return _turn(_unit(values[:3], what), angle)
    if kind == "euler":
        angles = np.radians(values) if source.degrees else values
        return _euler(angles, source.compiler.get("eulerseq", "xyz"))
    if kind == "zaxis":
        return _from_z(_unit(values, what))
    return _from_xy(values, what)


def _orientations(attributes: Mapping[str, str]) -> list[str]:
    return [key for key in ORIENTATIONS if key in attributes]


def _euler(angles: Array, sequence: str) -> Array:
    """Lowercase letters turn about the moved axes, uppercase about the fixed ones."""
    if len(sequence) != 3 or not set(sequence.lower()) <= set(AXES):
        raise ModelError(f"eulerseq='{sequence}' must be three letters of xyzXYZ.")
    total = np.array([1.0, 0.0, 0.0, 0.0])
    for letter, angle in zip(sequence, angles, strict=True):
        turn = _turn(AXES[letter.lower()], float(angle))
        pair = (total, turn) if letter.islower() else (turn, total)
        total = _product(*pair)
    return total


def _from_z(z: Array) -> Array:
    """The smallest turn that takes (0, 0, 1) to the unit vector z."""
    axis = cross(AXES["z"], z)
    sine = float(np.linalg.norm(axis))
    axis = AXES["x"] if sine < PARALLEL else axis / sine
    return _turn(axis, float(np.arctan2(sine, z[2])))


def _from_xy(values: Array, what: str) -> Array:
    x = _unit(values[:3], what)
    y = _unit(values[3:] - (values[3:] @ x) * x, what)
    R = np.column_stack([x, y, cross(x, y)])
    quat = pin.Quaternion(R)
    return _unit(np.array([quat.w, quat.x, quat.y, quat.z]), what)


def _turn(axis: Array, angle: float) -> Array:
    return np.array([np.cos(angle / 2), *(np.sin(angle / 2) * axis)])


def _product(a: Array, b: Array) -> Array:
    vector = a[0] * b[1:] + b[0] * a[1:] + cross(a[1:], b[1:])
    return np.array([a[0] * b[0] - a[1:] @ b[1:], *vector])


def _unit(vector: Array, what: str) -> Array:
    length = float(np.linalg.norm(vector))
    if length < PARALLEL:
        raise ModelError(f"{what} has length 0.")
    return vector / length


def _text(values: Array) -> str:
    return " ".join(repr(float(x)) for x in values)
