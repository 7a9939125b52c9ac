"""The wrist's force/torque sensor: signs, weight, tare, noise."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from robots import racer
from sims.cell import ArmCell
from sims.mismatch import Mismatch
from sims.wrist import WristSensor
from wbc import InputError, UnknownName

ARM = racer.load("probe")
POSTURE = np.radians([10.0, 10.0, -100.0, 20.0, -70.0, 30.0])
PUSH = np.array([3.0, -2.0, 5.0, 0.1, 0.2, 0.3])  # [N, Nm]
# The reading is turned by the posture of the tick after it, [N] and [Nm] of a slow arm.
LATE = 5e-3


def cell(wrist: WristSensor, mismatch: Mismatch | None = None) -> ArmCell:
    made = ArmCell(
        "wrist",
        ARM,
        mujoco.MjSpec.from_string(ARM.mjcf),
        wrist=wrist,
        mismatch=mismatch,
    )
    made.reset(POSTURE)
    return made


def reading(made: ArmCell) -> np.ndarray:
    return made.observe().wrenches["wrist"]


def hold(made: ArmCell, ticks: int, swing: float = 0.0) -> None:
    for tick in range(ticks):
        made.apply(made.data.qfrc_bias + swing * np.sin(0.05 * tick + np.arange(6)))
        made.step()


def push(made: ArmCell, wrench: np.ndarray) -> None:
    """Let the surroundings push the tool, at its centre of mass."""
    made.data.xfrc_applied[made.model.body("probe").id] = wrench


def at_sensor(made: ArmCell, wrench: np.ndarray) -> np.ndarray:
    """The same wrench about the sensor's site."""
    body = made.model.body("probe").id
    arm = made.data.xipos[body] - made.data.site("wrist_sensor").xpos
    return np.r_[wrench[:3], wrench[3:] + np.cross(arm, wrench[:3])]


def test_a_tool_that_touches_nothing_exerts_nothing_at_rest_or_moving():
    made = cell(WristSensor(tare=False))
    assert_allclose(reading(made), 0.0, atol=1e-12)
    hold(made, 200, swing=2.0)
    assert np.abs(made.data.qvel).max() > 0.02
    assert_allclose(reading(made), 0.0, atol=LATE)


def test_the_wrench_is_what_the_robot_does_to_its_surroundings():
    made = cell(WristSensor())
    push(made, PUSH)
    hold(made, 5)
    assert_allclose(reading(made), at_sensor(made, -PUSH), atol=LATE)


def test_pressing_on_a_floor_is_a_force_downwards():
    spec = mujoco.MjSpec.from_string(ARM.mjcf)
    tip = ARM.state(POSTURE).frame("probe_tip").p
    spec.worldbody.add_geom(
        name="block",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=tip - [0.0, 0.0, 0.0079 + 0.05],
        size=[0.05] * 3,
    )
    spec.add_pair(geomname1="probe_ball", geomname2="block", condim=1)
    made = ArmCell("floor", ARM, spec, wrist=WristSensor(tare=False))
    made.reset(POSTURE)
    hold(made, 3)
    x, y, z = reading(made)[:3]
    assert z < -0.3
    assert abs(x) + abs(y) < 0.02 * abs(z)


def test_taring_removes_bias_and_the_weight_that_the_model_has_wrong():
    for tare in (True, False):
        wrist = WristSensor(force_bias=2.0, torque_bias=0.1, tare=tare, seed=3)
        error = np.abs(reading(cell(wrist, Mismatch(seed=1)))).max()
        assert (error < 1e-9) == tare


def test_noise_is_seeded_and_of_the_size_asked_for():
    wrist = WristSensor(force_noise=0.5, torque_noise=0.02, seed=4)
    made = cell(wrist)
    first = np.array([reading(made) for _ in range(2000)])
    assert_allclose(first.std(0), np.repeat([0.5, 0.02], 3), rtol=0.1)
    made.reset(POSTURE)
    again = np.array([reading(made) for _ in range(2000)])
    assert_array_equal(first, again)


def test_the_low_pass_passes_a_constant_and_damps_noise():
    made = cell(WristSensor(force_noise=0.5, cutoff=10.0))
    push(made, PUSH)
    hold(made, 3)
    readings = np.array([reading(made) for _ in range(3000)])
    assert_allclose(readings[500:].mean(0)[:3], -PUSH[:3], atol=0.05)
    assert readings[500:, 0].std() < 0.15


def test_a_sensor_that_cannot_be_is_refused():
    with pytest.raises(UnknownName, match="wrist_sensor"):
        cell(WristSensor("wirst_sensor"))
    with pytest.raises(InputError, match="body 'link6', which has joints"):
        cell(WristSensor("flange"))
    with pytest.raises(InputError, match="force_noise"):
        WristSensor(force_noise=-1.0)
    with pytest.raises(InputError, match="cutoff"):
        WristSensor(cutoff=0.0)
