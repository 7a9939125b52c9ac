"""A force/torque sensor between an arm and its tool, as MuJoCo feels it."""

from __future__ import annotations

from typing import final

import mujoco
import numpy as np

from wbc import InputError, UnknownName
from wbc.arrays import Array, positive
from wbc.checks import flag, text, whole
from wbc.compiled import compiled

__all__ = ["WristSensor"]

PARTS = {
    "force": mujoco.mjtSensor.mjSENS_FORCE,
    "torque": mujoco.mjtSensor.mjSENS_TORQUE,
    "linear acceleration": mujoco.mjtSensor.mjSENS_FRAMELINACC,
    "angular acceleration": mujoco.mjtSensor.mjSENS_FRAMEANGACC,
    "angular velocity": mujoco.mjtSensor.mjSENS_FRAMEANGVEL,
}
"""What the engine reads at the site; the last three as an accelerometer would."""


@final
class WristSensor:
    """The wrench that a tool exerts on its surroundings, perfect by default.

    The reading is compensated for the tool's weight and inertial forces, with the
    masses of the controller's model and an accelerometer in the sensor, and tared at
    rest when the cell is reset. It is late by one tick, as the engine's sensors are.

    Args:
        site: where it sits, on a body without joints that carries the tool.
        name: under which controllers find its wrench.
        force_noise: standard deviation of each force [N].
        torque_noise: standard deviation of each moment [Nm].
        force_bias: largest constant error of each force, drawn uniformly [N].
        torque_bias: largest constant error of each moment [Nm].
        cutoff: of a first-order low-pass filter [Hz]; infinite for none.
        tare: whether the reading at reset counts as zero, bias included.
        seed: of bias and noise.

    Raises:
        InputError: a negative number, or an argument of another kind; at mounting, a
            site on a body with joints.
        UnknownName: at mounting, there is no such site.
    """

    def __init__(
        self,
        site: str = "wrist_sensor",
        *,
        name: str = "wrist",
        force_noise: float = 0.0,
        torque_noise: float = 0.0,
        force_bias: float = 0.0,
        torque_bias: float = 0.0,
        cutoff: float = np.inf,
        tare: bool = True,
        seed: int = 0,
    ) -> None:
        flag(tare=tare)
        self.site, self.name, self.tare = text(site, "site"), text(name, "name"), tare
        self._noise = _both(force_noise, torque_noise, "noise")
        self._noisy = bool(self._noise.any())
        self._bias = _both(force_bias, torque_bias, "bias")
        none = isinstance(cutoff, float) and cutoff == np.inf
        self.cutoff = np.inf if none else positive(cutoff, "cutoff")
        self._seed = whole(seed, "seed")

    def mount(self, spec: mujoco.MjSpec) -> None:
        """Add the engine's sensors to a scene, before it is compiled.

        Raises:
            UnknownName: the scene has no such site.
        """
        sites = {site.name for site in spec.sites}
        if self.site not in sites:
            raise UnknownName("site", self.site, sorted(sites))
        for part, kind in PARTS.items():
            spec.add_sensor(
                name=self._part(part),
                type=kind,
                objtype=mujoco.mjtObj.mjOBJ_SITE,
                objname=self.site,
            )

    def bind(self, model: mujoco.MjModel) -> None:
        """Learn the tool's inertia from the compiled scene, as the controller knows it.

        Raises:
            InputError: the sensor's body has joints, so that they carry the tool.
        """
        self._id = model.site(self.site).id
        body = int(model.site_bodyid[self._id])
        if model.body_jntnum[body]:
            raise InputError(
                f"site '{self.site}' of sensor '{self.name}' lies on body "
                f"'{model.body(body).name}', which has joints: a force sensor reads "
                "between a body without joints and its parent."
            )
        self._dt = model.opt.timestep
        self._mass, self._first, self._second = _tool(model, body, self._id)
        start = int(model.sensor(self._part("force")).adr[0])
        self._scratch = np.empty((6, 6))
        self._where = slice(start, start + 3 * len(PARTS))  # mounted in a row

    def reset(self, data: mujoco.MjData) -> None:
        """Start bias, noise and filter again; the arm must be at rest and held."""
        self._rng = np.random.default_rng(self._seed)
        self._zero = self._rng.uniform(-self._bias, self._bias)
        if self.tare:
            self._zero = -self._wrench(data)
        self._filtered: Array | None = None

    def read(self, data: mujoco.MjData) -> Array:
        """Wrench (6,) of the tool ON its surroundings, at the site, world axes."""
        wrench = self._wrench(data) + self._zero
        if self._noisy:
            wrench = wrench + self._rng.normal(0.0, self._noise)
        if self._filtered is None or self.cutoff == np.inf:
            self._filtered = wrench
        else:
            share = 1.0 - np.exp(-2.0 * np.pi * self.cutoff * self._dt)
            self._filtered = self._filtered + share * (wrench - self._filtered)
        return self._filtered.copy()

    def _wrench(self, data: mujoco.MjData) -> Array:
        """What of the arm's push on the tool passes on to the surroundings.

        Here, and nowhere else, signs are settled. The engine reports what the parent
        body exerts on the tool, so what the tool does not need for itself it exerts
        on its surroundings: f = reading - m (a - g), without a flip of the sign.
        The engine's acceleration of a frame is a - g already.
        """
        R = data.site_xmat[self._id].reshape(3, 3)
        feel = data.sensordata[self._where]
        wrench, tool = np.empty(6), (self._mass, self._first, self._second)
        _exerted(R, feel, *tool, self._scratch, wrench)
        return wrench

    def _part(self, part: str) -> str:
        return f"{self.name} {part}"


def _both(force: float, torque: float, what: str) -> Array:
    """One number a component (6,)."""
    force = positive(force, f"force_{what}", zero=True)
    torque = positive(torque, f"torque_{what}", zero=True)
    return np.repeat([force, torque], 3)


@compiled
def _exerted(
    R: Array,
    feel: Array,
    mass: float,
    first: Array,
    second: Array,
    scratch: Array,
    out: Array,
) -> None:
    """Wrench on the surroundings, world axes.

    Args:
        R: (3, 3) orientation of the site.
        feel: (15,) what the engine reads there, in the order of `PARTS`: force and
            torque in the site's axes, the others in the world's.
        mass: of the tool.
        first: (3,) its first moments about the site, in the site's axes.
        second: (3, 3) its second moments.
        scratch: (6, 6) numbers on the way.
        out: (6,) is written.
    """
    local, own = scratch[:3, :3], scratch[3]  # a, alpha, omega in the site's axes
    for part in range(3):
        for i in range(3):
            local[part, i] = 0.0
            for j in range(3):
                local[part, i] += R[j, i] * feel[6 + 3 * part + j]
    a, alpha, w = local[0], local[1], local[2]
    B, T = scratch[:3, 3:], scratch[4, :3]  # a point at r accelerates by a + B r
    for i in range(3):
        for j in range(3):
            B[i, j] = w[i] * w[j]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        B[i, i] = -(w[j] * w[j] + w[k] * w[k])
        B[k, j] += alpha[i]
        B[j, k] -= alpha[i]
    for i in range(3):
        own[i] = feel[i] - mass * a[i]
        for j in range(3):
            own[i] -= B[i, j] * first[j]
        j, k = (i + 1) % 3, (i + 2) % 3
        T[i] = a[k] * first[j] - a[j] * first[k]
        for n in range(3):
            T[i] += B[k, n] * second[n, j] - B[j, n] * second[n, k]
        own[3 + i] = feel[3 + i] - T[i]
    for i in range(3):
        out[i] = R[i, 0] * own[0] + R[i, 1] * own[1] + R[i, 2] * own[2]
        out[3 + i] = R[i, 0] * own[3] + R[i, 1] * own[4] + R[i, 2] * own[5]


def _tool(model: mujoco.MjModel, body: int, site: int) -> tuple[float, Array, Array]:
    """Mass, first (3,) and second moments (3, 3) of a body and all it carries.

    About the site and in its axes, at the posture of the compiled scene: the integrals
    of 1, r and r r^T over the mass.
    """
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    p, R = data.site_xpos[site], data.site_xmat[site].reshape(3, 3)
    first, second = np.zeros(3), np.zeros((3, 3))
    carried = [b for b in range(model.nbody) if _carries(model, body, b)]
    for b in carried:
        mass, r = model.body_mass[b], (data.xipos[b] - p) @ R
        turn = R.T @ data.ximat[b].reshape(3, 3)
        inertia = turn @ np.diag(model.body_inertia[b]) @ turn.T
        first += mass * r
        second += 0.5 * np.trace(inertia) * np.eye(3) - inertia + mass * np.outer(r, r)
    return float(model.body_mass[carried].sum()), first, second


def _carries(model: mujoco.MjModel, body: int, other: int) -> bool:
    while other > body:
        other = int(model.body_parentid[other])
    return other == body
