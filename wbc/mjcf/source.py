"""One MJCF text as MuJoCo understands it: default classes, compiler, numbers."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from typing import Final

import numpy as np

from wbc.arrays import Array
from wbc.errors import ModelError

__all__ = ["Source", "label"]

TENDONS: Final = ("spatial", "fixed")
SERVOS: Final = (
    "position", "velocity", "intvelocity", "damper", "cylinder", "muscle",
    "adhesion", "dcmotor", "plugin",
)  # fmt: skip
GAINS: Final = {"position": "kp", "velocity": "kv"}  # their names of gainprm
# MuJoCo keeps one set of defaults for all actuators; a shortcut such as <motor>
# writes it like <general>, and resets what makes it that kind of actuator.
IMPLIED: Final[dict[str, dict[str, str]]] = {
    "motor": {
        "dyntype": "none", "gaintype": "fixed", "gainprm": "1", "biastype": "none",
    },
    **{tag: {"gaintype": tag, "biastype": tag} for tag in SERVOS},
    **{tag: {"gaintype": "fixed", "biastype": "affine"} for tag in GAINS},
}  # fmt: skip
SHARED: Final = {
    **dict.fromkeys(TENDONS, "tendon"),
    **dict.fromkeys(("general", "motor", *SERVOS), "actuator"),
}

Attributes = dict[str, str]


def label(element: ET.Element) -> str:
    """Such as "joint 'elbow'"."""
    return f"{element.tag} '{element.get('name', '(unnamed)')}'"


class Source:
    """A parsed MJCF text and what its default classes and compiler say.

    Attributes:
        root: the <mujoco> element.
        compiler: attributes of all <compiler> elements, the last one counts.

    Raises:
        ModelError: not well-formed, or not MJCF.
    """

    def __init__(self, text: str) -> None:
        try:
            self.root = ET.fromstring(text)
        except ET.ParseError as error:
            raise ModelError(f"the MJCF is not well-formed XML: {error}") from error
        if self.root.tag != "mujoco":
            raise ModelError(
                f"this is a <{self.root.tag}> file, not an MJCF, which is <mujoco>. "
                "Robot.from_urdf reads a URDF."
            )
        self._parent = {child: node for node in self.root.iter() for child in node}
        self._classes: dict[str, dict[str, Attributes]] = {"main": {}}
        for top in self.root.iterfind("default"):
            self._read_class(top, top.get("class", "main"), self._classes["main"])
        self.compiler: Attributes = {}
        for compiler in self.root.iterfind("compiler"):
            self.compiler |= compiler.attrib

    def _read_class(
        self, node: ET.Element, name: str, inherited: dict[str, Attributes]
    ) -> None:
        merged = {kind: dict(values) for kind, values in inherited.items()}
        for child in node:
            if child.tag != "default":
                values = self.own(child)
                merged.setdefault(SHARED.get(child.tag, child.tag), {}).update(values)
        self._classes[name] = merged
        for child in node.iterfind("default"):
            self._read_class(child, child.get("class", ""), merged)

    @property
    def degrees(self) -> bool:
        """Whether angles are in degrees, as they are unless the compiler says so."""
        return self.compiler.get("angle", "degree") == "degree"

    @property
    def autolimits(self) -> bool:
        """Whether a range alone makes a limit."""
        return self.compiler.get("autolimits", "true") == "true"

    def joints(self) -> Iterator[ET.Element]:
        """Joints of the robot, in the order of both engines."""
        return self.root.iterfind("worldbody/body//joint")

    def parent(self, element: ET.Element) -> ET.Element:
        """The element around one."""
        return self._parent[element]

    def own(self, element: ET.Element) -> Attributes:
        """Attributes of the element itself, with what its tag implies."""
        gain = element.get(GAINS.get(element.tag, ""))
        own = {} if gain is None else {"gainprm": gain}
        return own | IMPLIED.get(element.tag, {}) | element.attrib

    def inherited(self, element: ET.Element) -> Attributes:
        """Attributes that its default class gives an element.

        Raises:
            ModelError: there is no such class.
        """
        name = element.get("class") or self._childclass(element) or "main"
        if name not in self._classes:
            known = ", ".join(self._classes)
            raise ModelError(
                f"{label(element)} is of default class '{name}', which does not "
                f"exist. Classes: {known}."
            )
        return self._classes[name].get(SHARED.get(element.tag, element.tag), {})

    def get(self, element: ET.Element, attribute: str) -> str | None:
        """The attribute's value, its own or its class's."""
        own = self.own(element)
        return own.get(attribute) or self.inherited(element).get(attribute)

    def floats(
        self, element: ET.Element, attribute: str, default: str = "0", size: int = 0
    ) -> Array:
        """The attribute's numbers, of the given size unless that is 0.

        Raises:
            ModelError: they are no numbers, or too few or too many.
        """
        text = self.get(element, attribute) or default
        try:
            values = np.array(text.split(), dtype=np.float64)
        except ValueError:
            values = np.array([np.nan])
        if not np.isfinite(values).all() or (size and values.size != size):
            wanted = f"{size} numbers" if size > 1 else "finite numbers"
            raise ModelError(
                f"{label(element)}: {attribute}='{text}' must be {wanted}."
            )
        return values

    def limits(self, element: ET.Element, what: str = "") -> tuple[float, float] | None:
        """The range `<what>range` where `<what>limited` says that it holds, else None.

        Raises:
            ModelError: a limit without a proper range, or a range of which MuJoCo
                would not know whether it holds.
        """
        flag = self.get(element, f"{what}limited") or "auto"
        lower, upper = self.floats(element, f"{what}range", "0 0", 2)
        if flag == "true" and lower >= upper:
            raise ModelError(
                f"{label(element)} has {what}limited='true' but no proper {what}range."
            )
        if flag == "auto" and lower < upper and not self.autolimits:
            raise ModelError(
                f"{label(element)} has {what}range but not {what}limited, which "
                f"MuJoCo refuses under autolimits='false': write {what}limited='true'."
            )
        return (
            (float(lower), float(upper)) if flag != "false" and lower < upper else None
        )

    def _childclass(self, element: ET.Element) -> str | None:
        node: ET.Element | None = element
        while node is not None:
            if "childclass" in node.attrib:
                return node.attrib["childclass"]
            node = self._parent.get(node)
        return None
