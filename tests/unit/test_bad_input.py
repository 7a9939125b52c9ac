"""Absurd arguments, one at a time, for everything public: refused by name, or right."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any, Final

import numpy as np
import pytest

import sims
import tasks
import wbc
from tests.doors import DOORS, Door
from tests.task_doors import TASK_DOORS

ALL = [*DOORS, *TASK_DOORS]
ABSURD: Final[dict[str, Any]] = {
    "None": None,
    "object": object(),
    "text": "abc",
    "nan": float("nan"),
    "inf": float("inf"),
    "-1": -1,
    "3": 3,
    "huge": 10**400,
    "nothing": [],
    "mapping": {},
    "ragged": [[1.0], [1.0, 2.0]],
    "misshapen": np.ones((2, 5)),
    "complex": 1j * np.ones(6),
    "dates": np.zeros(6, "datetime64[s]"),
}
SIGNED: Final = {"-1"}
LEGITIMATE: Final[dict[tuple[str, str], set[str]]] = {
    # numbers that may be negative, or infinite
    ("Robot.state", "t"): SIGNED,
    ("solve_pose", "t"): SIGNED,
    ("Path.at", "s"): SIGNED,
    ("AxisAlongPath", "work"): SIGNED,
    ("AxisAlongPath", "travel"): SIGNED,
    ("TravelSpeed", "start"): SIGNED,
    ("MovingFrame.steady", "start"): SIGNED,
    ("DistanceToPlane", "distance"): SIGNED,
    ("rim_grasp", "depth"): SIGNED,
    ("WristSensor", "cutoff"): {"inf"},
    # a clock that reads nonsense is a fault of a sensor: the controller holds
    ("Controller.__call__", "t"): {"nan", "inf", "-1"},
    # nothing measured
    ("Controller.__call__", "wrenches"): {"nothing", "mapping"},
    ("Robot.state", "wrenches"): {"mapping"},
    # no limits beyond the model's; math.inf says "none"
    **{
        (f"Robot.{way}", limit): {"inf", "mapping"}
        for way in ("from_mjcf", "from_urdf")
        for limit in ("position_limit", "velocity_limit", "torque_limit")
    },
    ("Robot.from_mjcf", "acceleration_limit"): {"inf"},
    ("Robot.from_urdf", "acceleration_limit"): {"inf"},
    # any whole number is a seed, or a count of attempts
    **{(door.name, "seed"): {"huge"} for door in ALL},
    ("solve_pose", "attempts"): {"huge"},
    # no names at all, in whatever holds them
    ("Pull", "rows"): {"nothing", "mapping"},
    ("Pull", "frames"): {"nothing"},
    ("run", "sites"): {"nothing", "mapping"},
}
"""Which of the absurd values mean something, for which parameter."""
DERIVED_OR_RETURNED: Final = {
    "wbc": {
        *("Analysis", "LevelAnalysis", "Dependency", "Certificate", "Explanation"),
        *("ActiveBound", "Blocker", "LevelCost", "StrictnessCost", "TaskExplanation"),
        *(
            "HierarchyResult",
            "PoseResult",
            "TaskMiss",
            "Solution",
            "TaskReport",
            "Fading",
        ),
        *("Status", "State", "FrameState", "Rows", "Robot"),  # by functions of ours
        *("Law", "Resolver", "Task", "MotionTask"),  # `Pull` is one
        "Kernel",  # of a compiled task, read once by its stack
        *("InputError", "ModelError", "SolverError", "StaleError", "UnknownName"),
        "WbcError",
    },
    "tasks": {"PathPoint", "FrameMotion"},  # the latter through `MovingFrame`
    "sims": {"Log", "Observation", "Cell"},
}
"""What nobody makes by hand, or only derives from."""


@pytest.mark.parametrize("package", [wbc, tasks, sims], ids=lambda p: p.__name__)
def test_everything_exported_is_tried(package):
    tried = {part for door in ALL for part in door.name.split(".")[:1]}
    tried |= {"Hierarchy"}  # takes any number of arguments: `in_a_hierarchy`
    listed = DERIVED_OR_RETURNED[package.__name__]
    assert set(package.__all__) <= tried | listed


@pytest.mark.parametrize("door", ALL, ids=lambda door: door.name)
def test_the_good_arguments_are_good(door):
    door.enter(door.before and door.before())


def meant(parameter: inspect.Parameter, label: str) -> bool:
    """Whether the annotation says that such a value is right."""
    wanted = str(parameter.annotation)
    if label == "None":
        return parameter.default is None or "None" in wanted
    if label == "text":
        return "str" in wanted or wanted == "Carrier"
    numeric = ("float", "int", "ArrayLike", "Limit", "object")
    return label == "3" and any(kind in wanted for kind in numeric)


def trials() -> list[Any]:
    return [
        pytest.param(door, name, id=f"{door.name}-{name}")
        for door in ALL
        for name in door.parameters
    ]


def contents(owner: object) -> Mapping[str, Any]:
    found = getattr(owner, "__dict__", {})
    return {
        k: np.array(x) if isinstance(x, np.ndarray) else x for k, x in found.items()
    }


@pytest.mark.parametrize(("door", "name"), trials())
def test_absurd_arguments_are_refused_by_name(door: Door, name: str):
    fits = LEGITIMATE.get((door.name, name), set())
    for label, value in ABSURD.items():
        owner = None if door.before is None else door.before()
        before = contents(owner)
        try:
            door.enter(owner, **{name: value})
        except wbc.WbcError as error:
            text = str(error)
            assert names_the_offender(text, door, name), f"{label}: {text}"
            assert "\n" not in text.strip(), f"{label}: more than one line: {text}"
            after = contents(owner)
            assert all(np.array_equal(before[k], after[k]) for k in before), label
        else:
            right = label in fits or meant(door.parameters[name], label)
            assert right, f"{door.name}({name}={label}) was taken"


def names_the_offender(text: str, door: Door, name: str) -> bool:
    """By the parameter, the class, or the name that was looked up."""
    said = text.lower().replace("_", " ")
    kind = door.name.split(".")[0].lower().replace("_", " ")
    return name.replace("_", " ").lower() in said or kind in said or "'abc'" in said
