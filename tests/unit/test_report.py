from __future__ import annotations

import base64
import json
import re
from html.parser import HTMLParser

import mujoco
import numpy as np
import pytest

from sims.metrics import Metric
from sims.report.figures import time_series
from sims.report.page import write_report
from sims.report.replay import Marker, Replay, Trace
from sims.report.snapshot import NoDisplay, render, write_png
from wbc.errors import InputError

MODEL = """
<mujoco>
  <asset>
    <material name="steel" rgba="0.7 0.7 0.8 1"/>
    <mesh name="wedge" vertex="0 0 0 .1 0 0 0 .1 0 0 0 .1"/>
  </asset>
  <worldbody>
    <light pos="0 0 2"/>
    <geom name="floor" type="plane" size="0 0 0.1"/>
    <geom name="hidden" type="sphere" size="0.1" group="3"/>
    <geom name="glass" type="box" size="0.1 0.1 0.1" rgba="0.2 0.4 0.9 0.3"/>
    <body name="upper" pos="0 0 0.5">
      <joint name="shoulder" axis="0 1 0"/>
      <geom type="capsule" size="0.04" fromto="0 0 0 0.3 0 0" material="steel"/>
      <geom type="mesh" mesh="wedge"/>
      <body name="lower" pos="0.3 0 0">
        <joint name="elbow" axis="0 1 0"/>
        <geom type="cylinder" size="0.03 0.1"/>
        <geom type="ellipsoid" size="0.05 0.04 0.03"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
TIMES = np.arange(2001) / 1000.0
QPOS = np.column_stack([np.sin(3.0 * TIMES), 0.5 * TIMES])


@pytest.fixture(scope="module")
def model() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(MODEL)


@pytest.fixture(scope="module")
def replay(model) -> Replay:
    line = np.column_stack([TIMES, 0.0 * TIMES, 1.0 + 0.0 * TIMES])
    return Replay(
        model,
        TIMES,
        QPOS,
        traces=[Trace("seam </script>", line, times=TIMES)],
        markers=[Marker("target", (0.1, 0.2, 0.3)), Marker("tip", line)],
    )


class Reader(HTMLParser):
    """Elements with their attributes, and the text outside of scripts and styles."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self._inside: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag in ("script", "style"):
            self._inside.append(tag)

    def handle_endtag(self, tag):
        if tag in ("script", "style"):
            self._inside.pop()

    def handle_data(self, data):
        if not self._inside:
            self.text += data

    def resources(self) -> list[str]:
        keys = ("src", "href", "xlink:href", "poster", "data", "action")
        return [a[k] or "" for _, a in self.elements for k in keys if k in a]


def scene_of(document: str) -> tuple[dict, bytes]:
    scene = re.search(r'id="scene">(.*?)</script>', document, re.DOTALL)
    data = re.search(r'id="data">(.*?)</script>', document, re.DOTALL)
    return json.loads(scene[1]), base64.b64decode(data[1])


def floats(data: bytes, place: dict) -> np.ndarray:
    return np.frombuffer(data, "<f4", place["count"], place["offset"])


@pytest.fixture(scope="module")
def page(tmp_path_factory, replay) -> str:
    path = tmp_path_factory.mktemp("report") / "report.html"
    figure = time_series("Error", TIMES, {"e": QPOS[:, 0]}, "error [mm]")
    write_report(
        path,
        title="Weld <b> & co",
        summary='Follows "the" seam <img src=x onerror=alert(1)>',
        metrics=[
            Metric("ticks", 2000.0),
            Metric("lateral_error_max_m", 1.23456e-4, 5e-4),
            Metric("worst_<x>", 2.0, 1.0),
        ],
        figures=[("Error <i>", figure), ("Again", figure)],
        replay_html=replay.html(),
        facts={"resolver": "hqp:<daqp>", "seed": "7"},
    )
    return path.read_text(encoding="utf-8")


def test_the_page_contains_every_metric_fact_and_caption(page):
    text = Reader(page).text
    for word in ("ticks", "2000", "lateral_error_max_m", "0.0001235", "<= 0.0005"):
        assert word in text
    for word in ("resolver", "hqp:<daqp>", "seed", "7", "Error <i>", "Again"):
        assert word in text
    assert "1 of 2 bounds fail" in text


def test_a_verdict_is_told_by_words_and_not_by_colour_alone(page):
    text = Reader(page).text
    assert "✓ ok" in text
    assert "✗ FAIL" in text


def test_everything_that_callers_wrote_is_escaped(page):
    reader = Reader(page)
    tags = [tag for tag, _ in reader.elements]
    assert "img" not in tags
    assert "b" not in tags
    assert "daqp" not in tags
    assert 'Follows "the" seam <img src=x onerror=alert(1)>' in reader.text


def test_the_page_and_its_replay_load_nothing_from_elsewhere(page):
    frames = [a["srcdoc"] for tag, a in Reader(page).elements if tag == "iframe"]
    assert len(frames) == 1
    for document in (page, frames[0]):
        reader = Reader(document)
        assert all(r.startswith(("#", "data:")) for r in reader.resources())
        assert not [tag for tag, _ in reader.elements if tag in ("link", "base")]
    assert "@import" not in page
    assert "url(http" not in page


def test_the_frame_holds_the_replay_unchanged(page, replay):
    frame = next(a for tag, a in Reader(page).elements if tag == "iframe")
    assert frame["srcdoc"] == replay.html()


def test_a_report_of_nothing_but_a_title_is_a_page(tmp_path):
    write_report(tmp_path / "r.html", title="Empty", summary="", metrics=[])
    text = Reader((tmp_path / "r.html").read_text(encoding="utf-8")).text
    assert "Empty" in text
    assert "bounds" not in text, "nothing was judged"


@pytest.mark.parametrize("svg", ["<p>no</p>", "<svg><script>1</script></svg>"])
def test_a_figure_that_is_no_drawing_is_refused(tmp_path, svg):
    with pytest.raises(InputError, match="'cap'"):
        write_report(
            tmp_path / "r.html",
            title="t",
            summary="s",
            metrics=[],
            figures=[("cap", svg)],
        )


def test_metrics_of_one_name_are_refused(tmp_path):
    twice = [Metric("a", 1.0), Metric("a", 2.0)]
    with pytest.raises(InputError, match="more than once"):
        write_report(tmp_path / "r.html", title="t", summary="s", metrics=twice)


def test_the_replay_has_all_visible_shapes(replay):
    scene, _ = scene_of(replay.html())
    kinds = [geom["kind"] for geom in scene["geoms"]]
    assert kinds == ["plane", "box", "capsule", "mesh", "cylinder", "ellipsoid"]
    assert scene["geoms"][1]["rgba"] == pytest.approx([0.2, 0.4, 0.9, 0.3])
    assert scene["geoms"][2]["rgba"] == pytest.approx([0.7, 0.7, 0.8, 1.0])
    assert scene["undrawn"] == []


def test_the_replay_stores_thirty_frames_a_second(replay):
    assert len(replay.frame_times) == 61
    assert replay.frame_times[[0, -1]].tolist() == [0.0, 2.0]
    assert np.diff(replay.frame_times).min() > 1.0 / 30.0 - 2e-3


def test_keyframes_are_mujocos_poses_and_still_bodies_have_none(model, replay):
    scene, stored = scene_of(replay.html())
    world, upper, lower = scene["bodies"]
    assert "keys" not in world["position"]
    assert "keys" not in upper["position"]
    data = mujoco.MjData(model)
    data.qpos[:] = QPOS[1000]
    mujoco.mj_kinematics(model, data)
    positions = floats(stored, lower["position"]["keys"]).reshape(-1, 3)
    turns = floats(stored, lower["quaternion"]["keys"]).reshape(-1, 4)
    assert positions[30] == pytest.approx(data.body("lower").xpos, abs=1e-6)
    assert np.roll(turns[30], 1) == pytest.approx(data.body("lower").xquat, abs=1e-6)


def test_a_growing_trace_ends_where_it_ended(replay):
    scene, stored = scene_of(replay.html())
    trace = scene["traces"][0]
    assert floats(stored, trace["points"])[-3:] == pytest.approx([2.0, 0.0, 1.0])
    assert floats(stored, trace["times"])[-1] == pytest.approx(2.0)
    assert "seam &lt;/script&gt;" in replay.html()


def test_shapes_that_meshcat_cannot_draw_are_named_in_the_page():
    field = """<mujoco><asset><hfield name="h" nrow="2" ncol="2" size="1 1 1 1"/>
    </asset><worldbody><geom name="hill" type="hfield" hfield="h"/></worldbody>
    </mujoco>"""
    model = mujoco.MjModel.from_xml_string(field)
    replay = Replay(model, [0.0, 1.0], np.zeros((2, 0)))
    assert "not drawn: geom &#x27;hill&#x27;" in replay.html()


def test_deformable_bodies_follow_their_vertices():
    cloth = """<mujoco><worldbody><body name="b" pos="0 0 1"><flexcomp name="cloth"
    type="grid" count="3 3 1" spacing=".1 .1 .1" mass="1" dim="2">
    <edge equality="true"/></flexcomp></body></worldbody></mujoco>"""
    model = mujoco.MjModel.from_xml_string(cloth)
    qpos = np.zeros((2, model.nq))
    qpos[1, 2] = 0.25
    scene, stored = scene_of(Replay(model, [0.0, 1.0], qpos).html())
    soft = scene["soft"][0]
    place = soft["vertices"]
    steps = np.frombuffer(stored, "<u2", place["count"], place["offset"])
    vertices = steps.reshape(2, -1, 3) * soft["step"] + soft["low"]
    moved = vertices[1] - vertices[0]
    assert np.abs(moved).max() == pytest.approx(0.25, abs=1e-4)
    assert soft["faces"]["count"] == 3 * 8


def test_mocap_bodies_move(model):
    target = """<mujoco><worldbody><body name="goal" mocap="true">
    <geom size="0.1"/></body></worldbody></mujoco>"""
    mocap = np.zeros((2, 1, 7))
    mocap[:, 0, 3] = 1.0
    mocap[1, 0, 0] = 0.5
    model = mujoco.MjModel.from_xml_string(target)
    scene, stored = scene_of(
        Replay(model, [0.0, 1.0], np.zeros((2, 0)), mocap=mocap).html()
    )
    keys = floats(stored, scene["bodies"][1]["position"]["keys"])
    assert keys.tolist() == [0.0, 0.0, 0.0, 0.5, 0.0, 0.0]


def test_recordings_that_make_no_sense_are_refused(model):
    with pytest.raises(InputError, match="ascending"):
        Replay(model, [0.0, 0.0], QPOS[:2])
    with pytest.raises(InputError, match="ascending"):
        Replay(model, [0.0, np.nan], QPOS[:2])
    with pytest.raises(InputError, match="qpos has shape"):
        Replay(model, TIMES[:2], QPOS[:3])
    with pytest.raises(InputError, match="finite"):
        Replay(model, TIMES[:2], [[0.0, np.nan], [0.0, 0.0]])
    with pytest.raises(InputError, match="trace 'x'"):
        Replay(model, TIMES[:2], QPOS[:2], traces=[Trace("x", np.zeros((4, 2)))])
    with pytest.raises(InputError, match="marker 'x'"):
        Replay(model, TIMES[:2], QPOS[:2], markers=[Marker("x", np.zeros((4, 3)))])


def test_a_long_recording_of_many_bodies_stays_small():
    bodies = "".join(
        f'<body pos="{i} 0 1"><freejoint/><geom type="box" size=".1 .1 .1"/></body>'
        for i in range(30)
    )
    xml = f"<mujoco><worldbody>{bodies}</worldbody></mujoco>"
    model = mujoco.MjModel.from_xml_string(xml)
    times = np.arange(3000) / 100.0
    qpos = model.qpos0 + 0.2 * np.sin(times)[:, None] * np.arange(1, model.nq + 1)
    assert len(Replay(model, times, qpos).html().encode()) < 4_000_000


def test_a_snapshot_is_a_picture_of_the_scene_and_leaves_the_model_alone(
    model, tmp_path
):
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    before = (model.vis.global_.offwidth, model.vis.global_.offheight)
    try:
        picture = render(model, data, None, 800, 600)
    except NoDisplay as error:
        pytest.skip(f"no picture can be drawn here: {error}")
    assert picture.shape == (600, 800, 3)
    assert picture.std() > 5.0
    assert (model.vis.global_.offwidth, model.vis.global_.offheight) == before
    write_png(tmp_path / "scene.png", picture)
    assert (tmp_path / "scene.png").read_bytes().startswith(b"\x89PNG")


def test_without_opengl_the_error_is_ours(model, monkeypatch):
    def fails(*_):
        raise AttributeError("glGetError")

    monkeypatch.setattr("sims.report.snapshot._context", fails)
    with pytest.raises(NoDisplay, match=r"glGetError.*MUJOCO_GL"):
        render(model, mujoco.MjData(model))


def test_pictures_of_no_size_or_another_shape_are_refused(model, tmp_path):
    with pytest.raises(InputError, match="positive size"):
        render(model, mujoco.MjData(model), None, 0, 600)
    with pytest.raises(InputError, match="uint8"):
        write_png(tmp_path / "x.png", np.zeros((4, 4, 3)))
