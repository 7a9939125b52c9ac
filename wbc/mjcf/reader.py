"""Reading MJCF text for Pinocchio, with the traps of its reader caught.

Pinocchio reads one kinematic tree, skips what it does not know, and takes some of what
it does know differently from MuJoCo. What it would change in silence is either mended
(`tree`, `limits`) or refused with a `ModelError` (`traps`).
"""

from __future__ import annotations

import tempfile
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin

from wbc.arrays import Array
from wbc.errors import ModelError
from wbc.mjcf.limits import gravity, position_limits, torque_limits
from wbc.mjcf.notes import notes
from wbc.mjcf.source import Source
from wbc.mjcf.traps import refuse_traps
from wbc.mjcf.tree import robot_tree

__all__ = ["Mjcf", "read_mjcf"]


@dataclass(frozen=True, slots=True, eq=False)
class Mjcf:
    """What one MJCF text says.

    Attributes:
        text: the XML as given.
        model: the Pinocchio model, with MuJoCo's gravity and position limits; torque
            limits are those of the motors, infinite where there is none.
        torque: joint name -> largest |torque| of its actuators [Nm or N].
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
        ModelError: the file is missing or malformed, it has a trait that Pinocchio
            would drop in silence, or there is no room for a temporary file.
    """
    text = _text(source)
    said = Source(text)
    refuse_traps(said)
    torque = torque_limits(said)
    return Mjcf(
        text=text,
        model=_model(said, torque),
        torque=torque,
        numerics={
            e.get("name", ""): said.floats(e, "data")
            for e in said.root.iterfind("custom/numeric")
        },
        home=_home(said),
        notes=tuple(notes(said)),
    )


def _text(source: str | Path) -> str:
    if isinstance(source, str) and source.lstrip().startswith("<"):
        return source
    path = Path(source)
    if not path.is_file():
        raise ModelError(f"there is no model file '{path}'.")
    return path.read_text(encoding="utf-8")


def _model(source: Source, torque: dict[str, float]) -> pin.Model:
    model = _build(robot_tree(source))
    model.gravity.linear = gravity(source)
    joints = list(model.names)[1:]
    box = position_limits(source)
    model.lowerPositionLimit = np.array([box[joint][0] for joint in joints])
    model.upperPositionLimit = np.array([box[joint][1] for joint in joints])
    effort = np.array([torque.get(joint, np.inf) for joint in joints])
    model.lowerEffortLimit, model.upperEffortLimit = -effort, effort
    return model


def _build(tree: ET.Element) -> pin.Model:
    text = ET.tostring(tree, encoding="unicode")
    try:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "robot.xml"
            path.write_text(text, encoding="utf-8")
            return _parse(path)
    except OSError as error:
        raise ModelError(
            f"no file can be written for Pinocchio to read: {error}. Make room, or set "
            "the environment variable TMPDIR to another folder."
        ) from error


def _parse(path: Path) -> pin.Model:
    try:
        return pin.buildModelFromMJCF(str(path))
    except Exception as error:  # Pinocchio raises whatever its parser met
        raise ModelError(f"Pinocchio cannot read the MJCF: {error}") from error


def _home(source: Source) -> Array | None:
    keys = source.root.findall("keyframe/key")
    named = [k for k in keys if k.get("name") == "home"]
    for key in (named or keys)[:1]:
        if "qpos" in key.attrib:
            return source.floats(key, "qpos")
    return None
