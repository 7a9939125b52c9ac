"""The contact cell: beliefs, search, circle fit, and what happens without a hole."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from numpy.testing import assert_allclose

from robots import racer
from sims import contact
from sims.contact.circle import CircleFit
from sims.contact.crank import believed_cranks, handle
from sims.contact.demo import UP, posture_at
from sims.contact.peg import (
    ABOVE,
    DOWN,
    ERROR,
    Search,
    believed_holes,
)
from sims.contact.results import force_of
from sims.contact.scene import (
    CLEARANCE,
    CRANK,
    CRANK_JOINT,
    HOLE,
    LEVER,
    PEG,
    SIDES,
    TIP,
)
from sims.contact.spiral import Spiral
from sims.run import run
from wbc import Controller, InputError

FIT = 1e-9  # of a circle through exact points, with a belief of little weight [m]
PLACE = 1e-9  # [m]
WAY = 0.05  # relative, of a spiral sampled in steps


@pytest.fixture(scope="module")
def arm():
    return racer.load("peg")


def test_beliefs_lie_within_the_error_all_around_the_hole():
    away = np.array(believed_holes(0, 200)) - HOLE
    assert np.linalg.norm(away, axis=1).max() <= ERROR
    assert np.linalg.norm(away, axis=1).max() > 0.9 * ERROR
    assert (away[:, :2].min(axis=0) < -0.5 * ERROR).all()
    assert_allclose(away[:, 2], 0.0)


def test_the_hole_is_as_wide_as_said_and_round_to_a_tenth_of_a_millimetre(arm):
    model = contact.cell(arm).model
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    for k in range(SIDES):
        geom = model.geom(f"block_side{k}").id
        inward = -data.geom_xmat[geom].reshape(3, 3)[:, 0]
        face = data.geom_xpos[geom] + model.geom_size[geom][0] * inward
        assert_allclose((HOLE - face) @ inward, PEG + 0.5 * CLEARANCE, atol=PLACE)
    corner = (PEG + 0.5 * CLEARANCE) / np.cos(np.pi / SIDES)
    assert corner - PEG < 3e-4


def test_the_capsules_of_the_peg_fill_it_and_no_more(arm):
    model = contact.cell(arm).model
    for rib in range(12):
        geom = model.geom(f"peg_rib{rib}")
        assert_allclose(np.linalg.norm(geom.pos[:2]) + geom.size[0], PEG, atol=1e-6)
        assert_allclose(geom.pos[2] + geom.size[1] + geom.size[0], 0.16, atol=1e-6)


def test_the_spiral_is_as_fast_and_as_dense_as_said():
    spiral, dt, time = Spiral(pitch=1e-3, speed=8e-3), 1e-3, 3.0
    rows = [spiral.advance(dt) for _ in range(round(time / dt))]
    places, velocities = (np.array(column) for column in zip(*rows, strict=True))
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)[500:]
    assert_allclose(steps / dt, 8e-3, rtol=WAY)
    assert_allclose(np.linalg.norm(velocities, axis=1), 8e-3, rtol=WAY)
    assert_allclose(8e-3 * time, np.pi * spiral.radius**2 / 1e-3, rtol=WAY)
    assert_allclose(np.linalg.norm(places[-1]), spiral.radius)


def test_a_circle_is_found_from_points_on_an_arc():
    rng = np.random.default_rng(0)
    centre, radius = np.array([0.4, -0.3]), 0.12
    fit = CircleFit(centre + np.array([0.004, -0.003]), radius + 0.003, 1e-6)
    for angle in rng.uniform(0.0, 2.0, 400):
        fit.add(centre + radius * np.array([np.cos(angle), np.sin(angle)]))
    assert_allclose(fit.centre, centre, atol=FIT)
    assert_allclose(fit.radius, radius, atol=FIT)


def test_without_points_a_circle_is_what_was_believed():
    fit = CircleFit(np.array([0.4, -0.3]), 0.12, 5e-3)
    assert_allclose(fit.centre, [0.4, -0.3])
    assert_allclose(fit.radius, 0.12)


@pytest.mark.parametrize(
    ("radius", "spread", "word"), [(0.0, 1e-3, "radius"), (0.1, -1.0, "spread")]
)
def test_a_circle_needs_sizes_that_are_positive(radius, spread, word):
    with pytest.raises(InputError, match=word):
        CircleFit(np.zeros(2), radius, spread)


def test_the_handle_is_where_the_engine_has_it(arm):
    cell = contact.cell(arm)
    crank = cell.model.body("crank").id
    for angle in (0.0, 1.0, 4.0):
        cell.data.qpos[cell.model.joint(CRANK_JOINT).qposadr[0]] = angle
        mujoco.mj_kinematics(cell.model, cell.data)
        R = cell.data.xmat[crank].reshape(3, 3)
        place = cell.data.xpos[crank] + R @ [LEVER, 0.0, 0.0]
        assert_allclose(handle(angle), place, atol=PLACE)


def test_beliefs_of_the_crank_are_a_few_millimetres_off():
    beliefs = believed_cranks(0, 50)
    errors = np.array([[*(b.centre - CRANK[:2]), b.radius - LEVER] for b in beliefs])
    assert np.abs(errors).max() <= 5e-3
    assert np.abs(errors).max() > 3e-3


def test_a_search_without_a_hole_ends_on_the_surface_and_says_so(arm):
    beside = HOLE + np.array([0.026, 0.0, 0.0])
    cell = contact.cell(arm)
    cell.reset(posture_at(arm, beside + ABOVE * UP))
    search = Search(beside)
    controller = Controller(arm, search.hierarchy)
    log = run(
        cell,
        controller,
        search.duration,
        script=search.script,
        sites=(TIP,),
        watch=search.watch,
    )
    assert not search.sunk
    assert "no hole within 4 mm" in search.report
    assert force_of(log).max() < 40.0
    assert np.abs(log.v / arm.v_max).max() < 0.2
    assert_allclose(log.p[TIP][-1, 2], HOLE[2], atol=2e-4)


def test_a_peg_that_meets_the_hole_at_once_counts_as_having_found_it(arm):
    cell = contact.cell(arm)
    cell.reset(posture_at(arm, HOLE + ABOVE * UP))
    search = Search(HOLE.copy())
    run(
        cell,
        Controller(arm, search.hierarchy),
        search.duration,
        script=search.script,
        watch=search.watch,
    )
    assert search.sunk
    assert_allclose(search.surface, HOLE[2])


def test_a_posture_out_of_reach_is_refused(arm):
    with pytest.raises(InputError, match="does not get to"):
        posture_at(arm, np.array([2.0, 0.0, 0.5]))


def test_the_tip_points_down_where_postures_are_looked_for(arm):
    q = posture_at(arm, HOLE + ABOVE * UP)
    F = arm.state(q).frame(TIP)
    assert_allclose(F.R, DOWN, atol=1e-6)
    assert_allclose(F.p, HOLE + ABOVE * UP, atol=1e-6)
