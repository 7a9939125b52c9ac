"""Pictures of a cut: snapshots, the end, and the replay."""

from __future__ import annotations

import base64
import html
import io
from typing import Final

import mujoco
import numpy as np

from sims.cutting.cell import CuttingCell
from sims.cutting.job import Job
from sims.cutting.loop import Run
from sims.cutting.meat import Meat
from sims.cutting.metrics import REST
from sims.report.axes import PALETTE
from sims.report.replay import Replay, Trace
from sims.report.snapshot import Image, NoDisplay, render
from sims.view.marks import TARGET, Mark
from sims.view.sketches import chain

__all__ = ["camera", "describe", "guide_line", "picture", "replay", "snapshots"]

WIDTH, HEIGHT = 480, 320
REPLAY_RATE: Final = 15.0
"""Frames a second: every one stores all vertices of the meat."""
THIN: Final = 20
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
        shots = [(name, _jpeg(_at(run, t, view, WIDTH, HEIGHT))) for name, t in moments]
    except NoDisplay:
        return None
    return _contact_sheet(shots)


def _jpeg(image: Image) -> str:
    import PIL.Image

    buffer = io.BytesIO()
    PIL.Image.fromarray(image).save(buffer, format="JPEG", quality=85)
    return base64.b64encode(buffer.getvalue()).decode("ascii")


def _contact_sheet(shots: list[tuple[str, str]], columns: int = 2) -> str:
    rows = -(-len(shots) // columns)
    parts = []
    for i, (name, data) in enumerate(shots):
        x, y = (i % columns) * WIDTH, (i // columns) * HEIGHT
        parts.append(
            f'<image x="{x}" y="{y}" width="{WIDTH}" height="{HEIGHT}" '
            f'href="data:image/jpeg;base64,{data}"/><text x="{x + 12}" y="{y + 26}" '
            f'font-family="sans-serif" font-size="20">{html.escape(name)}</text>'
        )
    size = f"0 0 {columns * WIDTH} {rows * HEIGHT}"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{size}" role="img" '
        f'aria-label="The separation in snapshots">{"".join(parts)}</svg>'
    )


def replay(run: Run) -> str:
    """The whole cut in three dimensions, with the way of the knife's tip."""
    record = run.record
    traces = []
    for index, line in enumerate(record.lines):
        x = np.linspace(record.low, record.high, 40)
        z = np.full(x.size, run.job.passages.plan.depths[index])
        planned = np.column_stack([x, line(x), z])
        traces.append(
            Trace(f"passage {index + 1}", planned, PALETTE[index % 7], 0.0015)
        )
    way = record.tip[::THIN]
    traces.append(Trace("knife", way, "#000000", 0.0015, record.t[::THIN]))
    return Replay(
        run.cell.model,
        record.coarse_t,
        record.qpos,
        traces=traces,
        camera=camera(),
        rate=REPLAY_RATE,
    ).html()


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
