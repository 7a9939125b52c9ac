"""The constraints cell keeps every bound, and is judged by what really happens."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from robots import racer
from sims import constraints
from sims.constraints import hybrid, joint_limit
from sims.constraints.case import limits, posture_at
from sims.constraints.follower import axes_along
from sims.constraints.surface import NORMAL, PLANE, SURFACE, TIP
from sims.demo import Options
from sims.registry import find_demo
from sims.run import run
from sims.wrist import WristSensor
from tasks import Admittance, AxisAlignment, Damping, Impedance
from wbc import Controller

ARM = racer.load("probe")


@pytest.mark.parametrize(
    ("resolver", "mismatch"), [("hqp", False), ("nullspace", True)]
)
def test_constraints_keep_every_bound(resolver, mismatch):
    options = Options(resolver=resolver, mismatch=mismatch, quiet=True)
    metrics = find_demo("constraints").run(options).metrics
    timed = {"realtime_factor"}  # the machine's, not the process's
    assert [m for m in metrics if not m.holds and m.name not in timed] == []
    names = {m.name for m in metrics}
    assert {
        "plane_distance_final_m",
        "plane_angle_final_rad",
        "plane_position_drift_m",
        "on_plane_distance_max_m",
        "on_plane_angle_max_rad",
        "on_plane_goal_error_m",
        "joint_limit_baseline_violation_rad",
        "joint_limit_goal_error_m",
        "hybrid_force_error_rms_n",
        "hybrid_normal_error_rad",
        "hybrid_contact_lost_fraction",
        "hybrid_impact_peak_n",
    } <= names


def test_the_plate_of_the_scene_is_the_plane_that_the_metrics_know():
    cell = constraints.cell(ARM)
    plate = cell.data.geom("plate")
    R, half = plate.xmat.reshape(3, 3), cell.model.geom("plate").size[2]
    np.testing.assert_allclose(R[:, 2], NORMAL, atol=1e-12)
    np.testing.assert_allclose(plate.xpos + half * R[:, 2], SURFACE, atol=1e-12)
    ball = cell.model.geom("probe_ball").size[0]
    assert PLANE.distance(SURFACE) == pytest.approx(-ball)


def test_a_noisy_sensor_finds_and_holds_the_plate_too():
    """Four seconds: search, contact, and the force at rest."""
    wrist = WristSensor(force_noise=0.5, torque_noise=0.02, cutoff=80.0, seed=7)
    cell = constraints.cell(ARM, mismatch=True, seed=3, wrist=wrist)
    case = hybrid.cases(ARM)[0]
    cell.reset(case.start)
    stack, script = case.make(cell.observe().q, 0.0)
    touch = []
    log = run(
        cell,
        Controller(ARM, stack),
        4.0,
        script=script,
        sites=(TIP,),
        watch=lambda c, _: touch.append(float(c.data.sensor("touch").data[0])) or True,
    )
    force = np.array(touch)
    assert force.max() < 60.0
    late = force[log.t > 3.7]
    assert np.sqrt(np.mean((late.mean() - 20.0) ** 2)) < 1.0
    assert (late > 0.0).all()
    assert log.failures == 0


def test_searching_where_there_is_no_plate_stays_slow():
    cell = constraints.cell(ARM)
    case = hybrid.cases(ARM)[0]
    cell.reset(case.start)
    cell.model.opt.disableflags = int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    stack, script = case.make(cell.observe().q, 0.0)
    log = run(cell, Controller(ARM, stack), 4.0, script=script, sites=(TIP,))
    speed = np.linalg.norm(np.diff(log.p[TIP], axis=0), axis=1) / 1e-3
    assert speed.max() < 1.3 * hybrid.APPROACH
    assert np.isnan(script.found)


@pytest.mark.parametrize(
    ("kind", "mismatch", "short"),
    [(Impedance, False, 0.05), (Admittance, False, 0.05), (Admittance, True, 0.5)],
)
def test_a_compliant_probe_without_a_spring_along_the_normal_presses_as_told(
    kind, mismatch, short
):
    """On real contact; an impedance has no integral, so its model must be right."""
    axes = axes_along(-NORMAL)
    cell = constraints.cell(ARM, mismatch=mismatch)
    q = posture_at(ARM, PLANE.point + 0.002 * NORMAL, -NORMAL)
    cell.reset(q)
    beside = [2000.0, 2000.0, 0.0]
    soft = kind(
        TIP,
        ARM.state(q).frame(TIP).p,
        mass=30.0,
        stiffness=beside,
        damping=[490.0, 490.0, 1500.0],
        force=[0.0, 0.0, 20.0],
        axes=axes,
    )
    upright = AxisAlignment(TIP, -NORMAL, stiffness=2500.0)
    touch = []
    log = run(
        cell,
        Controller(ARM, limits() >> soft >> upright >> Damping()),
        1.5,
        watch=lambda c, _: touch.append(float(c.data.sensor("touch").data[0])) or True,
    )
    assert max(touch) < 60.0
    assert np.abs(np.array(touch)[-200:] - 20.0).max() < short
    assert log.failures == 0


def test_the_ways_of_the_elbow_differ_in_nothing_but_its_limit():
    cases = joint_limit.cases(ARM)
    stacks = [[t.name for t in c.make(ARM.q_home, 0.0)[0].tasks()] for c in cases]
    above = {"joint locking", "joint limits"}
    assert {tuple(n for n in names if n not in above) for names in stacks} == {
        ("torque limits", "goal", "damping")
    }


def test_task_axes_are_a_rotation_along_the_force():
    rng = np.random.default_rng(0)
    for _ in range(5):
        z = rng.normal(size=3)
        z /= np.linalg.norm(z)
        R = axes_along(z)
        np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)
        np.testing.assert_allclose(R[:, 2], z, atol=1e-12)
        assert np.linalg.det(R) > 0.0
