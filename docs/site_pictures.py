"""A picture of every task, from the task's own rows: ``python site_pictures.py DIR``.

The tool is a pose in space. What the task wants is found by Newton's method on the
task's error and Jacobian, each step the smallest motion of the tool: the orange, dashed
tool is where the error is zero, and whatever it keeps of the old pose is free.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import site_guards
import site_plots
import site_scenes
from site_drawing import INK, ORANGE, Drawing

from robots import racer
from wbc import Task, allocate_rows

__all__ = ["names", "of"]

TOOL = 0.13
"""Length of the tool in the pictures [m]."""
ARM_LENGTH = 0.15
"""A turn by 1 rad counts as much as this shift [m]."""
ROBOT = racer.load()
PLOTS = {**site_plots.PLOTS, **site_guards.PLOTS}
POSTURE = np.radians([0.0, -4.0, -112.0, 0.0, 72.0, 180.0])


def names() -> list[str]:
    """Names of all tasks that have one."""
    return [*site_scenes.SCENES, *PLOTS]


def of(name: str) -> tuple[str, str]:
    """A task's picture, and a caption in HTML.

    Raises:
        KeyError: there is none.
    """
    if name in PLOTS:
        return PLOTS[name](ROBOT)
    state = ROBOT.state(POSTURE)
    F = state.frame("torch_tip")
    tasks, draw = site_scenes.SCENES[name](F.p, F.R)
    drawing = Drawing(F.p - [0.0, 0.0, 0.03])
    draw(drawing)
    _tool(drawing, F.p, F.R, INK)
    goal = _settle(tasks)
    drawing.arrow(F.p, goal.p)
    _tool(drawing, goal.p, goal.R, ORANGE, "4 3")
    drawing.dot(F.p)
    return drawing.svg(name), _caption(tasks)


def _tool(drawing: Drawing, p, R, colour: str, dash: str = "") -> None:
    end = p - TOOL * R[:, 2]
    drawing.line([p, end], colour, 2.5 if dash else 5.0, dash)
    side = end + 0.03 * R[:, 0]
    drawing.line([end, side], colour, 2.0, dash)


def _rows(tasks: list[Task], state) -> tuple[np.ndarray, np.ndarray]:
    """Errors (m,) and Jacobian (m, 6) over the tool's twist in the world."""
    errors, rows = [], []
    for task in tasks:
        task.check(state.robot)
        out = allocate_rows(len(task.row_names(state.robot)), state.robot.nv)
        task.update(state, out)
        errors.append(out.error.copy())
        rows.append(out.A @ np.linalg.inv(state.frame("torch_tip").J))
    return np.concatenate(errors), np.vstack(rows)


def _settle(tasks: list[Task]):
    """The tool where the task holds, by the smallest steps."""
    q = POSTURE.copy()
    scale = np.array([1.0] * 3 + [1.0 / ARM_LENGTH] * 3)
    for _ in range(45):
        state = ROBOT.state(q)
        error, A = _rows(tasks, state)
        step = -scale * (np.linalg.pinv(A * scale, rcond=1e-9) @ error)
        step *= min(1.0, 0.05 / max(float(np.abs(step[3:]).max()), 1e-12))
        q = q + np.linalg.solve(state.frame("torch_tip").J, step)
    return ROBOT.state(q).frame("torch_tip")


def _caption(tasks: list[Task]) -> str:
    state = ROBOT.state(POSTURE)
    rows, units = [], []
    for task in tasks:
        names = task.row_names(ROBOT)
        rows += names
        units += task.row_units(len(names))
    _, A = _rows(tasks, state)
    sigma = np.linalg.svd(A, compute_uv=False)
    rank = int((sigma > 1e-9 * sigma[0]).sum())
    listed = ", ".join(f"{r} [{u}]" for r, u in zip(rows, units, strict=True))
    kept = f"holds {rank} of the 6 freedoms of the tool, leaves {6 - rank}"
    return f"Rows: {listed}. It {kept}."


def main(folder: str) -> None:
    """Write every picture into a folder."""
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    for name in names():
        drawing, _ = of(name)
        standing = drawing.replace(INK, "#222222")
        (out / f"{name}.svg").write_text(standing, encoding="utf-8")
    print(f"wrote {len(names())} pictures to {out}")


if __name__ == "__main__":
    main(sys.argv[1])
