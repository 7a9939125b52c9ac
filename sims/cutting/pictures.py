"""Pictures of a cut: snapshots, and the end."""

from __future__ import annotations

import html
from typing import Final

import mujoco
import numpy as np

from sims.cutting.cell import CuttingCell
from sims.cutting.job import Job
from sims.cutting.loop import Run
from sims.cutting.meat import Meat
from sims.cutting.metrics import REST
from sims.report.snapshot import Image, NoDisplay, data_url, render
from sims.view.marks import TARGET, Mark
from sims.view.sketches import chain

__all__ = ["camera", "describe", "guide_line", "picture", "snapshots"]

WIDTH, HEIGHT = 480, 320
POINTS: Final = 40
"""Of a guide line."""


def camera(distance: float = 1.75) -> mujoco.MjvCamera:
    """From the far end of the valley, both arms in view."""
    view = mujoco.MjvCamera()
    view.azimuth, view.elevation, view.distance = 165.0, -28.0, distance
    view.lookat[:] = [0.36, 0.18, 0.42]
    return view


def picture(run: Run) -> Image:
    """The cell half-way through the last but one passage, the valley open."""
    ended = run.job.passages.ended
    t = ended[min(len(ended), 4) - 1] - 1.0 if ended else 0.0
    return _at(run, t, camera(), 1280, 800)


def _at(run: Run, t: float, view: mujoco.MjvCamera, width: int, height: int) -> Image:
    record, model = run.record, run.cell.model
    data = mujoco.MjData(model)
    index = min(int(np.searchsorted(record.coarse_t, t)), len(record.qpos) - 1)
    data.qpos[:] = record.qpos[index]
    mujoco.mj_forward(model, data)
    return render(model, data, view, width, height)


def snapshots(run: Run) -> str | None:
    """The meat before the cut and after every passage, as one `<svg>`.

    None where there is no OpenGL.
    """
    view = camera(0.85)
    view.lookat[:], view.azimuth, view.elevation = [0.47, 0.19, 0.33], 150.0, -42.0
    ended = run.job.passages.ended
    moments = [("before the cut", 0.0)]
    moments += [(f"after passage {k}", t + REST) for k, t in enumerate(ended, 1)]
    try:
        images = [_at(run, t, view, WIDTH, HEIGHT) for _, t in moments]
    except NoDisplay:
        return None
    names = [name for name, _ in moments]
    return _contact_sheet(list(zip(names, map(data_url, images), strict=True)))


def _contact_sheet(shots: list[tuple[str, str]], columns: int = 3) -> str:
    rows = -(-len(shots) // columns)
    parts = []
    for i, (name, data) in enumerate(shots):
        x, y = (i % columns) * WIDTH, (i // columns) * HEIGHT
        parts.append(
            f'<image x="{x}" y="{y}" width="{WIDTH}" height="{HEIGHT}" '
            f'href="{data}"/><text x="{x + 12}" y="{y + 26}" '
            f'font-family="sans-serif" font-size="20" stroke="#fff" stroke-width="4" '
            f'paint-order="stroke">{html.escape(name)}</text>'
        )
    size = f"0 0 {columns * WIDTH} {rows * HEIGHT}"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{size}" role="img" '
        f'aria-label="The separation in snapshots">{"".join(parts)}</svg>'
    )


def guide_line(job: Job, meat: Meat) -> list[Mark]:
    """The line of the present passage; nothing before the first."""
    if not job.passages.lines:
        return []
    ends = meat.links.ends[0][:, 0]
    x = np.linspace(ends.min(), ends.max(), POINTS)
    z = np.full(x.size, job.passages.depth)
    return chain(np.column_stack([x, job.passages.lines[-1](x), z]), TARGET)


def describe(cell: CuttingCell) -> str:
    """What is simulated, in a line."""
    model = cell.model
    return f"{model.nv} degrees of freedom, {cell.tissue.meat.links.count} links"
