"""The knife's task against what it cuts, and two arms that keep clear."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

from robots import compose, lwr4
from tasks import Clearance, FramePose, FramePosition, JointLimits, KnifePose, Posture
from tests.tolerances import ROUND_OFF, SAME
from wbc import Controller, InputError, UnknownName, allocate_rows, resolve

ARM = lwr4.load("knife")
TIP, SENSOR = "knife_tip", "wrist_sensor"
WRENCH = np.array([25.0, -8.0, 12.0, 1.0, -2.0, 0.5])
Q = np.radians([10.0, -20.0, 15.0, 80.0, 5.0, -75.0, 20.0])
V = np.array([0.1, -0.2, 0.05, 0.1, -0.1, 0.2, 0.3])


def state(wrenches=None):
    return ARM.state(Q, V, wrenches=wrenches)


def target():
    F = state().frame(TIP)
    return F.p + np.array([0.01, -0.02, 0.005]), F.R


def test_without_a_sensor_it_is_a_frame_pose():
    knife = resolve(state(), KnifePose(TIP, *target()))
    pose = resolve(state(), FramePose(TIP, *target()))
    assert_allclose(knife.torque, pose.torque, rtol=SAME)


def test_a_measured_wrench_does_not_move_the_knife():
    """M vdot + h = tau - J^T f under the true wrench: P0 eq. (17) with its J^T h."""
    task = KnifePose(TIP, *target(), sensor="wrist", sensor_frame=SENSOR)
    at = state({"wrist": WRENCH})
    solution = resolve(at, task >> Posture())
    J = at.frame(SENSOR).J
    vdot = np.linalg.solve(at.M, solution.torque - at.h - J.T @ WRENCH)
    F = at.frame(TIP)
    free = resolve(state(), FramePose(TIP, *target()) >> Posture())
    assert_allclose(F.J @ vdot, F.J @ free.acceleration, atol=1e-7)


@pytest.mark.parametrize("angle", [-0.4, 0.0, 0.3])
def test_rocking_leaves_the_turn_about_the_blades_normal_free(angle):
    p, R = target()
    wanted = R @ np.array(pin.exp3(np.array([0.0, angle, 0.0])))
    task = KnifePose(TIP, p, wanted, rocking=True)
    rows = allocate_rows(len(task.row_names(ARM)), ARM.nv)
    task.update(state(), rows)
    assert len(rows.error) == 5
    assert_allclose(rows.error[3:], 0.0, atol=ROUND_OFF)
    assert_allclose(rows.error[:3], state().frame(TIP).p - p, atol=ROUND_OFF)


def test_rocking_still_holds_the_flat_of_the_blade():
    p, R = target()
    for axis in (0, 2):
        turned = R @ np.array(pin.exp3(0.2 * np.eye(3)[axis]))
        task = KnifePose(TIP, p, turned, rocking=True)
        rows = allocate_rows(5, ARM.nv)
        task.update(state(), rows)
        assert np.linalg.norm(rows.error[3:]) == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("part", "message"),
    [
        ({"position": [0.0, 0.0]}, r"target position .* shape \(2,\)"),
        ({"orientation": np.ones(9)}, r"target orientation .* shape \(9,\)"),
        ({"twist": np.zeros(3)}, r"target twist .* shape \(3,\)"),
        ({"acceleration": [1.0]}, r"target acceleration .* shape \(1,\)"),
        ({"position": [0.0, np.nan, 0.0]}, "must be finite"),
        ({"orientation": np.full((3, 3), np.inf)}, "must be finite"),
        ({"twist": np.full(6, np.nan)}, "must be finite"),
        ({"acceleration": np.full(6, np.inf)}, "must be finite"),
        ({"orientation": 1.1 * np.eye(3)}, "not a rotation matrix"),
        ({"orientation": np.diag([1.0, 1.0, -1.0])}, "not a rotation matrix"),
        ({"orientation": np.zeros((3, 3))}, "not a rotation matrix"),
        ({"position": ["a", 0, 0]}, "not an array of numbers"),
    ],
)
def test_an_unusable_target_is_refused_and_the_old_one_stays(part, message):
    p, R = target()
    task, fresh = KnifePose(TIP, p, R), KnifePose(TIP, p, R)
    with pytest.raises(InputError, match=message):
        task.set_target(**({"position": p + 1.0, "orientation": np.eye(3)} | part))
    before, after = (resolve(state(), t >> Posture()).torque for t in (fresh, task))
    assert_allclose(after, before, rtol=0, atol=0)


def test_a_target_may_come_in_any_layout_and_type():
    p, R = target()
    task, other = KnifePose(TIP, p, R), KnifePose(TIP, p, np.eye(3))
    frozen = np.asfortranarray(R)
    frozen.flags.writeable = False
    other.set_target(tuple(p), frozen, [0] * 6)
    given, taken = (resolve(state(), t >> Posture()).torque for t in (task, other))
    assert_allclose(taken, given, rtol=0, atol=0)


def test_a_missing_sensor_is_named():
    task = KnifePose(TIP, *target(), sensor="wirst", sensor_frame=SENSOR)
    with pytest.raises(UnknownName, match="Valid names: wrist"):
        resolve(state({"wrist": WRENCH}), task)


PAIR = compose.load(
    {
        "left": compose.Placed(lwr4.mjcf(None)),
        "right": compose.Placed(lwr4.mjcf(None), (0.0, 0.5, 0.0)),
    }
)


@pytest.mark.parametrize("apart", [0.15, 0.25])
def test_two_arms_sent_to_one_place_stop_at_their_clearance(apart):
    """Both flanges are wanted at the same point, above them the clearance."""
    flanges = [f"{arm}_flange" for arm in ("left", "right")]
    goal = np.array([0.45, 0.25, 0.55])
    work = FramePosition(flanges[0], goal) + FramePosition(flanges[1], goal)
    stack = JointLimits() >> Clearance(*flanges, apart) >> work >> Posture(stiffness=4)
    controller, dt = Controller(PAIR, stack, dt=2e-3), 2e-3
    q, v, least = PAIR.q_home.copy(), np.zeros(14), np.inf
    for _ in range(1500):
        v = v + dt * controller(q, v).acceleration
        q = q + dt * v
        A, B = (PAIR.state(q).frame(name) for name in flanges)
        least = min(least, float(np.linalg.norm(A.p - B.p)))
    assert least > apart - 1e-4
    assert np.linalg.norm(A.p - B.p) == pytest.approx(apart, abs=1e-3)
    assert controller.failures == 0


def test_too_near_is_left_again_and_nonsense_refused():
    flanges = ("left_flange", "right_flange")
    at = PAIR.state(PAIR.q_home)
    d = np.linalg.norm(at.frame(flanges[0]).p - at.frame(flanges[1]).p)
    solution = resolve(at, Clearance(*flanges, d + 0.1))
    A, B = (at.frame(name) for name in flanges)
    pushed = (A.J[:3] - B.J[:3]) @ solution.acceleration
    assert pushed @ (A.p - B.p) / d > 9.9
    with pytest.raises(InputError, match="no distance from itself"):
        Clearance("a", "a", 0.1)
    with pytest.raises(InputError, match="distance"):
        Clearance("a", "b", 0.0)
