"""Limits of a robot's joints: what is given, what the model says, what follows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias, final

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from wbc.arrays import Array, numbers
from wbc.errors import InputError, ModelError, UnknownName

__all__ = ["Limit", "Limits", "braking_acceleration", "joint_limits"]

Limit: TypeAlias = ArrayLike | Mapping[str, float] | None

BRAKING_SAMPLES = 256
BRAKING_RESERVE = 0.5
MASSLESS = 1e-14  # least over largest eigenvalue of M that is round-off


@final
@dataclass(frozen=True, slots=True, eq=False)
class Limits:
    """Limits (n,) of the joints, infinite where there is none; `Robot` has the units.

    Attributes:
        box: lower and upper position limits.
        velocity: velocity limits.
        acceleration: accelerations that may be counted on for braking.
        torque: torque limits.
    """

    box: tuple[Array, Array]
    velocity: Array
    acceleration: Array
    torque: Array


def joint_limits(
    model: pin.Model, joints: Sequence[str], given: Mapping[str, Limit]
) -> Limits:
    """Limits by their names in `Robot.from_mjcf`, over those of the model.

    Raises:
        ModelError: a limit is missing, a range is empty, a joint moves no inertia,
            or the torques cannot hold the robot.
        InputError: a limit has a wrong shape, or is not positive.
        UnknownName: a limit is given for a joint that is not there.
    """
    _refuse_massless(model, joints)
    box = _position_limits(model, joints, given["position_limit"])
    tau = _limit("torque_limit", joints, given["torque_limit"], model.upperEffortLimit)
    v = _limit(
        "velocity_limit", joints, given["velocity_limit"], model.upperVelocityLimit
    )
    if given["acceleration_limit"] is None:
        a = braking_acceleration(model, box, tau)
    else:
        a = _limit("acceleration_limit", joints, given["acceleration_limit"], None)
    return Limits(box, v, a, tau)


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
        half = _limit("position_limit", joints, given, None)
        if not isinstance(given, Mapping) and np.isnan(half).any():
            raise InputError(f"position_limit must be free of NaN, got {half}.")
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
            limit[joints.index(joint)] = _stated(
                value, f"{what} of joint '{joint}'", ()
            )
    elif given is not None:
        limit[:] = _stated(given, what, (), (n,))
    if what != "position_limit" and np.isnan(limit).any():
        raise _missing(
            what, [j for j, x in zip(joints, limit, strict=True) if np.isnan(x)]
        )
    if (limit <= 0).any():
        bad = joints[int(np.argmax(limit <= 0))]
        raise InputError(f"{what} of joint '{bad}' must be greater than 0.")
    return limit


def _stated(given: Any, what: str, *shapes: tuple[int, ...]) -> Array:
    """Numbers of one of these shapes; NaN says that it is missing."""
    values = numbers(given, what)
    if values.shape not in shapes:
        allowed = " or ".join(map(str, shapes))
        raise InputError(f"{what} has shape {values.shape}; it must be {allowed}.")
    return values


def _missing(what: str, joints: Sequence[str]) -> ModelError:
    return ModelError(
        f"the model gives no {what} for joint {', '.join(joints)}. Pass {what}= "
        "a number, an array or {joint: value}; math.inf says that there is none."
    )
