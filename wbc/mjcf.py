"""Reading MJCF text for Pinocchio, with the traps of its reader caught.

Pinocchio reads one kinematic tree and skips what it does not know. What it would
skip in silence is either mended here or refused with a `ModelError`.
"""

from __future__ import annotations

import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin

from wbc.arrays import Array
from wbc.errors import ModelError

__all__ = ["Mjcf", "read_mjcf"]

IDENTITY_POSES = {"pos": (0.0, 0.0, 0.0), "quat": (1.0, 0.0, 0.0, 0.0)}
OTHER_ROTATIONS = ("euler", "axisangle", "xyaxes", "zaxis")


@dataclass(frozen=True, slots=True, eq=False)
class Mjcf:
    """What one MJCF text says.

    Attributes:
        text: the XML as given.
        model: the Pinocchio model.
        torque: joint name -> largest |torque| of its actuators [Nm].
        numerics: name -> values of the `<custom><numeric>` elements.
        home: keyframe named "home", else the first one, (nq,), or None.
        notes: what the engines will treat differently, one sentence each.
    """

    text: str
    model: pin.Model
    torque: dict[str, float]
    numerics: dict[str, Array]
    home: Array | None
    notes: tuple[str, ...]


def read_mjcf(source: str | Path) -> Mjcf:
    """Read a file, or the XML text itself.

    Raises:
        ModelError: the file is missing or malformed, or it has a trait that
            Pinocchio would drop in silence.
    """
    text = _text(source)
    try:
        root = ET.fromstring(text)
    except ET.ParseError as error:
        raise ModelError(f"the MJCF is not well-formed XML: {error}") from error
    defaults = _Defaults(root)
    _refuse(root, defaults)
    model = _build(root)
    model.gravity.linear = _gravity(root)
    return Mjcf(
        text=text,
        model=model,
        torque=_torque_limits(root, defaults),
        numerics={
            e.get("name", ""): _floats(e.get("data", ""))
            for e in root.iterfind("custom/numeric")
        },
        home=_home(root),
        notes=tuple(_notes(root, defaults)),
    )


def _text(source: str | Path) -> str:
    if isinstance(source, str) and source.lstrip().startswith("<"):
        return source
    path = Path(source)
    if not path.is_file():
        raise ModelError(f"there is no model file '{path}'.")
    return path.read_text()


def _floats(text: str) -> Array:
    return np.array(text.split(), dtype=np.float64)


class _Defaults:
    """MJCF's default classes: attribute look-up for an element of the tree."""

    def __init__(self, root: ET.Element) -> None:
        self._classes: dict[str, dict[str, dict[str, str]]] = {"main": {}}
        for top in root.iterfind("default"):
            self._read(top, top.get("class", "main"), {})
        self._parent = {child: parent for parent in root.iter() for child in parent}

    def _read(
        self, node: ET.Element, name: str, inherited: dict[str, dict[str, str]]
    ) -> None:
        merged = {tag: dict(values) for tag, values in inherited.items()}
        for child in node:
            if child.tag != "default":
                merged.setdefault(child.tag, {}).update(child.attrib)
        self._classes[name] = merged
        for child in node.iterfind("default"):
            self._read(child, child.get("class", ""), merged)

    def get(self, element: ET.Element, attribute: str) -> str | None:
        """The attribute's value, its own or its class's."""
        if attribute in element.attrib:
            return element.attrib[attribute]
        name = element.get("class") or self._childclass(element) or "main"
        return self._classes.get(name, {}).get(element.tag, {}).get(attribute)

    def _childclass(self, element: ET.Element) -> str | None:
        node: ET.Element | None = element
        while node is not None:
            if "childclass" in node.attrib:
                return node.attrib["childclass"]
            node = self._parent.get(node)
        return None


def _moving(body: ET.Element, moved: bool = False) -> Iterator[ET.Element]:
    """Bodies at or below a joint."""
    moved = moved or body.find("joint") is not None
    if moved:
        yield body
    for child in body.iterfind("body"):
        yield from _moving(child, moved)


def _refuse(root: ET.Element, defaults: _Defaults) -> None:
    roots = root.findall("worldbody/body")
    if len(roots) != 1:
        names = ", ".join(repr(b.get("name", "?")) for b in roots) or "none"
        raise ModelError(
            f"the MJCF must have exactly one root body, found {names}: Pinocchio "
            "would read the first and drop the rest. Give each robot its own file "
            "and leave tables and work-pieces to the scene."
        )
    for tag, advice in (
        ("include", "give the file that it includes"),
        ("frame", "write the pose on the bodies themselves"),
        ("replicate", "write the copies out"),
        ("freejoint", "fix the base: wbc controls fixed-base robots"),
    ):
        if root.find(f".//{tag}") is not None and (
            tag == "include" or root.find(f"worldbody//{tag}") is not None
        ):
            raise ModelError(f"the MJCF uses <{tag}>, which cannot be read: {advice}.")
    compiler = root.find("compiler")
    if compiler is not None and compiler.get("inertiafromgeom") == "true":
        raise ModelError(
            "inertiafromgeom='true' makes MuJoCo ignore <inertial>, which Pinocchio "
            "reads: remove it."
        )
    bodies = list(_moving(roots[0]))
    _refuse_bodies(bodies)
    _refuse_joints([j for b in bodies for j in b.iterfind("joint")], defaults)


def _refuse_bodies(bodies: list[ET.Element]) -> None:
    bare = [
        b.get("name", "?")
        for b in bodies
        if b.find("inertial") is None
        and (b.find("geom") is not None or b.find("joint") is not None)
    ]
    if bare:
        raise ModelError(
            f"no <inertial> on body {', '.join(bare)}: Pinocchio and MuJoCo infer "
            "different inertias from geoms. Write mass, pos and inertia."
        )
    floating = [b.get("name", "?") for b in bodies if float(b.get("gravcomp", "0"))]
    if floating:
        raise ModelError(
            f"gravcomp on body {', '.join(floating)}: MuJoCo would cancel gravity and "
            "the controller would cancel it again. Remove it."
        )


def _refuse_joints(joints: list[ET.Element], defaults: _Defaults) -> None:
    for joint in joints:
        name = joint.get("name", "?")
        kind = defaults.get(joint, "type") or "hinge"
        if kind not in ("hinge", "slide"):
            raise ModelError(
                f"joint '{name}' is of type '{kind}'; wbc controls fixed-base robots "
                "with hinge and slide joints."
            )
        if np.any(_floats(defaults.get(joint, "stiffness") or "0")):
            raise ModelError(
                f"joint '{name}' has a spring (stiffness), which Pinocchio does not "
                "know: remove it from the robot, or model it as a task."
            )


def _build(root: ET.Element) -> pin.Model:
    """Hand the tree to Pinocchio, wrapped where its root has a pose of its own."""
    world = root.find("worldbody")
    assert world is not None
    body = world.findall("body")[0]
    if _has_pose(body) or body.find("joint") is not None:
        world.remove(body)
        ET.SubElement(world, "body", name="wbc_root").append(body)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "robot.xml"
        path.write_text(ET.tostring(root, encoding="unicode"))
        try:
            return pin.buildModelFromMJCF(str(path))
        except Exception as error:  # Pinocchio raises whatever its parser met
            raise ModelError(f"Pinocchio cannot read the MJCF: {error}") from error


def _has_pose(body: ET.Element) -> bool:
    if any(key in body.attrib for key in OTHER_ROTATIONS):
        return True
    return any(
        key in body.attrib and not np.allclose(_floats(body.attrib[key]), identity)
        for key, identity in IDENTITY_POSES.items()
    )


def _gravity(root: ET.Element) -> Array:
    for option in root.iterfind("option"):
        if "gravity" in option.attrib:
            return _floats(option.attrib["gravity"])
    return np.array([0.0, 0.0, -9.81])


def _torque_limits(root: ET.Element, defaults: _Defaults) -> dict[str, float]:
    """Largest torque that the actuators of each joint can apply, either way."""
    limits: dict[str, float] = {}
    for actuator in root.iterfind("actuator/*"):
        joint = actuator.get("joint")
        bounds = []
        gear = abs(_floats(defaults.get(actuator, "gear") or "1")[0])
        force = defaults.get(actuator, "forcerange")
        control = defaults.get(actuator, "ctrlrange")
        if force:
            bounds.append(float(np.abs(_floats(force)).min()) * gear)
        if control and actuator.tag == "motor":
            bounds.append(float(np.abs(_floats(control)).min()) * gear)
        if joint and bounds:
            limits[joint] = min(bounds)
    for joint_element in root.iterfind("worldbody//joint"):
        total = defaults.get(joint_element, "actuatorfrcrange")
        name = joint_element.get("name", "")
        if total:
            bound = float(np.abs(_floats(total)).min())
            limits[name] = min(limits.get(name, np.inf), bound)
    return limits


def _home(root: ET.Element) -> Array | None:
    keys = root.findall("keyframe/key")
    named = [k for k in keys if k.get("name") == "home"]
    for key in (named or keys)[:1]:
        if "qpos" in key.attrib:
            return _floats(key.attrib["qpos"])
    return None


def _notes(root: ET.Element, defaults: _Defaults) -> Iterator[str]:
    for joint in root.iterfind("worldbody//joint"):
        for attribute in ("damping", "frictionloss"):
            if np.any(_floats(defaults.get(joint, attribute) or "0")):
                yield (
                    f"joint '{joint.get('name', '?')}' has {attribute}, which MuJoCo "
                    "applies and the controller's model does not contain"
                )
    if root.find("equality") is not None:
        yield "equality constraints of the file are not part of the controller's model"
