"""Muscles and links in series against the strength of materials."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from sims.cutting.meat import Meat, Tissue
from sims.cutting.meat.animal import Animal, Field
from sims.cutting.meat.links import Links
from sims.cutting.meat.sheets import Sheets

LENGTH, HEIGHT, WIDTH = 0.28, 0.09, 0.10  # of each muscle [m]
AREA = LENGTH * HEIGHT
YOUNG, LINK_STIFFNESS = 4e4, 8e5  # [Pa], [N/m^3]
FORCE = 20.0  # [N]
FAR = np.array([0.0, 0.0, 1.0])
LINEAR = 0.02  # strains of 2 %, and what has not yet come to rest


def block(poisson: float) -> Meat:
    """Two blocks side by side, the same links everywhere."""
    x, z = np.meshgrid(
        np.linspace(0.4, 0.4 + LENGTH, 9),
        0.27 + np.linspace(0, HEIGHT, 5),
        indexing="ij",
    )
    fixed, seam, pulled = (np.stack([x, y + 0 * x, z], -1) for y in (0.0, 0.1, 0.2))
    sheets = Sheets(fixed, seam, pulled)
    flat = Field(np.zeros((3, 3)), np.zeros((3, 3)))
    animal = replace(Animal.draw(0), link_stiffness=LINK_STIFFNESS, patches=(flat,) * 4)
    return Meat(sheets, Links.across(sheets, animal, (20, 8)), YOUNG, poisson)


def settled(meat: Meat, axis: int) -> tuple[mujoco.MjModel, mujoco.MjData, Tissue]:
    """After an even load on the outer face, in the direction of an axis."""
    spec = mujoco.MjSpec()
    spec.option.timestep = 2e-3
    meat.add_to(spec)
    model = spec.compile()
    data = mujoco.MjData(model)
    tissue = Tissue(meat, model, data)
    for ix in range(5):
        for iz in range(3):
            share = (0.5 if ix in (0, 4) else 1) / 4 * (0.5 if iz in (0, 2) else 1) / 2
            node = model.body(f"meat_pulled_{ix}_2_{iz}").id
            data.xfrc_applied[node, axis] = FORCE * share
    for _ in range(1000):
        mujoco.mj_step1(model, data)
        tissue.apply(data, FAR, FAR)
        mujoco.mj_step2(model, data)
    return model, data, tissue


def moved(model: mujoco.MjModel, data: mujoco.MjData, axis: int) -> float:
    """How far the middle of the outer face has gone [m]."""
    node = model.body("meat_pulled_2_2_1")
    return float(data.qpos[model.jnt_qposadr[node.jntadr[0]] + axis])


def test_a_pull_stretches_muscle_and_links_in_series():
    model, data, tissue = settled(block(poisson=0.0), axis=1)
    links = FORCE / (LINK_STIFFNESS * AREA)
    muscles = 2 * FORCE * WIDTH / (YOUNG * AREA)
    assert tissue.opening() == pytest.approx(links, rel=LINEAR)
    assert moved(model, data, 1) == pytest.approx(links + muscles, rel=LINEAR)


def test_a_shear_load_bends_and_shears_the_muscles():
    """A cantilever of two muscles with a hinge-free elastic joint: Timoshenko's beam.

    G = E / 2 without Poisson's ratio, shear coefficient 5/6; the links give way by
    sliding, F / K, and by turning, M / (k I), which lifts the tip by its lever.
    """
    model, data, _ = settled(block(poisson=0.0), axis=0)
    span, inertia = 2 * WIDTH, HEIGHT * LENGTH**3 / 12
    bending = FORCE * span**3 / (3 * YOUNG * inertia)
    shear = FORCE * span / (5 / 6 * YOUNG / 2 * AREA)
    sliding = FORCE / (LINK_STIFFNESS * AREA)
    turning = FORCE * WIDTH**2 / (LINK_STIFFNESS * inertia)
    expected = bending + shear + sliding + turning
    assert moved(model, data, 0) == pytest.approx(expected, rel=0.1)
