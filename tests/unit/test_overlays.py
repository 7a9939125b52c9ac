"""Lines, arrows and chapters of a replay, and cards of a page, in what is written."""

from __future__ import annotations

import base64
import json
import re

import mujoco
import numpy as np
import pytest

from sims.grasping.gripper import JOINTS
from sims.grasping.touch import Touch
from sims.report.figures import time_series
from sims.report.page import write_report
from sims.report.replay import Arrow, Replay, Trace
from wbc.errors import InputError

MODEL = """<mujoco><worldbody><body><joint axis="0 1 0"/>
<geom type="box" size=".5 .5 .5"/></body></worldbody></mujoco>"""
TIMES = np.arange(31) / 30.0
QPOS = np.zeros((31, 1))
STILL = np.zeros((31, 3))


def replay_of(**overlays) -> Replay:
    return Replay(mujoco.MjModel.from_xml_string(MODEL), TIMES, QPOS, **overlays)


def pushing(newtons: float, name: str = "push", unit: str = "N") -> Arrow:
    return Arrow(name, STILL, STILL + np.array([0.0, 0.0, newtons]), unit)


def scene_of(document: str) -> tuple[dict, bytes]:
    scene = re.search(r'id="scene">(.*?)</script>', document, re.DOTALL)
    data = re.search(r'id="data">(.*?)</script>', document, re.DOTALL)
    return json.loads(scene[1]), base64.b64decode(data[1])


def stored(data: bytes, place: dict) -> np.ndarray:
    return np.frombuffer(data, "<f4", place["count"], place["offset"])


def scales(*arrows: Arrow) -> list[float]:
    scene, _ = scene_of(replay_of(arrows=arrows).html())
    return [arrow["perCm"] for arrow in scene["arrows"]]


def test_an_arrow_is_stored_frame_by_frame_and_its_legend_has_name_unit_and_scale():
    force = np.outer(np.arange(31), [0.0, 0.0, 1.0])
    page = replay_of(arrows=[Arrow("knife <b>", STILL, force)]).html()
    scene, data = scene_of(page)
    (arrow,) = scene["arrows"]
    vectors = stored(data, arrow["vectors"]).reshape(-1, 3)
    assert vectors[:, 2].tolist() == list(range(31))
    assert "knife &lt;b&gt;" in page
    assert f"1 cm = {arrow['perCm']:g} N" in page


def test_arrows_are_long_enough_to_see_and_short_enough_for_the_room():
    radius = np.sqrt(3.0) * np.sqrt(0.75)  # of a box around the ball around the box
    for newtons in (0.037, 1.0, 19.0, 4321.0):
        (per_cm,) = scales(pushing(newtons))
        assert 0.1 * radius < 0.01 * newtons / per_cm <= 0.3 * radius
        assert f"{per_cm:.0e}"[0] in "125"


def test_arrows_of_one_unit_share_a_scale_unless_one_would_be_a_dwarf():
    first, second, dwarf = scales(pushing(100.0), pushing(30.0), pushing(3.0))
    assert first == second > dwarf
    force, speed = scales(pushing(100.0), pushing(1.0, unit="mm/s"))
    assert force > speed


def test_an_arrow_that_never_shows_has_some_scale():
    assert scales(pushing(0.0)) == [1.0]
    assert scales(pushing(1e-11)) == [1.0]
    push, noise = scales(pushing(100.0), pushing(1e-11))
    assert noise == push


def test_arrows_that_do_not_fit_are_refused():
    with pytest.raises(InputError, match="vectors of arrow 'x'"):
        replay_of(arrows=[Arrow("x", STILL, np.zeros((30, 3)))])
    with pytest.raises(InputError, match="points of arrow 'x'"):
        replay_of(arrows=[Arrow("x", np.zeros(3), STILL)])


def test_a_line_that_moves_is_stored_frame_by_frame():
    lines = TIMES[:, None, None] + np.zeros((31, 4, 3))
    scene, data = scene_of(replay_of(traces=[Trace("guide", lines)]).html())
    moving = stored(data, scene["traces"][0]["moving"]).reshape(31, 4, 3)
    np.testing.assert_allclose(moving, lines, atol=1e-7)
    with pytest.raises(InputError, match="trace 'guide'"):
        replay_of(traces=[Trace("guide", lines[:30])])
    with pytest.raises(InputError, match="no points"):
        replay_of(traces=[Trace("guide", lines[:, :0])])


def test_one_of_many_like_lines_is_enough_for_the_legend():
    way = np.column_stack([TIMES, TIMES, TIMES])
    page = replay_of(
        traces=[Trace("first", way), Trace("second", way, listed=False)]
    ).html()
    legend = re.search(r'<ul id="legend">(.*?)</ul>', page, re.DOTALL)[1]
    assert "first" in legend
    assert "second" not in legend


def test_chapters_begin_in_the_replays_own_time():
    model = mujoco.MjModel.from_xml_string(MODEL)
    replay = Replay(model, 5.0 + TIMES, QPOS, chapters=[("a", 5.0), ("b", 5.5)])
    scene, _ = scene_of(replay.html())
    assert scene["chapters"] == [
        {"name": "a", "begin": 0.0},
        {"name": "b", "begin": 0.5},
    ]


def test_like_figures_are_folded_after_the_first_four(tmp_path):
    svg = time_series("t", [0.0, 1.0], {"y": [0.0, 1.0]}, "y [m]")
    drawn = [(f"run {i}.", svg) for i in range(6)]
    path = tmp_path / "r.html"
    write_report(
        path, title="t", summary="", metrics=[], runs=drawn, how_to_read="<so>"
    )
    before, fold = path.read_text(encoding="utf-8").split("<details>")
    assert "&lt;so&gt;" in before
    assert [f"run {i}." in before for i in range(6)] == [True] * 4 + [False] * 2
    assert "2 more" in fold
    assert "run 5." in fold


def test_tables_stand_above_the_figures_and_those_of_the_annex_below(tmp_path):
    svg = time_series("t", [0.0, 1.0], {"y": [0.0, 1.0]}, "y [m]")
    tables = [(name, [["a", "b"], ["1", "2"]]) for name in ("early", "late")]
    path = tmp_path / "r.html"
    write_report(
        path,
        title="t",
        summary="",
        metrics=[],
        figures=[("drawn", svg)],
        data=tables[:1],
        annex=tables[1:],
    )
    page = path.read_text(encoding="utf-8")
    assert page.index(">early<") < page.index(">drawn<") < page.index(">late<")


def test_on_paper_a_picture_stands_for_the_replay(tmp_path):
    path = tmp_path / "r.html"
    picture = np.zeros((4, 6, 3), dtype=np.uint8)
    page = replay_of().html()
    write_report(
        path, title="t", summary="", metrics=[], replay_html=page, picture=picture
    )
    image = re.search(
        r'<img class="printed"[^>]*base64,([^"]*)"', path.read_text("utf-8")
    )
    assert base64.b64decode(image[1]).startswith(b"\xff\xd8")  # a JPEG


SQUEEZE = f"""<mujoco><option gravity="0 0 0"/><worldbody>
<body name="block"><freejoint/><geom type="box" size=".05 .05 .05" mass="1"/></body>
<body name="{JOINTS[0]}" pos="-.07 0 0"><joint name="a" type="slide" axis="1 0 0"/>
<geom size=".02" mass=".1" friction="1"/></body>
<body name="{JOINTS[1]}" pos=".07 0 0"><joint name="b" type="slide" axis="-1 0 0"/>
<geom size=".02" mass=".1"/></body></worldbody>
<actuator><motor joint="a"/><motor joint="b"/></actuator></mujoco>"""


def test_fingers_at_rest_push_with_the_force_that_drives_them():
    model = mujoco.MjModel.from_xml_string(SQUEEZE)
    data, touch = mujoco.MjData(model), Touch(model)
    touch.see(data)
    data.ctrl[:] = 30.0
    for _ in range(1000):
        mujoco.mj_step(model, data)
        touch.see(data)
    assert touch.t.size == len(touch.points) == len(touch.forces) == 51
    np.testing.assert_allclose(touch.forces[-1, :, 0], [30.0, -30.0], rtol=1e-3)
    np.testing.assert_allclose(touch.points[-1, :, 0], [-0.05, 0.05], atol=5e-3)  # soft
