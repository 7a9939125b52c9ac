"""The meat pulled and cut without any arm: opening, release, passages, convergence."""

from __future__ import annotations

from functools import cache

import mujoco
import numpy as np
import pytest
from numpy.testing import assert_allclose

from sims.cutting.meat import Meat, Tissue

PULL = 100.0  # [N]
DEPTHS = (0.35, 0.33, 0.31, 0.29, 0.27)  # of P0 Table II [m]
STROKE, PAUSE = 0.5, 0.2  # [s]
FAR = np.array([0.0, 0.0, 1.0])
CONVERGED = 0.05


class Bench:
    """Meat with a plate on a slide for a pulling arm, and a knife on rails."""

    def __init__(self, meat: Meat, h: float = 1e-3, euler: bool = False) -> None:
        spec = mujoco.MjSpec()
        spec.option.timestep = h
        meat.add_to(spec)
        self.add_plate(spec, meat)
        knife = spec.worldbody.add_body(name="knife", mocap=True, quat=[0, 1, 0, 0])
        knife.add_site(name="tip")
        if euler:
            spec.option.integrator = mujoco.mjtIntegrator.mjINT_EULER
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.tissue = Tissue(meat, self.model, self.data, knife="tip")
        self.plate = self.model.body("plate").id
        self.tip = FAR

    def add_plate(self, spec: mujoco.MjSpec, meat: Meat) -> None:
        plate = spec.worldbody.add_body(name="plate", pos=meat.grip, gravcomp=1)
        plate.mass, plate.inertia, plate.explicitinertial = 5.0, [0.01] * 3, True
        plate.add_joint(
            type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0, 1, 0], damping=[200, 0, 0]
        )
        meat.attach(spec, "plate", meat.grip, np.eye(3))

    def pull(self, force: float) -> None:
        self.data.xfrc_applied[self.plate, 1] = force

    def step(self, tip=FAR, before=None) -> float:
        """One step; the work of the knife in it [J]."""
        before = self.tip if before is None else before
        self.data.mocap_pos[0] = tip
        mujoco.mj_step1(self.model, self.data)
        self.tissue.apply(self.data, before, tip)
        mujoco.mj_step2(self.model, self.data)
        self.tip = tip
        return float(-self.tissue.knife_force @ (tip - before))

    def wait(self, seconds: float) -> None:
        self.tip = FAR
        for _ in range(round(seconds / self.model.opt.timestep)):
            self.step()

    def passage(self, z: float) -> float:
        """Cut along the live seam at height z; the work of the knife [J]."""
        seam = self.tissue.meat.sheets.seam
        steps = round(STROKE / self.model.opt.timestep)
        xs = np.linspace(seam[0, 0, 0] - 0.012, seam[-1, 0, 0] + 0.012, steps)
        y = self.seam_y(xs[0], z)
        self.tip = np.array([xs[0], y, z])
        work = 0.0
        look = max(1, round(2e-3 / self.model.opt.timestep))
        for i, x in enumerate(xs):
            if i % look == 0:
                rise = (self.seam_y(x, z) - y) / look
            y += rise
            work += self.step(np.array([x, y, z]))
            if self.tissue.separated:
                break
        return work

    def seam_y(self, x: float, z: float) -> float:
        """The seam between the points that surround (x, z), by a local parabola."""
        p, _ = self.tissue.interface_points()
        dx, dz = p[:, 0] - x, p[:, 2] - z
        weight = np.exp(-((dx / 0.012) ** 2) - (dz / 0.012) ** 2) + 1e-9
        A = np.stack([np.ones(dx.size), dx, dz, dx**2], axis=1) * weight[:, None]
        return float(np.linalg.lstsq(A, p[:, 1] * weight, rcond=None)[0][0])


@cache
def five_passages(h: float = 1e-3, links: tuple[int, int] = (33, 9)):
    """The bench after all passages, openings after four [m], works of all five [J]."""
    bench = Bench(Meat.generate(0, links=links), h)
    bench.pull(PULL)
    bench.wait(0.5)
    openings, works = [bench.tissue.opening()], []
    for z in DEPTHS:
        works.append(bench.passage(z))
        if not bench.tissue.separated:
            bench.wait(PAUSE)
            openings.append(bench.tissue.opening())
    return bench, np.array(openings), np.array(works)


@pytest.mark.parametrize("euler", [False, True])
def test_intact_seam_opens_by_the_pull_over_its_stiffness(euler):
    meat = Meat.generate(0)
    bench = Bench(meat, euler=euler)
    bench.pull(PULL)
    bench.wait(0.5)
    expected = PULL / meat.links.stiffness.sum()
    assert bench.tissue.opening() == pytest.approx(expected, rel=0.02)
    assert bench.tissue.links_cut_fraction == 0.0


def test_attachment_carries_the_pull_and_the_links_all_of_it():
    meat = Meat.generate(1)
    bench = Bench(meat)
    bench.pull(PULL)
    bench.wait(0.8)
    held = bench.data.efc_force[:27].reshape(9, 3).sum(axis=0)
    a1, a2 = bench.tissue.ends()
    links = meat.links.stiffness @ (a2 - a1 - meat.links.rest)[:, 1]
    assert_allclose([abs(held[1]), links], PULL, rtol=0.01)


def test_links_cut_under_load_set_free_no_more_energy_than_they_held():
    bench = Bench(Meat.generate(0))
    bench.pull(PULL)
    bench.wait(0.5)
    work = 0.5 * PULL * bench.data.body("plate").xpos[1]
    work -= 0.5 * PULL * bench.tissue.meat.grip[1]
    bench.pull(0.0)
    middle = bench.tissue.interface_points()[0].mean(axis=0)
    for y in middle[1] + np.arange(-0.04, 0.04, 0.004):
        # a knife through the whole length in one step
        bench.step(np.array([1.0, y, 0.0]), np.array([0.0, y, 0.0]))
    assert bench.tissue.separated
    bench.data.xfrc_applied[:] = 0.0
    for _ in range(10):
        bench.wait(0.03)
        mujoco.mj_energyVel(bench.model, bench.data)
        assert bench.data.energy[1] < 1.05 * work


def test_five_passages_open_the_meat_more_and_more_and_separate_it():
    bench, openings, _ = five_passages()
    assert openings.size == 5  # before the first, after each of four
    assert (np.diff(openings) > 0.0).all()
    assert bench.tissue.separated
    assert bench.tissue.links_cut_fraction == 1.0
    assert bench.tissue.links_torn_fraction < 0.05
    assert bench.tissue.muscle_cut_length == 0.0


@pytest.mark.parametrize("finer", [{"h": 5e-4}, {"links": (66, 9)}])
def test_half_the_step_or_twice_the_links_change_openings_and_forces_little(finer):
    _, openings, works = five_passages()
    _, finer_openings, finer_works = five_passages(**finer)
    assert_allclose(finer_openings, openings, rtol=CONVERGED)
    assert works.sum() == pytest.approx(finer_works.sum(), rel=CONVERGED)
