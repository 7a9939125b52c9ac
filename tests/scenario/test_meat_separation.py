"""The meat pulled and cut without any arm: opening, release, integrators."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from sims.cutting.meat import Meat, Tissue

PULL = 100.0  # [N]
FAR = np.array([0.0, 0.0, 1.0])


class Bench:
    """Meat with a constant force on the nodes that the arm would hold."""

    def __init__(self, meat: Meat, h: float = 1e-3, euler: bool = False) -> None:
        spec = mujoco.MjSpec()
        spec.option.timestep = h
        meat.add_to(spec)
        if euler:
            spec.option.integrator = mujoco.mjtIntegrator.mjINT_EULER
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.tissue = Tissue(meat, self.model, self.data)
        self.nodes = [
            self.model.body(f"meat_pulled_{i}_2_{k}").id
            for i in (1, 2, 3)
            for k in range(3)
        ]
        joints = self.model.body_jntadr[self.nodes] + 1
        self.grip = self.model.jnt_qposadr[joints]

    def pull(self, force: float) -> None:
        self.data.xfrc_applied[self.nodes, 1] = force / len(self.nodes)

    def step(self, before=FAR, tip=FAR) -> None:
        mujoco.mj_step1(self.model, self.data)
        self.tissue.apply(self.data, before, tip)
        mujoco.mj_step2(self.model, self.data)

    def wait(self, seconds: float) -> None:
        for _ in range(round(seconds / self.model.opt.timestep)):
            self.step()


@pytest.mark.parametrize("euler", [False, True])
def test_intact_seam_opens_by_the_pull_over_its_stiffness(euler):
    meat = Meat.generate(0)
    bench = Bench(meat, euler=euler)
    bench.pull(PULL)
    bench.wait(0.5)
    expected = PULL / meat.links.stiffness.sum()
    assert bench.tissue.opening() == pytest.approx(expected, rel=0.02)
    assert bench.tissue.links_cut_fraction == 0.0


def test_links_cut_under_load_set_free_no_more_energy_than_they_held():
    bench = Bench(Meat.generate(0))
    bench.pull(PULL)
    bench.wait(0.3)
    work = 0.5 * PULL * bench.data.qpos[bench.grip].mean()
    bench.pull(0.0)
    middle = bench.tissue.interface_points()[0].mean(axis=0)
    for y in middle[1] + np.arange(-0.04, 0.04, 0.004):
        # a knife through the whole length in one step
        bench.step(np.array([0.0, y, 0.0]), np.array([1.0, y, 0.0]))
    assert bench.tissue.separated
    for _ in range(10):
        bench.wait(0.03)
        mujoco.mj_energyVel(bench.model, bench.data)
        assert bench.data.energy[1] < 1.05 * work
