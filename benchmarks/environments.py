"""An environment of its own for every peer, set up once and kept in a cache folder."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

__all__ = ["PEERS", "NotAvailable", "default_cache", "prepare"]

PEERS = {
    "placo": ("placo==0.10.2",),
    "tsid": ("tsid==1.7.1", "pin==3.4.0", "cmeel-urdfdom<5", "cmeel-tinyxml2<11"),
}
"""Wheels that work together; later ones of TSID crash when they load a robot."""


class NotAvailable(RuntimeError):
    """A peer could not be installed; says why."""


def default_cache() -> Path:
    """Where peers are kept unless told otherwise."""
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "wbc-benchmarks"


def prepare(peer: str, cache: Path) -> Path:
    """The interpreter of a peer's environment, made at the first call.

    Raises:
        NotAvailable: its wheels cannot be installed here.
    """
    folder = cache / peer
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    wanted = f"{sys.version}\n" + "\n".join(PEERS[peer])
    mark = folder / "installed.txt"
    if mark.is_file() and mark.read_text() == wanted and python.exists():
        return python
    print(f"installing {peer} into the cache ...", file=sys.stderr, flush=True)
    shutil.rmtree(folder, ignore_errors=True)
    venv.create(folder, with_pip=True)
    pip = [str(python), "-m", "pip", "install", "--quiet", "--only-binary=:all:"]
    done = subprocess.run([*pip, *PEERS[peer]], capture_output=True, text=True)
    if done.returncode:
        reason = (done.stderr.strip().splitlines() or ["pip failed"])[-1]
        raise NotAvailable(f"{peer}: {reason}")
    mark.write_text(wanted)
    return python
