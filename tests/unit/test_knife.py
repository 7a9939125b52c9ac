"""What the knife feels, and what counts as cutting a muscle."""

from __future__ import annotations

from itertools import pairwise

import mujoco
import numpy as np
import pytest
from numpy.testing import assert_allclose

from sims.cutting.meat import Meat, Tissue, Toughness
from sims.cutting.meat.face import Face
from sims.cutting.meat.knife import Indentation, resistance
from wbc.errors import UnknownName

EDGE = np.array([0.0, 0.0, -1.0])
H = 1e-3
SPEED = 0.2  # [m/s]


def sliding(motion, tearing: float, friction: float = 0.0) -> np.ndarray:
    """Force (3,) on a knife that has gone on steadily."""
    tissue = Indentation()
    for _ in range(1000):
        force = tissue.force(motion, resistance(motion, EDGE, tearing, friction))
    return force


@pytest.mark.parametrize(
    ("xi", "push", "slice_"), [(0.0, 1.0, 0.0), (1.0, 0.5, 0.5), (2.0, 0.2, 0.4)]
)
def test_slicing_lowers_the_force_as_the_energy_balance_says(xi, push, slice_):
    """Along the push J w / (1 + xi^2), along the slice J w xi / (1 + xi^2)."""
    force = sliding(1e-4 * np.array([1.0, 0.0, -xi]), 40.0)
    assert_allclose(force, 40.0 * np.array([-push, 0.0, slice_]), atol=1e-9)


def test_work_against_the_resistance_is_toughness_times_area_at_any_ratio():
    for xi in (0.0, 0.7, 3.0):
        motion = 1e-4 * np.array([1.0, 0.0, -xi])
        assert -sliding(motion, 40.0) @ motion == pytest.approx(40.0 * 1e-4)


def test_friction_acts_against_the_motion():
    force = sliding(1e-4 * np.array([0.6, 0.8, 0.0]), 0.0, friction=5.0)
    assert_allclose(force, [-3.0, -4.0, 0.0], atol=1e-9)


def test_tissue_yields_before_it_is_cut_and_holds_a_knife_that_stands():
    tissue, motion = Indentation(), np.array([1e-3, 0.0, 0.0])
    assert_allclose(tissue.force(motion, 1e4), [-20.0, 0.0, 0.0])
    assert_allclose(tissue.force(0.0 * motion, 1e4), [-20.0, 0.0, 0.0])
    assert_allclose(tissue.force(-motion, 1e4), 0.0, atol=1e-9)
    assert_allclose(tissue.force(motion, 5.0), [-5.0, 0.0, 0.0])
    assert_allclose(tissue.force(motion, 0.0), 0.0)


# --------------------------------------------------------------- a knife on rails


class Rails:
    """Meat and a knife that goes where it is told, whatever it feels."""

    def __init__(self, meat: Meat, knife: str | None = "tip") -> None:
        spec = mujoco.MjSpec()
        spec.option.timestep = H
        meat.add_to(spec)
        body = spec.worldbody.add_body(name="knife", mocap=True, quat=[0, 1, 0, 0])
        body.add_site(name="tip")
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.tissue = Tissue(meat, self.model, self.data, knife=knife)
        self.forces = []

    def sweep(self, start, end) -> np.ndarray:
        """Force on the knife (T, 3) on a straight way; its work in self.work [J]."""
        start, end = np.array(start), np.array(end)
        steps = int(np.linalg.norm(end - start) / (SPEED * H))
        way = start + np.linspace(0, 1, steps + 1)[:, None] * (end - start)
        forces = []
        for before, tip in pairwise(way):
            self.data.mocap_pos[0] = tip
            mujoco.mj_step1(self.model, self.data)
            self.tissue.apply(self.data, before, tip)
            mujoco.mj_step2(self.model, self.data)
            forces.append(self.tissue.knife_force)
        self.work = -float((np.array(forces) * np.diff(way, axis=0)).sum())
        return np.array(forces)


def plain(**toughness) -> Meat:
    """The animal of seed 0 without friction, or as said."""
    return Meat.generate(0, toughness=Toughness(**{"friction": 0.0, **toughness}))


def seam_y(meat: Meat, x: float, z: float) -> float:
    seam = meat.sheets.seam.reshape(-1, 3)
    return float(seam[np.hypot(seam[:, 0] - x, seam[:, 2] - z).argmin(), 1])


def straight(meat: Meat, z: float, y_offset: float = 0.0, half: float = 0.015):
    """A way along x through the middle of the seam, or beside it [m]."""
    x = meat.sheets.seam[:, 0, 0].mean()
    y = seam_y(meat, x, z) + y_offset
    return np.array([x - half, y, z]), np.array([x + half, y, z])


def test_cutting_the_seam_costs_its_toughness_times_the_area():
    meat = plain()
    rails = Rails(meat)
    rails.sweep(*straight(meat, 0.33))
    area = meat.links.area[~rails.tissue.alive].sum()
    assert area > 0
    # up to one pitch of the links at either end is begun or left
    pitch = np.ptp(meat.sheets.seam[..., 0]) / 33
    height = meat.sheets.top - 0.33
    assert rails.work == pytest.approx(300.0 * area, abs=300.0 * pitch * height)


def test_knife_in_the_seam_cuts_no_muscle():
    meat = plain()
    rails = Rails(meat)
    rails.sweep(*straight(meat, 0.33))
    assert rails.tissue.muscle_cut_length == 0.0


@pytest.mark.parametrize("side", [-1, 1])
def test_knife_beside_the_seam_cuts_muscle_and_feels_it(side):
    meat = plain()
    rails = Rails(meat)
    forces = rails.sweep(*straight(meat, 0.33, side * 0.02, half=0.04))
    assert rails.tissue.muscle_cut_length == pytest.approx(0.08, rel=1e-6)
    depth = meat.sheets.top - 0.33  # the knife drags the meat along, then cuts
    assert -forces[-25:, 0].mean() == pytest.approx(1500.0 * depth, rel=0.15)
    assert rails.tissue.links_cut_fraction == 0.0


def test_knife_above_or_outside_the_meat_meets_nothing():
    meat = plain()
    for y_offset, z in ((0.0, 0.40), (0.3, 0.33), (-0.3, 0.33)):
        rails = Rails(meat)
        assert_allclose(rails.sweep(*straight(meat, z, y_offset)), 0.0)
        assert rails.tissue.muscle_cut_length == 0.0


def test_what_the_knife_feels_the_meat_feels_the_other_way_round():
    meat = plain()
    rails = Rails(meat)
    start, end = straight(meat, 0.33)
    rails.sweep(start, end)
    d = rails.data
    on_knife = d.xfrc_applied[rails.model.body("knife").id, :3]
    # the held muscle's fixed nodes take their part without a trace in qfrc_applied
    free = Rails(meat, knife=None)
    free.sweep(start, end)
    assert np.linalg.norm(on_knife) > 1.0
    assert rails.tissue.knife_force @ [1, 0, 0] < -1.0
    difference = d.qfrc_applied - free.data.qfrc_applied
    assert difference.reshape(-1, 3).sum(axis=0)[0] > 0.3


def test_torque_on_the_tool_is_that_of_a_force_in_the_middle_of_the_cut():
    meat = plain()
    rails = Rails(meat)
    start, end = straight(meat, 0.33)
    forces = rails.sweep(start, end)
    body = rails.model.body("knife").id
    force, torque = np.split(rails.data.xfrc_applied[body], 2)
    assert_allclose(force, forces[-1])
    arm = torque[1] / force[0]
    assert 0.0 < arm < meat.sheets.top - 0.33


def test_tissue_without_a_knife_in_the_scene_cuts_for_free():
    meat = plain()
    rails = Rails(meat, knife=None)
    rails.sweep(*straight(meat, 0.33))
    assert rails.tissue.links_cut_fraction > 0.0
    assert_allclose(rails.data.xfrc_applied, 0.0)


def driven(meat: Meat, force: float, seconds: float) -> tuple[Tissue, float, float]:
    """Tissue, way and largest speed of a knife of 5 kg on a slide under a force."""
    spec = mujoco.MjSpec()
    spec.option.timestep = H
    meat.add_to(spec)
    start, _ = straight(meat, 0.31)
    start[0] = meat.sheets.seam[0, 0, 0] - 0.002
    start[1] = seam_y(meat, start[0], 0.31)
    knife = spec.worldbody.add_body(name="knife", pos=start, quat=[0, 1, 0, 0])
    knife.mass, knife.inertia, knife.explicitinertial = 5.0, [0.01] * 3, True
    knife.add_site(name="tip")
    knife.add_joint(
        name="x", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0], damping=[100, 0, 0]
    )
    model = spec.compile()
    data = mujoco.MjData(model)
    tissue = Tissue(meat, model, data, knife="tip")
    dof, fastest, tip = model.joint("x").dofadr[0], 0.0, start
    for _ in range(round(seconds / H)):
        mujoco.mj_step1(model, data)
        before, tip = tip, data.site("tip").xpos.copy()
        tissue.apply(data, before, tip)
        data.qfrc_applied[dof] = force
        mujoco.mj_step2(model, data)
        fastest = max(fastest, abs(float(data.qvel[dof])))
    return tissue, float(tip[0] - start[0]), fastest


def test_a_knife_that_cannot_cut_drags_the_meat_along_and_nothing_flies_apart():
    tissue, way, fastest = driven(plain(seam=1e5, muscle=1e5), 60.0, 1.0)
    assert tissue.knife_force[0] == pytest.approx(-60.0, rel=0.05)  # at rest
    assert way < 0.1
    assert fastest < 0.5
    _, sharp, _ = driven(plain(seam=100.0, muscle=100.0), 60.0, 1.0)
    assert sharp > 0.2


def test_unknown_knife_is_refused_with_the_sites_that_exist():
    with pytest.raises(UnknownName, match="tip"):
        Rails(plain(), knife="tipp")


def test_face_of_a_tilted_plane_is_found_between_its_points():
    u, w = np.meshgrid(np.arange(6), np.arange(4), indexing="ij")
    x, z = 0.01 * u + 0.001 * w, 0.01 * w
    points = np.stack([x, 0.3 * x - 0.2 * z, z], axis=-1).reshape(-1, 3)
    face = Face((6, 4), np.full(24, 0.1), 1)
    tip = np.array([0.0234, 0.0, 0.0171])
    tip[1] = 0.3 * tip[0] - 0.2 * tip[2] + 0.004
    wound = face.wound(points, tip)
    assert wound is not None
    assert wound.inside == pytest.approx(0.004)
    assert wound.depth == pytest.approx(0.035 - 0.0171)
    tip[1] -= 0.005
    assert face.wound(points, tip) is None
    assert face.wound(points, tip + np.array([0.0, 0.2, 0.0])) is None
