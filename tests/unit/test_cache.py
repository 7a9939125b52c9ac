"""Compiled code between runs: damaged files, and folders of the past."""

from __future__ import annotations

import importlib.util
import os
import shutil
import time
from pathlib import Path

import numpy as np
import pytest

from wbc import cache, compiled

SOURCE = """
from wbc.compiled import compiled

@compiled
def double(x):
    for i in range(x.size):
        x[i] *= 2.0
"""
DAY = 24 * 3600.0


@pytest.fixture
def doubled(tmp_path, monkeypatch):
    """Runs the kernel as a new process would: its result, and whether it was kept."""
    source = tmp_path / "kernel_of_the_test.py"
    source.write_text(SOURCE)
    for module in (cache, compiled):
        monkeypatch.setattr(module, "CACHE", tmp_path / "kept")

    def run() -> tuple[float, int]:
        spec = importlib.util.spec_from_file_location(source.stem, source)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        x = np.ones(1)
        module.double(x)
        return x[0], sum(module.double.stats.cache_hits.values())

    return run


def files(tmp_path: Path, kind: str) -> list[Path]:
    found = list((tmp_path / "kept").rglob(f"*.{kind}"))
    assert found
    return found


def test_a_kernel_is_compiled_once(doubled):
    assert doubled() == (2.0, 0)
    assert doubled() == (2.0, 1)


@pytest.mark.parametrize("kind", ["nbi", "nbc"])
@pytest.mark.parametrize("left", [0, 10, 0.5], ids=["empty", "short", "half"])
def test_a_truncated_file_is_replaced(doubled, tmp_path, kind, left):
    doubled()
    for path in files(tmp_path, kind):
        whole = path.read_bytes()
        path.write_bytes(whole[: int(left * len(whole)) if left < 1 else left])
    assert doubled() == (2.0, 0)
    assert doubled() == (2.0, 1)


@pytest.mark.parametrize("kind", ["nbi", "nbc"])
def test_garbage_is_replaced(doubled, tmp_path, kind):
    doubled()
    for path in files(tmp_path, kind):
        path.write_bytes(b"what is this?" * 100)
    assert doubled() == (2.0, 0)
    assert doubled() == (2.0, 1)


def test_what_cannot_be_replaced_is_named(doubled, tmp_path, capsys):
    doubled()
    for path in files(tmp_path, "nbi"):
        path.unlink()
        path.mkdir()
    assert doubled() == (2.0, 0)
    assert f"delete the folder {tmp_path / 'kept'}" in capsys.readouterr().err


def folders(root: Path, ages: list[float]) -> list[Path]:
    made = []
    for i, age in enumerate(ages):
        made.append(root / f"kernels-{i:016x}")
        (made[-1] / "tasks").mkdir(parents=True)
        (made[-1] / "tasks" / "kernel.nbc").write_bytes(b"code")
        os.utime(made[-1], (time.time() - age * DAY,) * 2)
    return made


def test_old_folders_go_but_for_the_newest_and_those_in_use(tmp_path):
    made = folders(tmp_path, [1, 2, 3, 4, 5, 29, 31, 400])
    (tmp_path / "other").mkdir()
    cache.prune(tmp_path)
    assert sorted(tmp_path.iterdir()) == sorted([*made[:6], tmp_path / "other"])


def test_the_newest_stay_however_old(tmp_path):
    made = folders(tmp_path, [100, 200, 300, 400, 500])
    cache.prune(tmp_path)
    assert sorted(tmp_path.iterdir()) == sorted(made[:4])


def test_a_folder_that_is_gone_meanwhile_is_no_error(tmp_path, monkeypatch):
    folders(tmp_path, [100, 200, 300, 400, 500, 600])
    rename = Path.rename

    def late(self: Path, target: Path) -> Path:
        shutil.rmtree(self)  # as another process would
        return rename(self, target)

    monkeypatch.setattr(Path, "rename", late)
    cache.prune(tmp_path)
    assert len(list(tmp_path.iterdir())) == 4


def test_a_new_folder_is_what_prunes_and_use_keeps_one_young(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    root = tmp_path / "wbc"
    folders(root, [100, 200, 300, 400, 500])
    mine = cache._cache_folder()
    assert mine is not None
    assert len(list(root.iterdir())) == 4
    os.utime(mine, (0, 0))
    assert cache._cache_folder() == mine
    assert time.time() - mine.stat().st_mtime < DAY
    assert len(list(root.iterdir())) == 4
