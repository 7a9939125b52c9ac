"""One model file in both engines, unmended, and what each says when it cannot."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Literal

import mujoco
import pinocchio as pin

from sims.audit.result import Finding
from wbc.errors import ModelError

__all__ = ["Engines", "load"]

COMMENT: Final = re.compile(r"<!--.*?-->", re.DOTALL)
ROOT_TAG: Final = re.compile(r"<\s*(mujoco|robot)\b")
SHAPE: Final = re.compile(r"<(visual|collision)\b.*?</\1\s*>", re.DOTALL)
# MuJoCo merges bodies without a joint when it reads a URDF, unless told.
COMPILER: Final = '<mujoco><compiler fusestatic="false"/></mujoco></robot>'


@dataclass(frozen=True, slots=True, eq=False)
class Engines:
    """Both models of one file; None where the engine could not read it.

    Attributes:
        kind: format of the file.
        text: its text.
        pin: what Pinocchio's own reader makes of it.
        mujoco: what MuJoCo's own reader makes of it.
        bare: bodies whose inertia the file does not state.
        total_mass: the compiler's settotalmass [kg], negative if there is none.
        findings: what went wrong while reading.
    """

    kind: Literal["MJCF", "URDF"]
    text: str
    pin: pin.Model | None
    mujoco: mujoco.MjModel | None
    bare: tuple[str, ...]
    total_mass: float
    findings: tuple[Finding, ...]


def load(path: Path) -> Engines:
    """Read a file with both engines.

    Raises:
        ModelError: there is no such file, or it is neither MJCF nor URDF.
    """
    if not path.is_file():
        raise ModelError(f"there is no model file '{path}'.")
    text = path.read_text(encoding="utf-8", errors="replace")
    tag = ROOT_TAG.search(COMMENT.sub("", text))
    if tag is None:
        raise ModelError(f"'{path}' is neither an MJCF nor a URDF file.")
    findings: list[Finding] = []
    if tag[1] == "robot":
        model = _pinocchio(pin.buildModelFromUrdf, path, findings)
        engine, spec = _mujoco_urdf(path, text, findings)
    else:
        model = _pinocchio(pin.buildModelFromMJCF, path, findings)
        engine, spec = _mujoco_mjcf(path, findings)
    return Engines(
        "URDF" if tag[1] == "robot" else "MJCF",
        text,
        model,
        engine,
        () if spec is None else _bare(spec),
        -1.0 if spec is None else float(spec.compiler.settotalmass),
        tuple(findings),
    )


def _pinocchio(
    read: Callable[[str], Any], path: Path, findings: list[Finding]
) -> pin.Model | None:
    try:
        return read(str(path))
    except Exception as error:  # the binding raises whatever its parser met
        message = _clean(error)
    findings.append(
        Finding(
            "Pinocchio cannot read the file",
            path.name,
            message,
            "",
            "Mend the file first: without Pinocchio there is no controller model.",
            "error",
        )
    )
    return None


def _mujoco_mjcf(
    path: Path, findings: list[Finding]
) -> tuple[mujoco.MjModel | None, mujoco.MjSpec | None]:
    try:
        spec = mujoco.MjSpec.from_file(str(path))
        return _compile(spec), spec
    except Exception as error:  # parser and compiler raise several kinds
        message = _clean(error)
    try:
        spec = _without_meshes(mujoco.MjSpec.from_file(str(path)))
        engine = _compile(spec)
    except Exception:  # the first message says more than this one
        findings.append(_unreadable(path, message))
        return None, None
    findings.append(
        Finding(
            "mesh files missing",
            path.name,
            "does not open mesh files for the dynamics",
            f"cannot load the file: {message}",
            "Put the meshes where the file says. Compared here without meshes.",
            "error",
        )
    )
    return engine, spec


def _without_meshes(spec: mujoco.MjSpec) -> mujoco.MjSpec:
    for geom in list(spec.geoms):
        if geom.type == mujoco.mjtGeom.mjGEOM_MESH:
            spec.delete(geom)
    for mesh in list(spec.meshes):
        spec.delete(mesh)
    return spec


def _mujoco_urdf(
    path: Path, text: str, findings: list[Finding]
) -> tuple[mujoco.MjModel | None, mujoco.MjSpec | None]:
    try:
        mujoco.MjModel.from_xml_path(str(path))
    except Exception as error:  # most often package:// or .dae meshes
        findings.append(_needs_preparing(path, _clean(error)))
    bare = SHAPE.sub(lambda m: "" if "<mesh" in m[0] else m[0], text)
    if "<mujoco" not in bare:
        bare = bare.replace("</robot>", COMPILER)
    try:
        spec = mujoco.MjSpec.from_string(bare)
        return _compile(spec), spec
    except Exception as error:  # parser and compiler raise several kinds
        findings[:] = [f for f in findings if f.what != "MuJoCo needs a prepared URDF"]
        findings.append(_unreadable(path, _clean(error)))
        return None, None


def _needs_preparing(path: Path, message: str) -> Finding:
    return Finding(
        "MuJoCo needs a prepared URDF",
        path.name,
        "reads the dynamics without opening meshes",
        f"cannot load the file as it is: {message}",
        "Replace package:// by the folder, drop .dae visuals, keep static bodies with "
        '<mujoco><compiler strippath="false" fusestatic="false"/></mujoco>. Compared '
        "here without meshes.",
        "note",
    )


def _unreadable(path: Path, message: str) -> Finding:
    advice = "Mend the file first: without MuJoCo there is nothing to compare with."
    what = "MuJoCo cannot read the file"
    return Finding(what, path.name, "", message, advice, "error")


def _compile(spec: mujoco.MjSpec) -> mujoco.MjModel:
    with warnings.catch_warnings():  # deprecated options still say what they do
        warnings.simplefilter("ignore")
        return spec.compile()


def _bare(spec: mujoco.MjSpec) -> tuple[str, ...]:
    return tuple(b.name for b in spec.bodies[1:] if not b.explicitinertial)


def _clean(error: Exception) -> str:
    """One line of an engine's message, without the paths of its own sources."""
    text = str(error).split("message:", 1)[-1]
    return " ".join(text.split()) or type(error).__name__
