"""The robot: names, limits, home posture and the Pinocchio model behind them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, final

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from wbc.arrays import Array, frozen, number, positive
from wbc.checks import expect, named
from wbc.errors import InputError, ModelError, UnknownName, shown
from wbc.limits import Limit, joint_limits
from wbc.mjcf import read_mjcf

if TYPE_CHECKING:
    from wbc.state import State

__all__ = ["Robot"]


@final
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Robot:
    """A fixed-base robot of hinge and slide joints; immutable.

    All arrays are read-only, of shape (n,), in the order of `joint_names`.

    Attributes:
        name: what reports call it.
        model: the Pinocchio model; do not write to it.
        joint_names: one a degree of freedom.
        q_min: lower position limits [rad or m], -inf where there is none.
        q_max: upper position limits [rad or m].
        v_max: velocity limits [rad/s or m/s].
        a_max: accelerations that may be counted on for braking [rad/s^2 or m/s^2].
        tau_max: torque limits [Nm or N].
        q_home: home posture.
        mjcf: the MJCF text that it was read from, None for a URDF.
        notes: what a simulator will do that the model does not contain.
    """

    name: str
    model: pin.Model
    joint_names: tuple[str, ...]
    q_min: Array
    q_max: Array
    v_max: Array
    a_max: Array
    tau_max: Array
    q_home: Array
    mjcf: str | None = None
    notes: tuple[str, ...] = ()
    _frames: dict[str, int] = field(default_factory=dict)

    @classmethod
    def from_mjcf(
        cls,
        source: str | Path,
        *,
        name: str | None = None,
        q_home: ArrayLike | None = None,
        position_limit: Limit = None,
        velocity_limit: Limit = None,
        acceleration_limit: Limit = None,
        torque_limit: Limit = None,
    ) -> Robot:
        """Read a MuJoCo model file, or its text.

        Torque limits come from the motors. MJCF has no velocity limits: give them
        here, or in the file as `<custom><numeric name="velocity_limit" data=.../>`
        (likewise "acceleration_limit"). A limit may be one number, an array (n,), or
        a mapping from joint names; `math.inf` says "none" on purpose. Acceleration
        limits, where absent, are derived from what the torques can always deliver.

        Raises:
            ModelError: no such file, a limit is missing, or Pinocchio would read
                the file differently from MuJoCo.
            InputError: a limit, the home posture or the name is unusable.
        """
        expect(str | Path, source=source)
        mjcf = read_mjcf(source)
        limits = {
            "position_limit": position_limit,
            "velocity_limit": _first(
                velocity_limit, mjcf.numerics.get("velocity_limit")
            ),
            "acceleration_limit": _first(
                acceleration_limit, mjcf.numerics.get("acceleration_limit")
            ),
            "torque_limit": torque_limit,  # over the model's, which are the motors'
        }
        home = mjcf.home if q_home is None else q_home
        return _assemble(mjcf.model, name, home, limits, mjcf.text, mjcf.notes)

    @classmethod
    def from_urdf(
        cls,
        path: str | Path,
        *,
        name: str | None = None,
        q_home: ArrayLike | None = None,
        position_limit: Limit = None,
        velocity_limit: Limit = None,
        acceleration_limit: Limit = None,
        torque_limit: Limit = None,
    ) -> Robot:
        """Read a URDF file; arguments as for `from_mjcf`.

        Raises:
            ModelError: no such file, not a URDF, or a limit is missing (a URDF's
                effort or velocity of 0 counts as missing).
            InputError: as for `from_mjcf`.
        """
        expect(str | Path, path=path)
        if not Path(path).is_file():
            raise ModelError(f"there is no model file '{path}'.")
        try:
            model = pin.buildModelFromUrdf(str(path))
        except Exception as error:  # Pinocchio raises whatever its parser met
            raise ModelError(f"Pinocchio cannot read '{path}': {error}") from error
        limits = {
            "position_limit": position_limit,
            "velocity_limit": velocity_limit,
            "acceleration_limit": acceleration_limit,
            "torque_limit": torque_limit,
        }
        return _assemble(model, name, q_home, limits, None, ())

    @property
    def nv(self) -> int:
        """Number of degrees of freedom n."""
        return len(self.joint_names)

    @property
    def frames(self) -> tuple[str, ...]:
        """Names of all frames: sites, bodies, joints."""
        return tuple(self._frames)

    def joint_index(self, name: str) -> int:
        """Position of a joint in every (n,) array.

        Raises:
            UnknownName: there is no such joint.
        """
        try:
            return self.joint_names.index(name)
        except ValueError:  # what is no string, too
            raise UnknownName("joint", name, self.joint_names) from None

    def frame_id(self, name: str) -> int:
        """Pinocchio's index of a frame.

        Raises:
            UnknownName: there is no such frame.
        """
        try:
            return self._frames[name]
        except (KeyError, TypeError):  # what is no string, too
            raise UnknownName("frame", name, self._frames) from None

    def state(
        self,
        q: ArrayLike,
        v: ArrayLike | None = None,
        t: float = 0.0,
        dt: float = 1e-3,
        wrenches: Mapping[str, ArrayLike] | None = None,
    ) -> State:
        """The state at position q (n,), velocity v (n,) (default 0), time t [s].

        Raises:
            InputError: wrong shape, NaN or infinite, or dt is not greater than 0.
        """
        from wbc.state import State

        v = np.zeros(self.nv) if v is None else v
        wrenches = {} if wrenches is None else wrenches
        if not isinstance(wrenches, Mapping):
            raise InputError(
                "wrenches must be a mapping {sensor name: (6,)}, not "
                f"{shown(wrenches)}."
            )
        felt = {k: frozen(w, (6,), f"wrench '{k}'") for k, w in wrenches.items()}
        q, v = frozen(q, (self.nv,), "q"), frozen(v, (self.nv,), "v")
        state = State(self, positive(dt, "dt"))
        state.refresh(q, v, number(t, "t"), felt)
        return state

    def __repr__(self) -> str:
        return f"Robot('{self.name}', {self.nv} joints: {', '.join(self.joint_names)})"


def _first(*values: Limit) -> Limit:
    return next((value for value in values if value is not None), None)


def _assemble(
    model: pin.Model,
    name: str | None,
    q_home: ArrayLike | None,
    limits: Mapping[str, Limit],
    mjcf: str | None,
    notes: tuple[str, ...],
) -> Robot:
    joints = _joint_names(model)
    n = len(joints)
    found = joint_limits(model, joints, limits)
    if q_home is None:
        q_home = np.clip(np.zeros(n), *found.box)
    home = frozen(q_home, (n,), "q_home")
    frames: dict[str, int] = {}
    for kind in (pin.FrameType.JOINT, pin.FrameType.BODY, pin.FrameType.OP_FRAME):
        for index, frame in enumerate(model.frames):
            if frame.type & (kind | pin.FrameType.FIXED_JOINT):
                frames[frame.name] = index
    return Robot(
        named(name, model.name or "robot"),
        model,
        joints,
        frozen(found.box[0], (n,), "q_min", finite=False),
        frozen(found.box[1], (n,), "q_max", finite=False),
        frozen(found.velocity, (n,), "v_max", finite=False),
        frozen(found.acceleration, (n,), "a_max", finite=False),
        frozen(found.torque, (n,), "tau_max", finite=False),
        home,
        mjcf,
        notes,
        frames,
    )


def _joint_names(model: pin.Model) -> tuple[str, ...]:
    for name, joint in zip(model.names[1:], list(model.joints)[1:], strict=True):
        if (joint.nq, joint.nv) == (2, 1):  # as cosine and sine
            raise ModelError(
                f"continuous joint '{name}' is not supported: write type=\"revolute\" "
                'and limits as wide as it will turn, lower="-6.3" upper="6.3".'
            )
        if (joint.nq, joint.nv) != (1, 1):
            raise ModelError(
                f"joint '{name}' has {joint.nv} degrees of freedom: wbc controls fixed-"
                "base robots with hinge and slide joints. Fix the base, or use hinges."
            )
    if model.nv == 0:
        raise ModelError("the model has no joints.")
    return tuple(model.names[1:])
