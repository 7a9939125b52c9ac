"""Shape, links and flexes of the meat."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from numpy.testing import assert_allclose

from robots import lwr4
from sims.cutting.meat import Meat, Tissue, Toughness
from sims.cutting.meat.flex import MaterialPoints
from sims.cutting.meat.links import damage
from sims.cutting.meat.sheets import Sheets
from sims.cutting.meat.texture import fibres
from tests.tolerances import ROUND_OFF
from wbc.errors import InputError, UnknownName

FAR = np.array([0.0, 0.0, 1.0])


def scene(meat: Meat) -> tuple[mujoco.MjModel, mujoco.MjData]:
    spec = mujoco.MjSpec()
    spec.option.timestep = 1e-3
    meat.add_to(spec)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step1(model, data)
    return model, data


def test_seeds_differ_in_shape_stiffness_strength_and_fibres():
    a, b = Meat.generate(1), Meat.generate(2)
    assert np.abs(a.sheets.seam - b.sheets.seam).max() > 1e-3
    assert a.young != b.young
    for what in ("stiffness", "onset", "rest"):
        first, second = getattr(a.links, what), getattr(b.links, what)
        assert np.abs(first / second - 1).max() > 0.01


def test_the_same_seed_is_the_same_animal():
    a, b = Meat.generate(3), Meat.generate(3)
    assert_allclose(a.sheets.seam, b.sheets.seam, rtol=0)
    assert_allclose(a.links.stiffness, b.links.stiffness, rtol=0)


@pytest.mark.parametrize("seed", range(20))
def test_every_animal_fits_the_passages_of_the_paper(seed):
    """The first one, at z = 0.35 m, must have something to cut."""
    sheets = Meat.generate(seed).sheets
    assert sheets.table == pytest.approx(0.27)
    assert sheets.seam[:, -1, 2].min() > 0.352


def test_links_cover_the_seam_whatever_their_number():
    coarse, fine = Meat.generate(0), Meat.generate(0, links=(66, 18))
    assert fine.links.count == 4 * coarse.links.count
    for what in ("area", "stiffness", "damping"):
        few, many = getattr(coarse.links, what).sum(), getattr(fine.links, what).sum()
        assert many == pytest.approx(few, rel=1e-3)


def test_muscles_fill_the_space_between_the_sheets():
    meat = Meat.generate(0)
    held, pulled = meat.sheets.muscles()
    between = meat.sheets.pulled[..., 1] - meat.sheets.fixed[..., 1]
    x, z = meat.sheets.seam[:, 0, 0], meat.sheets.seam[..., 2]
    section = np.array([np.trapezoid(b, zi) for b, zi in zip(between, z, strict=True)])
    whole = np.trapezoid(section, x)
    assert held.volume + pulled.volume == pytest.approx(whole, rel=1e-3)


def test_material_points_start_where_they_are_and_move_with_the_nodes():
    meat = Meat.generate(0)
    model, data = scene(meat)
    points = MaterialPoints(model, "pulled", meat.links.ends[1])
    assert_allclose(points.read(data)[0], meat.links.ends[1], atol=ROUND_OFF)
    data.qpos[:] = np.tile([0.01, 0.02, 0.03], model.nq // 3)
    data.qvel[:] = np.tile([1.0, 2.0, 3.0], model.nv // 3)
    x, v = points.read(data)
    assert_allclose(x - meat.links.ends[1], np.tile([0.01, 0.02, 0.03], (297, 1)))
    assert_allclose(v, np.tile([1.0, 2.0, 3.0], (297, 1)))


def test_forces_on_material_points_keep_their_sum_and_their_power():
    meat, rng = Meat.generate(0), np.random.default_rng(0)
    model, data = scene(meat)
    points = MaterialPoints(model, "pulled", meat.links.ends[1])
    data.qvel[:] = rng.normal(size=model.nv)
    forces = rng.normal(size=(297, 3))
    points.push(data, forces)
    applied = data.qfrc_applied.reshape(-1, 3)
    assert_allclose(applied.sum(axis=0), forces.sum(axis=0), atol=1e-10)
    power = (forces * points.read(data)[1]).sum()
    assert data.qfrc_applied @ data.qvel == pytest.approx(power)


def test_links_pull_the_two_muscles_with_opposite_forces():
    meat, rng = Meat.generate(0), np.random.default_rng(1)
    model, data = scene(meat)
    tissue = Tissue(meat, model, data)
    pulled = MaterialPoints(model, "pulled", meat.links.ends[1]).block
    data.qpos[pulled] = 1e-3 * rng.normal(size=pulled.stop - pulled.start)
    tissue.apply(data, FAR, FAR)
    on_pulled = data.qfrc_applied[pulled].reshape(-1, 3).sum(axis=0)
    a1, a2 = tissue.ends()
    expected = (meat.links.stiffness[:, None] * (a2 - a1 - meat.links.rest)).sum(axis=0)
    assert_allclose(on_pulled, -expected, atol=1e-9)


def test_damage_begins_at_the_onset_ends_at_twice_it_and_carries_no_more_than_that():
    stretch = np.array([0.5, 1.0, 1.5, 2.0, 3.0])
    left = np.array([1.0 - damage(s, 1.0) for s in stretch])
    assert_allclose(left * stretch, [0.5, 1.0, 0.5, 0.0, 0.0], atol=ROUND_OFF)


@pytest.mark.parametrize(
    "kind",
    [
        lambda: Meat.generate(-1),
        lambda: Meat.generate(0, links=(1, 9)),
        lambda: Meat.generate(0, links=(33.5, 9)),
        lambda: replace(Meat.generate(0), young=0.0),
        lambda: replace(Meat.generate(0), poisson=0.5),
        lambda: Meat.generate(0, place=(0.5, np.nan)),
        lambda: Toughness(seam=-1.0),
    ],
)
def test_nonsense_is_refused(kind):
    with pytest.raises(InputError):
        kind()


def test_unknown_tool_is_refused_with_the_bodies_that_exist():
    spec, meat = mujoco.MjSpec(), Meat.generate(0)
    spec.worldbody.add_body(name="bracket")
    meat.add_to(spec)
    with pytest.raises(UnknownName, match="Did you mean 'bracket'"):
        meat.attach(spec, "bracke", meat.grip, np.eye(3))
    with pytest.raises(InputError, match="rotation"):
        meat.attach(spec, "bracket", meat.grip, 2.0 * np.eye(3))


def test_attached_points_of_tool_and_meat_coincide_at_the_start():
    spec, meat = mujoco.MjSpec(), Meat.generate(0)
    R = np.diag([-1.0, 1.0, -1.0])
    p = meat.grip + np.array([0.0, 0.0, 0.22])
    tool = spec.worldbody.add_body(name="bracket", pos=p, quat=[0, 0, 1, 0])
    tool.add_geom(size=[0.01] * 3)
    tool.add_freejoint()
    meat.add_to(spec)
    meat.attach(spec, "bracket", p, R)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert model.neq == 9
    assert_allclose(data.efc_pos, 0.0, atol=ROUND_OFF)


def test_keyframes_of_the_scene_go_and_its_time_step_stays():
    spec = mujoco.MjSpec.from_string(lwr4.mjcf())
    Meat.generate(0).add_to(spec)
    model = spec.compile()
    assert model.nkey == 0
    assert model.opt.timestep == pytest.approx(1e-3)
    assert model.opt.integrator == mujoco.mjtIntegrator.mjINT_DISCRETE


def test_a_seam_outside_the_meat_is_refused_with_its_place():
    sheets = Meat.generate(0).sheets
    seam = sheets.seam.copy()
    seam[3, 2, 1] = sheets.pulled[3, 2, 1] + 0.01
    x = f"{seam[3, 2, 0]:.3f}"
    with pytest.raises(InputError, match=rf"leaves the meat on its pulled side.*{x}"):
        Sheets(sheets.fixed, seam, sheets.pulled)


def test_sheets_out_of_order_are_refused():
    sheets = Meat.generate(0).sheets
    with pytest.raises(InputError, match="x must grow"):
        Sheets(sheets.fixed[::-1], sheets.seam[::-1], sheets.pulled[::-1])
    with pytest.raises(InputError, match="other x and z"):
        Sheets(sheets.fixed + 0.01, sheets.seam, sheets.pulled)


def test_muscles_show_fibres_outside_and_pale_skin_at_the_seam():
    image = fibres(0).astype(float)
    assert image.shape == (256, 512, 3)
    assert image[-5:].mean() > 1.5 * image[:200].mean()
    assert image[:200, :, 0].mean() > 2 * image[:200, :, 1].mean()
