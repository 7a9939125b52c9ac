"""Where compiled code is kept between runs: a folder for each state of the sources.

Folders of states that are gone are deleted when a new one is made, but for the newest
few and for those used of late: several versions may take turns on one machine.
"""

from __future__ import annotations

import getpass
import hashlib
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Final

__all__ = ["CACHE", "forgive", "prune"]

KEPT: Final = 4
"""Folders that stay, however old."""
UNUSED: Final = 30 * 24 * 3600.0
"""How long a folder must have been idle before it goes [s]."""


def _digest() -> str:
    """Of exactly these kernels."""
    digest = hashlib.sha256()
    here = Path(__file__).parent
    for folder in (here, here.with_name("tasks")):
        for source in sorted(folder.rglob("*.py")):
            text = source.read_bytes()
            if b"wbc.compiled" in text or b"NamedTuple" in text or b"numba" in text:
                digest.update(text)
    return digest.hexdigest()[:16]


def _cache_folder() -> Path | None:
    """Where compiled code belongs; None where nothing can be written."""
    home = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    spare = Path(tempfile.gettempdir()) / f"wbc-{getpass.getuser()}"
    for root in (Path(home) / "wbc", spare):
        folder = root / f"kernels-{_digest()}"
        try:
            new = not folder.exists()
            folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            with tempfile.TemporaryFile(dir=folder):
                os.utime(folder)  # in use
        except OSError:
            continue
        if new:
            prune(root)
        return folder
    return None


def prune(root: Path) -> None:
    """Delete folders of compiled code that nobody used for long, but for the newest."""
    dated = []
    for folder in root.glob("kernels-*"):
        try:
            dated.append((folder.stat().st_mtime, folder))
        except OSError:  # another process was faster
            continue
    for last, folder in sorted(dated, reverse=True)[KEPT:]:
        if time.time() - last < UNUSED:
            continue
        gone = folder.with_name(f"{folder.name}.gone")
        try:
            folder.rename(gone)  # at once, so that nobody finds half of it
        except OSError:
            gone = folder
        shutil.rmtree(gone, ignore_errors=True)


def forgive(kernel: Any) -> None:
    """Let a kernel be compiled afresh where its cache is damaged or cannot be written.

    Args:
        kernel: a function that was compiled with a cache.
    """
    cache = kernel._cache
    load, save = cache.load_overload, cache.save_overload

    def load_or_compile(signature: Any, context: Any) -> Any:
        try:
            return load(signature, context)
        except Exception:  # whatever the remains of a file lead to
            _forget(cache)
            return None

    def save_or_say(signature: Any, data: Any) -> None:
        try:
            save(signature, data)
        except Exception as error:  # a full disk, or a damaged file that will not go
            sys.stderr.write(
                f"wbc: compiled code cannot be kept ({error}); if that stays so, "
                f"delete the folder {CACHE}\n"
            )

    cache.load_overload, cache.save_overload = load_or_compile, save_or_say


def _forget(cache: Any) -> None:
    try:
        cache.flush()
    except OSError:
        return  # saving will say so


CACHE: Final = _cache_folder()
