"""What a controller's model could not contain of an MJCF: refused by name.

Refused is what would make the engines' M, h or poses differ, and torques that depend on
the posture or hide in the world. Losses, which only slow the robot, are
`notes`.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from typing import Final

from wbc.errors import ModelError
from wbc.mjcf.source import Source, label

__all__ = ["refuse_traps"]

# Elements (as paths) that neither reader nor rewriter expands, and what to do.
ELEMENTS: Final = {
    ".//include": "give the file that it includes",
    "worldbody//frame": "write the pose on the bodies themselves",
    "worldbody//replicate": "write the copies out",
    "worldbody//attach": "write the attached bodies out",
    "worldbody//composite": "leave it to the scene",
    "worldbody//flexcomp": "leave it to the scene",
    "worldbody//plugin": "its forces are unknown to the controller; remove it",
    "deformable//flex": "leave it to the scene",
    "worldbody//freejoint": "fix the base: wbc controls fixed-base robots",
}
# Attributes of <compiler> with which MuJoCo rewrites masses and inertias.
REWRITES: Final = ("settotalmass", "boundmass", "boundinertia")
WRITE_MASSES: Final = "Remove it and write the masses and inertias that are meant."


def refuse_traps(source: Source) -> None:
    """Raise for the first thing that the controller's model could not contain.

    Raises:
        ModelError: with the name of the offender and what to do.
    """
    _elements(source.root)
    _compiler(source)
    _options(source)
    root = _single_root(source.root)
    for body in root.iter("body"):
        _single_body(body)
    for site in root.iter("site"):
        _site(source, site)
    _bodies(source, list(_moving(root)))
    names = [joint.get("name", "") for joint in source.joints()]
    for joint in source.joints():
        _joint(source, joint)
        if names.count(joint.get("name", "")) > 1:
            raise ModelError(f"{label(joint)} exists more than once: rename one.")
    _coupled(source)


def _elements(root: ET.Element) -> None:
    for path, advice in ELEMENTS.items():
        if root.find(path) is not None:
            tag = path.split("/")[-1]
            raise ModelError(f"the MJCF uses <{tag}>, which cannot be read: {advice}.")


def _single_root(root: ET.Element) -> ET.Element:
    roots = root.findall("worldbody/body")
    if len(roots) != 1:
        names = ", ".join(repr(b.get("name", "?")) for b in roots) or "none"
        raise ModelError(
            f"the MJCF must have exactly one root body, found {names}: Pinocchio "
            "would read the first and drop the rest. Give each robot its own file "
            "and leave tables and work-pieces to the scene."
        )
    return roots[0]


def _compiler(source: Source) -> None:
    compiler = source.compiler
    if compiler.get("inertiafromgeom") == "true":
        raise ModelError(
            "<compiler inertiafromgeom='true'> infers every inertia from geoms, "
            "<inertial> or not. Pinocchio gets the same for boxes, spheres and the "
            "like, but not for meshes or with inertiagrouprange: remove it and write "
            "<inertial> on every body."
        )
    if compiler.get("balanceinertia") == "true":
        raise ModelError(
            "<compiler balanceinertia='true'> makes MuJoCo change impossible inertias, "
            f"which Pinocchio takes as they are. {WRITE_MASSES}"
        )
    for key in REWRITES:
        text = compiler.get(key, "0")
        if _number(text) > 0:
            raise ModelError(
                f"<compiler {key}='{text}'> makes MuJoCo change masses or inertias, "
                f"which Pinocchio takes as they are. {WRITE_MASSES}"
            )


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise ModelError(f"'{text}' in <compiler> must be a number.") from error


def _options(source: Source) -> None:
    final: dict[str, str] = {}  # of several <option> the last one counts
    for option in source.root.iterfind("option"):
        final |= option.attrib
        for flag in option.iterfind("flag"):
            final |= {f"flag {key}": value for key, value in flag.attrib.items()}
    for key in ("density", "viscosity"):
        if _number(final.get(key, "0")):
            raise ModelError(
                f"<option {key}='{final[key]}'> fills the world with a fluid, whose "
                "drag the controller does not know: remove it."
            )
    if final.get("actuatorgroupdisable") or final.get("flag actuation") == "disable":
        raise ModelError(
            "<option> disables actuators (actuatorgroupdisable or flag actuation): a "
            "torque limit read from them would mean nothing. Remove it."
        )


def _moving(body: ET.Element, moved: bool = False) -> Iterator[ET.Element]:
    """Bodies at or below a joint."""
    moved = moved or body.find("joint") is not None
    if moved:
        yield body
    for child in body.iterfind("body"):
        yield from _moving(child, moved)


def _single_body(body: ET.Element) -> None:
    joints = body.findall("joint")
    if len(joints) > 1:
        names = ", ".join(j.get("name", "(unnamed)") for j in joints)
        raise ModelError(
            f"{label(body)} has {len(joints)} joints ({names}), of which Pinocchio "
            "would make one composite joint: write one body for each, with a small "
            "<inertial> on those between."
        )
    if joints and not joints[0].get("name"):
        raise ModelError(
            f"the joint of {label(body)} has no name: wbc speaks of joints by name. "
            "Write <joint name=.../>."
        )
    if body.get("mocap") == "true":
        raise ModelError(
            f"{label(body)} is a mocap body, which the scene moves: remove mocap."
        )


def _site(source: Source, site: ET.Element) -> None:
    if site.get("name") and source.get(site, "fromto"):
        raise ModelError(
            f"{label(site)} is placed by fromto, which turns its z axis one way in "
            "MuJoCo and the other in Pinocchio: write pos and zaxis or quat."
        )


def _bodies(source: Source, moving: list[ET.Element]) -> None:
    bare = [
        body
        for body in moving
        if body.find("inertial") is None
        and (body.find("geom") is not None or body.find("joint") is not None)
    ]
    if bare:
        raise ModelError(
            f"no <inertial> on body {_names(bare)}: Pinocchio and MuJoCo infer "
            "different inertias from geoms. Write mass, pos and inertia."
        )
    floating = [body for body in moving if source.floats(body, "gravcomp").any()]
    if floating:
        raise ModelError(
            f"gravcomp on body {_names(floating)}: MuJoCo would cancel gravity and "
            "the controller would cancel it again. Remove it."
        )


def _names(elements: list[ET.Element]) -> str:
    return ", ".join(e.get("name", "(unnamed)") for e in elements)


def _joint(source: Source, joint: ET.Element) -> None:
    kind = source.get(joint, "type") or "hinge"
    if kind not in ("hinge", "slide"):
        raise ModelError(
            f"{label(joint)} is of type '{kind}'; wbc controls fixed-base robots "
            "with hinge and slide joints."
        )
    for key in ("stiffness", "springdamper"):
        if source.floats(joint, key).any():
            raise ModelError(
                f"{label(joint)} has a spring ({key}), which Pinocchio does not know: "
                "remove it from the robot, or model it as a task."
            )


def _coupled(source: Source) -> None:
    """Inertia and springs that hang on tendons and actuators."""
    for tendon in source.root.iterfind("tendon/*"):
        if source.floats(tendon, "stiffness").any():
            raise ModelError(
                f"{label(tendon)} of <tendon> has a spring (stiffness), which "
                "Pinocchio does not know: remove it, or model it as a task."
            )
    for section in ("tendon", "actuator"):
        for element in source.root.iterfind(f"{section}/*"):
            if source.floats(element, "armature").any():
                raise ModelError(
                    f"{label(element)} of <{section}> has armature, which MuJoCo adds "
                    "to M and Pinocchio does not know: put it on the joints, times the "
                    "gear squared."
                )
