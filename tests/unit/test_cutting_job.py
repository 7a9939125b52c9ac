"""Pieces of the cutting job: ways, guards, pull, reach, clearance, blind passages."""

from __future__ import annotations

import re

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

from robots import lwr4
from sims.cutting.camera import Frame
from sims.cutting.clearance import segment_gap
from sims.cutting.correction import Correction
from sims.cutting.glide import Glide
from sims.cutting.guard import Guard
from sims.cutting.layout import CUTTER, DEPTHS, TIP, Plan, robot_of
from sims.cutting.passages import Passages
from sims.cutting.pull import Pull
from sims.cutting.reach import check_reach, reach
from sims.cutting.scene import UPRIGHT
from sims.cutting.stacks import posture_at
from tasks import Impedance
from tests.tolerances import DIFFERENCE, ROUND_OFF, STEP
from wbc import InputError

P, P_END = np.array([0.3, 0.1, 0.4]), np.array([0.5, 0.2, 0.3])


# ---------------------------------------------------------------------------- glides


def test_a_glide_goes_from_pose_to_pose_with_the_twist_that_it_says():
    glide = Glide(P, 0.2, P_END, -0.5, 1.5)
    at = [glide.at(glide.share(t)) for t in (0.0, 1.5)]
    assert_allclose([at[0].p, at[1].p], [P, P_END], atol=ROUND_OFF)
    assert_allclose([at[0].V, at[1].V], 0.0, atol=ROUND_OFF)
    for t in (0.3, 0.8, 1.2):
        before, now, after = (glide.at(glide.share(t + d)) for d in (-STEP, 0.0, STEP))
        turn = np.array(pin.log3(after.R @ before.R.T)) / (2.0 * STEP)
        moved = (after.p - before.p) / (2.0 * STEP)
        assert_allclose(now.V, np.concatenate([moved, turn]), atol=DIFFERENCE)
        assert_allclose(now.A, (after.V - before.V) / (2.0 * STEP), atol=DIFFERENCE)


# ---------------------------------------------------------------------------- guards

CALM = {
    "tip": P,
    "wanted": P,
    "knife": np.array([20.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    "pull": 99.0,
    "due": 100.0,
}


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"wanted": P_END}, r"knife blocked at \(0.300, 0.100, 0.400\) m: 245 mm"),
        ({"knife": np.full(6, 100.0)}, "cutting force out of bounds .* 173 N"),
        ({"pull": 150.0}, "pull out of bounds: 150 N instead of 100 N"),
    ],
)
def test_a_guard_speaks_up_when_something_lasts(wrong, words):
    guard, seen = Guard(), CALM | wrong
    said = [guard.check(tick * 1e-3, **seen) for tick in range(200)]
    assert said[40] is None
    assert re.search(words, said[60])


def test_a_guard_forgets_what_was_short_and_bears_a_muscle_that_comes_free():
    guard = Guard()
    for tick in range(1000):
        now = CALM | ({"wanted": P_END} if tick % 40 < 30 else {}) | {"pull": 20.0}
        assert guard.check(tick * 1e-3, **now) is None


# ------------------------------------------------------------------------------ pull


def pulling() -> tuple[Impedance, Pull]:
    task = Impedance("grip", P)
    return task, Pull(task, P, 100.0)


def test_the_pull_rises_holds_and_falls():
    _, pull = pulling()
    due = []
    for tick in range(3000):
        t = tick * 1e-3
        if tick == 2000:
            pull.release(t, 0.5)
        pull.tick(t, 0.1)
        due.append(pull.due)
    assert due[0] == 0.0
    assert due[1500] == 100.0
    assert 0.0 < due[2250] < 100.0
    assert due[-1] == 0.0
    assert np.abs(np.diff(due)).max() < 0.5


def test_the_desired_velocity_follows_a_steady_opening_and_brakes_after_release():
    task, pull = pulling()
    for tick in range(2000):
        pull.tick(tick * 1e-3, 0.1 + 0.02 * tick * 1e-3)
    assert task._target[1] == pytest.approx([0.0, 0.02, 0.0], abs=1e-6)
    pull.release(2.0, 0.02)
    for tick in range(2000, 2100):
        pull.tick(tick * 1e-3, 0.1 + 0.5 * tick * 1e-3)
    assert task._target[1] == pytest.approx(np.zeros(3))
    assert task._force[1] < -50.0


# ----------------------------------------------------------------- reach and clearance


@pytest.mark.parametrize("z", [DEPTHS[0], DEPTHS[-1]])
def test_reach_is_where_inverse_kinematics_finds_a_posture(z):
    robot = robot_of(CUTTER)
    near, far = reach(robot, z)
    assert 0.2 < near < 0.35
    assert 0.68 < far < 0.79
    posture_at(robot, TIP, np.array([near + 0.03, 0.0, z]), UPRIGHT)
    posture_at(robot, TIP, np.array([far - 0.01, 0.0, z]), UPRIGHT)
    with pytest.raises(InputError, match="Is the target within reach"):
        posture_at(robot, TIP, np.array([far + 0.02, 0.0, z]), UPRIGHT)


def test_a_line_out_of_reach_is_told_with_the_range():
    line = np.column_stack([np.linspace(0.5, 0.9, 5), np.zeros(5), np.full(5, 0.3)])
    with pytest.raises(InputError, match=r"the way .* reaches 0\.\d+ to 0\.\d+ m"):
        check_reach(robot_of(CUTTER), line, "the way")


def test_gaps_between_chains_are_those_of_their_nearest_points():
    a = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    b = np.array([[0.5, 0.3, 1.0], [0.5, 0.3, 0.0], [0.5, 0.3, -1.0]])
    assert segment_gap(a, b) == pytest.approx(0.3, abs=1e-9)


def test_both_arms_are_the_lwr():
    assert robot_of(CUTTER).nv == lwr4.load().nv == 7


# -------------------------------------------------------------------------- passages


def points() -> np.ndarray:
    x, z = np.meshgrid(np.linspace(0.35, 0.6, 25), np.linspace(0.275, 0.355, 9))
    return np.column_stack([x.ravel(), 0.15 + 0.0 * x.ravel(), z.ravel()])


def walk(passages: Passages, blind: tuple[float, float], until: float = 30.0):
    """Targets (T, 3) of a knife that sees a seam at y = 0.15, except when blind."""
    frame, way = None, []
    for tick in range(int(until * 1000)):
        t = tick * 1e-3
        if tick % 16 == 0 and not blind[0] <= t < blind[1]:
            frame = Frame(t, points())
        target = passages.tick(t, 1e-3, frame, 0.15)
        way.append([t, *target.p, *target.V[:3]])
        if passages.phase == "done":
            break
    return np.array(way)


def new(**options) -> Passages:
    plan = Plan(depths=(0.33, 0.31), stroke=2.0, travel=0.5, lift=0.3, settling=0.2)
    begin = np.array([0.338, 0.15, 0.40])
    return Passages(
        plan, Correction("local"), period=0.016, delay=0.0, noise=0.0, p=begin,
        theta=0.0, **options,
    )  # fmt: skip


def test_passages_visit_every_depth_without_a_jump():
    passages = new()
    way = walk(passages, (np.inf, np.inf))
    assert passages.completed == 2
    assert {0.33, 0.31, 0.40} <= set(way[:, 3].round(6))
    jump = np.abs(np.diff(way[:, 1:4], axis=0)).max()
    assert jump < 1.5e-3
    assert_allclose(np.diff(way[:, 1:4], axis=0) / 1e-3, way[1:, 4:], atol=0.02)


def test_a_blind_passage_stops_holds_its_line_and_goes_on():
    seeing, passages = walk(new(), (np.inf, np.inf)), new()
    way = walk(passages, (1.8, 2.8))
    stopped = way[(way[:, 0] > 2.5) & (way[:, 0] < 2.8)]
    assert np.abs(stopped[:, 4:]).max() < 1e-3
    assert np.abs(way[way[:, 0] > 1.2][:, 2] - 0.15).max() < 1e-6
    assert passages.completed == 2
    assert way[-1, 0] == pytest.approx(seeing[-1, 0] + 1.0, abs=0.2)


def test_finishing_early_slows_down_and_lifts():
    passages = new()
    walk(passages, (np.inf, np.inf), until=1.9)
    assert passages.phase == "stroke"
    speed = np.linalg.norm(passages.target.V[:3])
    assert speed > 0.05
    passages.finish()
    way = [passages.target.p]
    frame = Frame(0.0, points())
    ticks = np.arange(1900, 4000)
    way.extend(passages.tick(tick * 1e-3, 1e-3, frame, 0.15).p for tick in ticks)
    assert passages.phase == "done"
    assert passages.completed == 1
    assert np.abs(np.diff(way, axis=0)).max() < 1.5e-3
    assert way[-1][2] == pytest.approx(0.40)
