"""Files that cannot be written: one line that names them, nothing half-written."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest

from robots import racer
from sims.cli import main
from sims.compare.picture import write_picture
from sims.compare.problems import Family
from sims.compare.study import study
from sims.demo import Demo, Options, Outcome
from sims.metrics import Metric
from sims.report import NoDisplay, write_png, write_report
from sims.writing import NotWritten, write
from tests.room import little_room
from wbc import ModelError, Robot

SHORT = ["--duration", "0.02", "--quiet"]
FULL = Path("/dev/full")


def write_page(path: Path) -> None:
    metrics = [Metric(f"metric_{i}", 0.0, 1.0) for i in range(100)]
    write_report(path, title="a long page", summary="", metrics=metrics)


def write_noise(path: Path) -> None:
    rng = np.random.default_rng(0)
    write_png(path, rng.integers(0, 255, (60, 60, 3), dtype=np.uint8))


FOUND = study(seed=5, count=1, names=["hqp"], families=[Family("compatible")])


def write_study(path: Path) -> None:
    write_picture(FOUND, path)


@pytest.mark.parametrize("writer", [write_page, write_noise, write_study])
def test_a_file_without_room_leaves_the_older_one(writer, tmp_path):
    path = tmp_path / "older.bin"
    path.write_bytes(b"an older file")
    with little_room(), pytest.raises(NotWritten, match=r"older\.bin: File too large"):
        writer(path)
    assert path.read_bytes() == b"an older file"
    assert os.listdir(tmp_path) == ["older.bin"]
    writer(path)
    assert path.stat().st_size > 5000
    assert os.listdir(tmp_path) == ["older.bin"]


def test_what_is_written_has_the_rights_of_any_file(tmp_path):
    (tmp_path / "plain").write_text("x")
    write(tmp_path / "written", "x")
    plain, written = ((tmp_path / n).stat().st_mode for n in ("plain", "written"))
    assert plain == written


def test_a_missing_folder_is_named(tmp_path):
    with pytest.raises(NotWritten, match=r"none/x\.json: No such file"):
        write(tmp_path / "none" / "x.json", "{}")


def log_of(size: int) -> Demo:
    """A demo with so much of a log that does not compress, and nothing to draw."""

    def none() -> None:
        raise NoDisplay("nothing is drawn")

    def run(options: Options) -> Outcome:
        series = {"noise": np.random.default_rng(0).random(size)}
        held = [Metric("error_max_m", 0.0, 1.0)]
        return Outcome(held, series, list, lambda: "x" * 6000, none)

    return Demo("welding", "a demo that computes nothing", run)


@pytest.mark.parametrize(
    ("size", "name", "left"),
    [
        (10_000, "log.npz", {"metrics.json"}),
        (10, "report.html", {"metrics.json", "log.npz"}),
    ],
)
def test_a_run_without_room_names_the_file(
    size, name, left, tmp_path, monkeypatch, capsys
):
    monkeypatch.setattr("sims.commands.find_demo", lambda _: log_of(size))
    with little_room():
        code = main(["run", "welding", "--out", str(tmp_path)])
    said = capsys.readouterr()
    assert code == 2
    assert said.err.splitlines()[-1] == f"wbc: {tmp_path / name}: File too large."
    assert "Traceback" not in said.err
    assert set(os.listdir(tmp_path)) == left


def test_a_model_needs_room_for_a_temporary_file(monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", "/proc")
    with pytest.raises(ModelError, match=r"'/proc/.*TMPDIR"):
        Robot.from_mjcf(racer.mjcf())


@pytest.mark.parametrize(
    "arguments", [["run", "welding", *SHORT], ["compare", "transitions"]]
)
def test_a_read_only_folder_is_refused_before_the_run(arguments, capsys):
    """One that even root cannot write to."""
    assert main([*arguments, "--out", "/proc"]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.startswith("wbc: --out /proc: ")
    assert said.err.count("\n") == 1


@pytest.mark.skipif(not FULL.exists(), reason="only Linux has a device that is full")
def test_standard_output_without_room_is_one_line():
    with FULL.open("w") as full:
        found = _run(["-m", "sims.cli", "list"], full)
    assert found == (2, "wbc: standard output: No space left on device.\n")


def test_a_closed_standard_output_is_no_error():
    code = "import os, sys; os.close(1); os.execv(sys.executable, sys.argv[1:])"
    arguments = [sys.executable, "-m", "sims.cli", "list"]
    assert _run(["-c", code, *arguments]) == (0, "")


def _run(arguments, stdout=subprocess.DEVNULL) -> tuple[int, str]:
    """Exit code, and what went to standard error."""
    done = subprocess.run(
        [sys.executable, *arguments],
        stdout=stdout,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    return done.returncode, done.stderr
