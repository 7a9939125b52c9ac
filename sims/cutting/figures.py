"""Figures of the cutting report, after P0's figures 5 to 9."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from sims.cutting.loop import Run
from sims.cutting.pictures import snapshots
from sims.cutting.record import EVERY, Record
from sims.report.axes import PALETTE, Span
from sims.report.figures import lines3d, time_series
from sims.report.svg import styled, to_svg
from wbc.arrays import Array

__all__ = ["figures"]

MILLI = 1e3
SAMPLES = 60


def figures(run: Run) -> list[tuple[str, str]]:
    """(caption, svg) pairs: those of the paper first, then the robots."""
    record = run.record
    drawn, shots = [], snapshots(run)
    if shots is not None:
        drawn.append(("The separation, passage after passage (P0, Fig. 6).", shots))
    if record.lines:
        drawn.append(_passages(run))
    drawn += [_trajectories(run), _force(record), _place(record), _opening(record)]
    drawn += [_error(record), _knife(record)]
    for log in run.logs:
        share = np.abs(log.torque) / log.robot.tau_max
        joints = dict(zip(log.robot.joint_names, share.T, strict=True))
        title = f"{log.robot.name}: use of the torque limits"
        svg = time_series(title, log.t, joints, "share of limit [1]")
        drawn.append((f"Joint torques of '{log.robot.name}'.", svg))
    return drawn


def _trajectories(run: Run) -> tuple[str, str]:
    record, depths = run.record, run.job.passages.plan.depths
    x = np.linspace(record.low, record.high, SAMPLES)
    curves = {
        f"passage {k + 1}": np.column_stack([x, line(x), np.full(x.size, depths[k])])
        for k, line in enumerate(record.lines)
    }
    if not curves:
        curves = {f"z = {line[0, 2]} m": line for line in record.initial}
    svg = lines3d("Interpolated cutting trajectories", curves)
    return "Guide lines as fitted at the start of each passage (P0, Fig. 5).", svg


@styled
def _panels(run: Run) -> str:
    count = len(run.record.lines)
    size = (6.4, 3.4) if count < 3 else (12.8, 3.2)
    figure = Figure(figsize=size, layout="constrained")
    for k, axes in enumerate(np.atleast_1d(figure.subplots(1, count, sharex=True))):
        curves = zip(_curves(run, k).items(), PALETTE, strict=False)
        for (name, points), colour in curves:
            y = MILLI * points[:, 1]
            axes.plot(points[:, 0], y, color=colour, label=name, lw=1.3)
        axes.set(title=f"pass {k + 1}", xlabel="x [m]")
        axes.title.set_fontweight("normal")
        axes.grid(visible=True, color="#E3E6E8", linewidth=0.6)
        axes.spines[["top", "right"]].set_visible(False)
        axes.locator_params(axis="x", nbins=4)
        if k == 0:
            axes.set_ylabel("y [mm]")
            style: dict[str, Any] = {"fontsize": 8, "ncols": 4, "frameon": False}
            figure.legend(loc="outside lower center", **style)
    title = f"Knife and guide line, experiment '{run.job.experiment}'"
    figure.suptitle(title, fontsize=10.5, fontweight="bold")
    return to_svg(figure, title)


def _curves(run: Run, k: int) -> dict[str, Array]:
    """P0's four curves of a passage: (n, 2) each, x and y [m]."""
    record = run.record
    x = np.linspace(record.low, record.high, SAMPLES)
    during = record.stroke == k
    coarse = during[::EVERY][: len(record.guide)]
    inside = (
        during & (record.tip[:, 0] >= record.low) & (record.tip[:, 0] <= record.high)
    )
    return {
        "initial guide line": record.initial[k, :, :2],
        "interpolated trajectory": np.column_stack([x, record.lines[k](x)]),
        "guide line during the cut": record.guide[coarse],
        "knife": record.tip[inside][::EVERY, :2],
    }


def _passages(run: Run) -> tuple[str, str]:
    number = "7" if run.job.experiment == "initial" else "8"
    caption = (
        "Guide line before the cut, trajectory interpolated at the start of the "
        f"passage, guide line where the knife is, and the knife (P0, Fig. {number})."
    )
    return caption, _panels(run)


def _spans(record: Record) -> list[Span]:
    spans = []
    for k in range(int(record.stroke.max()) + 1):
        during = record.t[record.stroke == k]
        spans.append((f"pass {k + 1}", float(during[0]), float(during[-1])))
    return spans


def _force(record: Record) -> tuple[str, str]:
    lines = {"measured": record.pull, "wanted": record.due}
    svg = time_series(
        "Pulling force", record.t, lines, "force along y [N]", spans=_spans(record)
    )
    return "Force of the pulling arm on the meat (P0, Fig. 9).", svg


def _place(record: Record) -> tuple[str, str]:
    lines = {"y": MILLI * record.grip[:, 1]}
    svg = time_series(
        "Pulling frame", record.t, lines, "y of the grip [mm]", spans=_spans(record)
    )
    return "The pulling frame gives way as links are cut (P0, Fig. 9).", svg


def _opening(record: Record) -> tuple[str, str]:
    lines = {
        "opening [mm]": MILLI * record.opening,
        "links cut [%]": 100.0 * record.cut,
    }
    svg = time_series(
        "Opening of the valley",
        record.coarse_t,
        lines,
        "opening [mm], links [%]",
        spans=_spans(record),
    )
    return "Mean distance of the two muscles along y, and links cut.", svg


def _error(record: Record) -> tuple[str, str]:
    lines = {"knife less guide line": MILLI * record.guide_error}
    svg = time_series(
        "Guide error",
        record.coarse_t,
        lines,
        "error along y [mm]",
        spans=_spans(record),
    )
    return "Distance of the knife from the guide line at its own x and depth.", svg


def _knife(record: Record) -> tuple[str, str]:
    lines = dict(zip("xyz", record.knife.T, strict=True))
    svg = time_series(
        "Force of the knife on the meat", record.t, lines, "force [N]",
        spans=_spans(record),
    )  # fmt: skip
    return "What the cutting arm's wrist feels, weight and inertia taken out.", svg
