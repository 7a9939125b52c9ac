"""`wbc run --video`: films that play, and words where there can be none."""

from __future__ import annotations

import itertools
import os
import signal
import sys
from collections.abc import Callable

import av
import mujoco
import numpy as np
import pytest

from sims.cli import main
from sims.contact.demo import run_jobs
from sims.demo import Options
from sims.registry import cell_names, find_demo
from sims.view import Display, NoVideo, WindowClosed, offscreen
from sims.view.encoder import RATE, Encoder
from sims.view.offscreen import HEIGHT, WIDTH
from tests.room import little_room

SECONDS = {"cutting": 0.4, "welding": 0.1}
"""Of each job of a cell; others have so many jobs that 0.04 s of each will do."""
CONTROLLERS = {"cutting": 2}
"""Each counts its ticks; one for most cells."""
SHORT = ["--duration", "0.04", "--quiet"]


def frames(path) -> list[np.ndarray]:
    with av.open(str(path)) as film:
        (stream,) = film.streams.video
        assert (stream.codec_context.name, stream.pix_fmt) == ("h264", "yuv420p")
        assert (stream.width, stream.height) == (WIDTH, HEIGHT)
        assert stream.average_rate == RATE
        return [frame.to_ndarray(format="rgb24") for frame in film.decode(stream)]


@pytest.mark.parametrize("cell", cell_names())
def test_every_cell_makes_a_film_of_thirty_pictures_a_second(cell, tmp_path, capsys):
    path = tmp_path / "film.mp4"
    options = Options(
        duration=SECONDS.get(cell, 0.04), quiet=True, seed=2, video=str(path)
    )
    outcome = find_demo(cell).run(options)
    ticks = next(m.value for m in outcome.metrics if m.name == "ticks")
    shown = frames(path)
    simulated = 1e-3 * ticks / CONTROLLERS.get(cell, 1)
    assert abs(len(shown) - RATE * simulated) <= 1.0
    assert f"wrote {path}, {len(shown)} frames" in capsys.readouterr().out
    for picture in shown:
        assert picture.mean() > 40.0
        assert picture.std() > 20.0
    pairs = itertools.pairwise(picture.astype(int) for picture in shown)
    changes = [np.abs(b - a).max() for a, b in pairs]
    assert min(changes) > 20  # the clock moves, if nothing else does
    assert os.listdir(tmp_path) == ["film.mp4"]


def test_filming_changes_nothing_of_a_run(tmp_path):
    """Of one with contacts and a force sensor, which a look could disturb."""
    seen, unseen = (
        run_jobs(Options(duration=0.4, quiet=True, video=video), pegs=1, cranks=0)
        for video in (str(tmp_path / "film.mp4"), None)
    )
    names = [name for name in unseen.series if not name.endswith("tick_s")]
    assert any("wrench" in name for name in names)
    for name in names:
        np.testing.assert_array_equal(seen.series[name], unseen.series[name])


# ------------------------------------------------------------------- films that end


def gradient(step: int) -> np.ndarray:
    return np.full((48, 64, 3), 20 * step, dtype=np.uint8)


def test_colours_and_order_survive(tmp_path):
    encoder = Encoder(tmp_path / "film.mp4", 64, 48)
    for step in range(10):
        encoder.add(gradient(step))
    encoder.finish()
    with av.open(str(tmp_path / "film.mp4")) as film:
        means = [f.to_ndarray(format="rgb24").mean() for f in film.decode(video=0)]
    np.testing.assert_allclose(means, 20.0 * np.arange(10), atol=2.0)


def test_an_unfinished_film_is_in_nobodys_way(tmp_path):
    path = tmp_path / "film.mp4"
    path.write_bytes(b"an older film")
    encoder = Encoder(path, 64, 48)
    encoder.add(gradient(1))
    assert path.read_bytes() == b"an older film"
    encoder.abandon()
    assert path.read_bytes() == b"an older film"
    assert os.listdir(tmp_path) == ["film.mp4"]


class Box:
    """The least that can be filmed."""

    def __init__(self) -> None:
        self.model = mujoco.MjModel.from_xml_string(
            "<mujoco><worldbody><light pos='0 0 3'/><geom size='0.2'/></worldbody>"
            "</mujoco>"
        )
        self.data, self.wrists = mujoco.MjData(self.model), ()


def film(path, ending: Callable[[], None], pictures: int = 40) -> None:
    """A film of some ticks, and what comes after them."""
    with Display(video=str(path)) as display:
        display.attach(Box())
        for _ in range(pictures):
            display(None, [])
        ending()


def fail(error: BaseException) -> Callable[[], None]:
    def ending() -> None:
        raise error

    return ending


@pytest.mark.parametrize("error", [KeyboardInterrupt(), WindowClosed()], ids=repr)
def test_a_run_that_the_user_ends_leaves_a_film_of_what_was(error, tmp_path):
    with pytest.raises(type(error)):
        film(tmp_path / "film.mp4", fail(error))
    assert len(frames(tmp_path / "film.mp4")) == 3  # of 40 ticks of 2 ms


def test_a_run_that_is_terminated_leaves_a_film_of_what_was(tmp_path):
    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(KeyboardInterrupt):
        film(tmp_path / "film.mp4", lambda: os.kill(os.getpid(), signal.SIGTERM))
    assert len(frames(tmp_path / "film.mp4")) == 3
    assert signal.getsignal(signal.SIGTERM) is before


def test_a_run_that_fails_leaves_nothing(tmp_path):
    with pytest.raises(RuntimeError, match="broken"):
        film(tmp_path / "film.mp4", fail(RuntimeError("broken")))
    assert os.listdir(tmp_path) == []


def test_a_run_without_a_tick_leaves_nothing(tmp_path):
    film(tmp_path / "film.mp4", lambda: None, pictures=0)
    assert os.listdir(tmp_path) == []


def add_noise(encoder: Encoder, pictures: int) -> None:
    rng = np.random.default_rng(0)
    for _ in range(pictures):
        encoder.add(rng.integers(0, 255, (48, 64, 3), dtype=np.uint8))


def test_a_film_without_room_is_one_error_and_leaves_nothing(tmp_path):
    with little_room():
        encoder = Encoder(tmp_path / "film.mp4", 64, 48)
        with pytest.raises(NoVideo, match=r"film\.mp4: .*large"):
            add_noise(encoder, 200)
        encoder.abandon()
    assert os.listdir(tmp_path) == []


def test_a_film_that_cannot_be_finished_leaves_nothing(tmp_path):
    with little_room():
        encoder = Encoder(tmp_path / "film.mp4", 64, 48)
        add_noise(encoder, 12)  # which the encoder holds back until the end
        with pytest.raises(NoVideo):
            encoder.finish()
    assert os.listdir(tmp_path) == []


# ------------------------------------------------------------ what is said beforehand


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "folder.mp4").mkdir()
    return tmp_path


@pytest.mark.parametrize(
    ("name", "word"),
    [
        ("film.gif", "must end in .mp4"),
        ("film", "must end in .mp4"),
        ("missing/film.mp4", "there is no folder"),
        ("folder.mp4", "is a folder"),
        ("/proc/film.mp4", "--video /proc/film.mp4: "),
    ],
)
def test_a_bad_place_is_refused_before_the_run(name, word, folder, capsys):
    path = name if name.startswith("/") else str(folder / name)
    assert main(["run", "welding", "--video", path, *SHORT]) == 2
    said = capsys.readouterr()
    assert word in said.err
    assert said.err.count("\n") == 1
    assert said.out == ""


def test_without_the_package_it_says_what_to_install(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "av", None)
    assert main(["run", "welding", "--video", str(tmp_path / "f.mp4"), *SHORT]) == 2
    said = capsys.readouterr()
    assert "pip install 'wbc[video]'" in said.err
    assert said.out == ""


def test_without_opengl_it_says_so(tmp_path, monkeypatch, capsys):
    def none():
        raise RuntimeError("no such library")

    monkeypatch.setattr(offscreen, "_context", none)
    assert main(["run", "welding", "--video", str(tmp_path / "f.mp4"), *SHORT]) == 2
    said = capsys.readouterr()
    assert "no video without OpenGL (RuntimeError: no such library)" in said.err
    assert said.out == ""
    assert os.listdir(tmp_path) == []


def test_nothing_of_it_is_imported_without_a_film():
    """The package is optional, so that every other command must do without it."""
    import subprocess

    code = "import sys, sims.cli; sys.exit('av' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_closed_window_ends_the_command(monkeypatch, capsys):
    def closed(options):
        raise WindowClosed

    monkeypatch.setattr("sims.commands.find_demo", lambda name: _demo(closed))
    assert main(["run", "welding"]) == 130
    assert "the window was closed" in capsys.readouterr().err


def _demo(run):
    from sims.demo import Demo

    return Demo("welding", "a demo whose window is closed", run)
