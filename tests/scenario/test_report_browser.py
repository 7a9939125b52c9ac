"""Reports in a headless browser: nothing complains, and the replay moves."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import matplotlib.image
import mujoco
import numpy as np
import pytest

from sims.cli import main
from sims.metrics import Metric
from sims.registry import cell_names
from sims.report.figures import time_series
from sims.report.page import write_report
from sims.report.replay import Replay, Trace
from tests.browser import BROWSER, FLAGS, HARMLESS, MISSING, Browser

pytestmark = pytest.mark.skipif(BROWSER is None, reason=MISSING)

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
VISIBLE = ["--enable-logging=stderr", f"--window-size={WIDTH},{HEIGHT}"]
SHORT = {"cutting": 3.0, "welding": 1.5, "contact": 1.0}
"""Longest time of each job [s], enough for something to move; 0.5 s elsewhere."""
MOMENTS = (0.02, 0.5, 1.0)
SMALL = (320, 180)
LOOK = """
new Promise((done) => {
  function begin() {
    const inside = document.querySelector("iframe").contentWindow;
    const canvas = inside.document.querySelector("#pane canvas");
    const slider = inside.document.getElementById("time");
    const small = document.createElement("canvas");
    [small.width, small.height] = SMALL;
    const pen = small.getContext("2d", { willReadFrequently: true });
    const moments = MOMENTS, pictures = [];
    function look() {
      slider.value = moments[pictures.length] * slider.max;
      slider.dispatchEvent(new Event("input"));
      inside.requestAnimationFrame(() => { // after the viewer's own, in the same frame
        pen.drawImage(canvas, 0, 0, small.width, small.height);
        const { data } = pen.getImageData(0, 0, small.width, small.height);
        pictures.push(Array.from(data));
        if (pictures.length < moments.length) look(); else done(pictures);
      });
    }
    look();
  }
  if (document.readyState === "complete" && location.href !== "about:blank") begin();
  else window.addEventListener("load", begin);
})"""


def browse(page: Path, *options: str) -> tuple[str, list[str]]:
    """Output of the browser, and what the page wrote to its console."""
    profile = page.parent / "profile"
    command = [
        BROWSER,
        *FLAGS,
        *VISIBLE,
        f"--user-data-dir={profile}",
        *options,
        page.as_uri(),
    ]
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


@pytest.fixture(scope="session", params=cell_names())
def report(tmp_path_factory, request) -> Path:
    """The report of a short run of a cell."""
    cell, folder = request.param, tmp_path_factory.mktemp("report")
    short = ["--duration", str(SHORT.get(cell, 0.5)), "--quiet"]
    assert main(["run", cell, *short, "--out", str(folder)]) in (0, 1)
    return folder / "report.html"


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    """One browser for all reports."""
    opened = Browser(tmp_path_factory.mktemp("browser") / "profile", WIDTH, HEIGHT)
    yield opened
    opened.close()


def test_every_cells_report_opens_silently_and_its_replay_shows_three_moments(
    report, browser
):
    values = {"SMALL": list(SMALL), "MOMENTS": list(MOMENTS)}
    look = re.sub("SMALL|MOMENTS", lambda name: str(values[name[0]]), LOOK)
    pictures, complaints = browser.run(report, look)
    assert complaints == []
    assert report.stat().st_size < 8_000_000
    pixels = np.array(pictures, dtype=float) / 255.0
    first, second, third = pixels.reshape(3, *SMALL[::-1], 4)[..., :3]
    assert min(map(np.std, (first, second, third))) > 0.1  # a scene, not the sky alone
    assert min(differing(first, second), differing(second, third)) > 20


def test_a_script_that_fails_in_a_frame_of_a_page_is_heard(browser, tmp_path):
    page = tmp_path / "bad.html"
    page.write_text('<iframe srcdoc="<script>nothing.here</script>"></iframe>')
    wait = "new Promise((done) => setTimeout(done, 300))"
    _, complaints = browser.run(page, wait)
    assert any("nothing is not defined" in complaint for complaint in complaints)
