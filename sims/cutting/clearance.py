"""How near the two arms came to each other."""

from __future__ import annotations

from typing import Final

import numpy as np

from sims.cutting.layout import CUTTER, GRIP, PULLER, TIP
from sims.cutting.loop import Run
from wbc import State
from wbc.arrays import Array

__all__ = ["arm_clearance", "segment_gap"]

EVERY: Final = 100
"""Ticks between two postures that are looked at."""
CHAINS: Final = {
    CUTTER: ("link2", "link4", "link6", "flange", TIP.removeprefix("cutter_")),
    PULLER: ("link2", "link4", "link6", "flange", GRIP.removeprefix("puller_")),
}
"""Shoulder, elbow, wrist, flange, tool: the corners of each arm's axis."""


def arm_clearance(run: Run) -> float:
    """Least distance between the axes of the two arms over a run [m]."""
    logs = run.logs if len(run.logs) == 2 else run.logs * 2
    states = [State(log.robot, 1e-3) for log in logs]
    least = np.inf
    for tick in range(0, logs[0].t.size, EVERY):
        for state, log in zip(states, logs, strict=True):
            state.refresh(log.q[tick], log.v[tick], 0.0)
        chains = [_chain(s, a) for s, a in zip(states, CHAINS, strict=True)]
        least = min(least, segment_gap(*chains))
    return least


def _chain(state: State, arm: str) -> Array:
    return np.array([state.frame(f"{arm}_{part}").p for part in CHAINS[arm]])


def segment_gap(a: Array, b: Array, samples: int = 15) -> float:
    """Least distance between two chains (k, 3) of segments [m], sampled along them."""
    u = np.linspace(0.0, 1.0, samples)[:, None, None]
    p = (a[:-1] + u * np.diff(a, axis=0)).reshape(-1, 3)
    q = (b[:-1] + u * np.diff(b, axis=0)).reshape(-1, 3)
    return float(np.linalg.norm(p[:, None] - q[None], axis=2).min())
