from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import matplotlib.image
import mujoco
import numpy as np
import pytest

from sims.metrics import Metric
from sims.report.figures import time_series
from sims.report.page import write_report
from sims.report.replay import Replay, Trace

NAMES = ("chromium", "chromium-browser", "google-chrome")
BROWSER = next((path for path in map(shutil.which, NAMES) if path), None)
pytestmark = pytest.mark.skipif(
    BROWSER is None, reason=f"no browser on PATH: none of {', '.join(NAMES)}"
)

ARM = """
<mujoco>
  <worldbody>
    <geom type="plane" size="0 0 0.1"/>
    <body name="upper" pos="0 0 0.3">
      <joint axis="0 0 1"/>
      <geom type="capsule" size="0.05" fromto="0 0 0 0.4 0 0" rgba="0.9 0.4 0.1 1"/>
      <body name="lower" pos="0.4 0 0">
        <joint axis="0 1 0"/>
        <geom type="box" size="0.15 0.04 0.04" pos="0.15 0 0"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
WIDTH, HEIGHT = 900, 600
FLAGS = [
    "--headless=new",
    "--no-sandbox",
    "--disable-dev-shm-usage",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--enable-logging=stderr",
    "--hide-scrollbars",
    f"--window-size={WIDTH},{HEIGHT}",
]
HARMLESS = ("GL Driver Message",)  # remarks of the software renderer on its speed


def browse(page: Path, *options: str) -> tuple[str, list[str]]:
    """Output of the browser, and what the page wrote to its console."""
    profile = page.parent / "profile"
    command = [BROWSER, *FLAGS, f"--user-data-dir={profile}", *options, page.as_uri()]
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=120, check=True
    )
    lines = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
    return done.stdout, [x for x in lines if not any(h in x for h in HARMLESS)]


def picture(page: Path, budget_ms: int) -> tuple[np.ndarray, list[str]]:
    """Screenshot (H, W, 3) after so much virtual time, and the console's lines."""
    target = page.with_suffix(f".{budget_ms}.png")
    _, console = browse(
        page, f"--virtual-time-budget={budget_ms}", f"--screenshot={target}"
    )
    return matplotlib.image.imread(target)[..., :3], console


def differing(a: np.ndarray, b: np.ndarray) -> int:
    return int((np.abs(a - b).max(axis=2) > 0.1).sum())


@pytest.fixture(scope="module")
def replay() -> Replay:
    times = np.arange(600) / 100.0
    qpos = np.column_stack([0.5 * times, 0.6 * np.sin(times)])
    line = np.column_stack([0.1 * times, 0.0 * times, 0.6 + 0.0 * times])
    model = mujoco.MjModel.from_xml_string(ARM)
    return Replay(model, times, qpos, traces=[Trace("line", line)])


def test_the_robot_of_a_report_moves_and_its_console_is_silent(replay, tmp_path):
    page = tmp_path / "report.html"
    figure = time_series("Error", [0.0, 1.0], {"e": [0.0, 1.0]}, "error [mm]")
    write_report(
        page,
        title="Arm",
        summary="An arm swings.",
        metrics=[Metric("ticks", 600.0), Metric("error_m", 0.1, 0.2)],
        figures=[("Error over time.", figure)],
        replay_html=replay.html(),
        facts={"resolver": "hqp"},
    )
    shots = [picture(page, budget) for budget in (600, 2200, 3800)]
    assert [console for _, console in shots] == [[], [], []]
    first, second, third = (image[160:480] for image, _ in shots)  # without the bar
    assert min(differing(first, second), differing(second, third)) > 1000
    orange = (first[..., 0] > 0.6) & (first[..., 2] < 0.3)
    assert orange.sum() > 500  # the arm is in the picture, not the sky alone


def test_the_time_slider_shows_the_moment_that_it_is_set_to(replay, tmp_path):
    shown, clocks = [], []
    for moment in (0.5, 2.5):
        page = tmp_path / f"replay{len(shown)}.html"
        script = (
            "<script>{const slider = document.getElementById('time');"
            f"slider.value = {moment}; slider.dispatchEvent(new Event('input'));}}"
            "</script></body>"
        )
        page.write_text(replay.html().replace("</body>", script), encoding="utf-8")
        image, console = picture(page, 1500)
        assert console == []
        shown.append(image[: HEIGHT - 60])
        document, _ = browse(page, "--virtual-time-budget=1500", "--dump-dom")
        clocks.append(re.search(r'<output id="clock">([^<]*)<', document)[1])
    assert clocks == ["0.50 / 5.99 s", "2.50 / 5.99 s"]
    assert differing(shown[0], shown[1]) > 1000
