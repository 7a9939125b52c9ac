"""`python -m benchmarks.meat`: what a step of the meat costs, without arms."""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Sequence

from benchmarks.machine import SINGLE_THREAD, describe

STEP = 1e-3
CASES = (((33, 9), "discrete"), ((33, 9), "Euler"), ((66, 18), "discrete"))


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.meat")
    parser.add_argument("--steps", type=int, default=2000, help="timed steps a case")
    steps = parser.parse_args(arguments).steps
    print(describe({}))
    print(f"medians over {steps} steps of {STEP * 1e3:g} ms, knife in the seam")
    print(
        f"{'links':>6} {'integrator':>10} {'engine us':>10} {'links us':>9} {'RT':>6}"
    )
    for grid, integrator in CASES:
        engine, tissue = measure(grid, integrator, steps)
        ratio = STEP / (engine + tissue)
        print(
            f"{grid[0] * grid[1]:>6} {integrator:>10} {engine * 1e6:>10.0f} "
            f"{tissue * 1e6:>9.0f} {ratio:>6.2f}",
            flush=True,
        )
    return 0


def measure(grid: tuple[int, int], integrator: str, steps: int) -> tuple[float, float]:
    """Median seconds of a step in the engine, and in the links, rule and knife."""
    import mujoco
    import numpy as np

    from sims.cutting.meat import Meat, Tissue

    meat = Meat.generate(0, links=grid)
    spec = mujoco.MjSpec()
    spec.option.timestep = STEP
    meat.add_to(spec)
    spec.option.integrator = {
        "discrete": mujoco.mjtIntegrator.mjINT_DISCRETE,
        "Euler": mujoco.mjtIntegrator.mjINT_EULER,
    }[integrator]
    knife = spec.worldbody.add_body(name="knife", mocap=True, quat=[0, 1, 0, 0])
    knife.add_site(name="tip")
    model = spec.compile()
    data = mujoco.MjData(model)
    tissue = Tissue(meat, model, data, knife="tip")
    middle = meat.sheets.on_seam(np.array([0.5]), np.array([0.8]))[0]
    ways = middle + 1e-6 * np.arange(steps + 1)[:, None] * [1.0, 0.0, 0.0]
    spent = np.zeros((steps, 4))
    for k in range(steps):
        data.mocap_pos[0] = ways[k + 1]
        spent[k, 0] = time.perf_counter()
        mujoco.mj_step1(model, data)
        spent[k, 1] = time.perf_counter()
        tissue.apply(data, ways[k], ways[k + 1])
        spent[k, 2] = time.perf_counter()
        mujoco.mj_step2(model, data)
        spent[k, 3] = time.perf_counter()
    first, links, second = np.median(np.diff(spent, axis=1), axis=0)
    return float(first + second), float(links)


if __name__ == "__main__":
    os.environ.update(SINGLE_THREAD)  # before numpy is imported
    sys.exit(main())
