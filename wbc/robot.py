"""The robot: names, limits, home posture and the Pinocchio model behind them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias, final

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from wbc.arrays import Array, frozen
from wbc.errors import InputError, ModelError, UnknownName
from wbc.mjcf import read_mjcf

if TYPE_CHECKING:
    from wbc.state import State

__all__ = ["Robot"]

Limit: TypeAlias = ArrayLike | Mapping[str, float] | None

BRAKING_SAMPLES = 256
BRAKING_RESERVE = 0.5
MASSLESS = 1e-14  # least over largest eigenvalue of M that is round-off


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
        """
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
        """
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
        if name not in self.joint_names:
            raise UnknownName("joint", name, self.joint_names)
        return self.joint_names.index(name)

    def frame_id(self, name: str) -> int:
        """Pinocchio's index of a frame.

        Raises:
            UnknownName: there is no such frame.
        """
        if name not in self._frames:
            raise UnknownName("frame", name, self._frames)
        return self._frames[name]

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
            InputError: wrong shape, NaN or infinite.
        """
        from wbc.state import State

        v = np.zeros(self.nv) if v is None else v
        checked = {
            key: frozen(value, (6,), f"wrench '{key}'")
            for key, value in (wrenches or {}).items()
        }
        state = State(self, dt)
        state.refresh(
            frozen(q, (self.nv,), "q"), frozen(v, (self.nv,), "v"), t, checked
        )
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
    _refuse_massless(model, joints)
    box = _position_limits(model, joints, limits["position_limit"])
    tau = _limit("torque_limit", joints, limits["torque_limit"], model.upperEffortLimit)
    v = _limit(
        "velocity_limit", joints, limits["velocity_limit"], model.upperVelocityLimit
    )
    if limits["acceleration_limit"] is None:
        a = braking_acceleration(model, box, tau)
    else:
        a = _limit("acceleration_limit", joints, limits["acceleration_limit"], None)
    if q_home is None:
        q_home = np.clip(np.zeros(n), *box)
    home = frozen(q_home, (n,), "q_home")
    frames: dict[str, int] = {}
    for kind in (pin.FrameType.JOINT, pin.FrameType.BODY, pin.FrameType.OP_FRAME):
        for index, frame in enumerate(model.frames):
            if frame.type & (kind | pin.FrameType.FIXED_JOINT):
                frames[frame.name] = index
    return Robot(
        name or model.name or "robot",
        model,
        joints,
        frozen(box[0], (n,), "q_min", finite=False),
        frozen(box[1], (n,), "q_max", finite=False),
        frozen(v, (n,), "v_max", finite=False),
        frozen(a, (n,), "a_max", finite=False),
        frozen(tau, (n,), "tau_max", finite=False),
        home,
        mjcf,
        notes,
        frames,
    )


def _joint_names(model: pin.Model) -> tuple[str, ...]:
    odd = [
        f"'{model.names[i]}' ({model.joints[i].shortname()})"
        for i in range(1, model.njoints)
        if model.joints[i].nq != 1 or model.joints[i].nv != 1
    ]
    if odd:
        raise ModelError(
            f"wbc controls fixed-base robots with hinge and slide joints, not "
            f"{', '.join(odd)}. Fix the base; give continuous joints limits."
        )
    if model.nv == 0:
        raise ModelError("the model has no joints.")
    return tuple(model.names[1:])


def _refuse_massless(model: pin.Model, joints: Sequence[str]) -> None:
    """Refuse a joint that moves nothing: no finite torque fits its acceleration."""
    n = model.nv
    # One generic posture will do: M is analytic, so singular here is singular always.
    q = np.random.default_rng(0).uniform(-1.0, 1.0, n)
    M = _inertia(model, model.createData(), q)
    values, vectors = np.linalg.eigh(M)
    if values[0] <= MASSLESS * values[-1]:
        joint = joints[int(np.argmax(np.abs(vectors[:, 0])))]
        raise ModelError(
            f"joint '{joint}' moves no inertia: nothing behind it has any about its "
            "axis. Give its link mass and inertia, or make it a fixed joint."
        )


def _inertia(model: pin.Model, data: pin.Data, q: Array) -> Array:
    M = np.array(pin.crba(model, data, q)).reshape(model.nv, model.nv)
    return np.triu(M) + np.triu(M, 1).T


def _position_limits(
    model: pin.Model, joints: Sequence[str], given: Limit
) -> tuple[Array, Array]:
    lower, upper = (
        np.array(model.lowerPositionLimit),
        np.array(model.upperPositionLimit),
    )
    absent = ~np.isfinite(lower) | ~np.isfinite(upper) | (np.abs(upper) > 1e30)
    absent |= np.abs(lower) > 1e30
    if given is not None:
        half = _limit("position_limit", joints, given, np.full(len(joints), np.nan))
        stated = ~np.isnan(half)
        lower, upper = np.where(stated, -half, lower), np.where(stated, half, upper)
        absent &= ~stated
    if absent.any():
        raise _missing(
            "position_limit", [j for j, a in zip(joints, absent, strict=True) if a]
        )
    if (lower >= upper).any():
        bad = joints[int(np.argmax(lower >= upper))]
        raise ModelError(f"joint '{bad}': lower position limit is not below the upper.")
    return lower, upper


def _limit(
    what: str, joints: Sequence[str], given: Limit, from_model: Array | None
) -> Array:
    """One positive limit a joint: what is given over what the model says."""
    n = len(joints)
    limit = np.full(n, np.nan)
    if from_model is not None:
        values = np.array(from_model, dtype=np.float64)
        known = (values > 0) & (values < 1e30)
        limit[known] = values[known]
    if isinstance(given, Mapping):
        for joint, value in given.items():
            if joint not in joints:
                raise UnknownName("joint", joint, joints)
            limit[joints.index(joint)] = value
    elif given is not None:
        values = np.asarray(given, dtype=np.float64)
        if values.shape not in ((), (n,)):
            raise InputError(
                f"{what} has shape {values.shape}; it must be () or ({n},)."
            )
        limit[:] = values
    if what != "position_limit" and np.isnan(limit).any():
        raise _missing(
            what, [j for j, x in zip(joints, limit, strict=True) if np.isnan(x)]
        )
    if (limit <= 0).any():
        bad = joints[int(np.argmax(limit <= 0))]
        raise InputError(f"{what} of joint '{bad}' must be greater than 0.")
    return limit


def _missing(what: str, joints: Sequence[str]) -> ModelError:
    return ModelError(
        f"the model gives no {what} for joint {', '.join(joints)}. Pass {what}= "
        "a number, an array or {joint: value}; math.inf says that there is none."
    )


def braking_acceleration(
    model: pin.Model, box: tuple[Array, Array], tau_max: Array
) -> Array:
    """Joint accelerations (n,) that the torque limits deliver in any posture at rest.

    The largest a = s tau_max / diag(M) with |M| a <= tau_max - |g| over seeded
    random postures, times a reserve of one half for Coriolis forces.

    Raises:
        ModelError: some posture cannot even be held against gravity.
    """
    n = model.nv
    if not np.isfinite(tau_max).all():
        return np.full(n, np.inf)
    lower = np.where(np.isfinite(box[0]), box[0], -np.pi)
    upper = np.where(np.isfinite(box[1]), box[1], np.pi)
    data, rng = model.createData(), np.random.default_rng(0)
    best = np.full(n, np.inf)
    for q in rng.uniform(lower, upper, (BRAKING_SAMPLES, n)):
        M = _inertia(model, data, q)
        spare = tau_max - np.abs(pin.computeGeneralizedGravity(model, data, q))
        if (spare <= 0).any():
            joint = model.names[1 + int(np.argmin(spare))]
            raise ModelError(
                f"torque_limit cannot hold joint '{joint}' against gravity "
                "everywhere: give acceleration_limit yourself."
            )
        direction = tau_max / np.diag(M)
        best = np.minimum(best, direction * (spare / (np.abs(M) @ direction)).min())
    return BRAKING_RESERVE * best
