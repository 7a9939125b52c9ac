"""Runs the code blocks of a Markdown page, as a reader would, from top to bottom.

- A Python block whose first line is `# name.py` is saved under that name; every other
  one is run, in one namespace for the page.
- In a shell block of a page that saves files, `python name.py` is run as it stands.
- A text block after either is what it prints, or how an error of ours ends; numbers
  may differ by 2 %, and `...` stands for anything.
"""

from __future__ import annotations

import contextlib
import io
import math
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

from wbc import WbcError

FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", flags=re.DOTALL | re.MULTILINE)
FILE = re.compile(r"# (\w+\.py)\n")
NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?")
ROUGHLY, ROUND_OFF = 0.02, 1e-8
PATIENCE = 240
"""For a program that a reader starts [s]."""


class Block(NamedTuple):
    kind: str
    text: str


class Done(NamedTuple):
    """What running a page came to."""

    compared: int
    started: list[str]


def blocks_of(page: Path) -> list[Block]:
    return [Block(*found) for found in FENCE.findall(page.read_text(encoding="utf-8"))]


def commands_of(page: Path) -> list[list[str]]:
    lines = [b.text for b in blocks_of(page) if b.kind == "sh"]
    words = [line.split("#")[0].split() for text in lines for line in text.split("\n")]
    return [line for line in words if line]


def run_page(page: Path, folder: Path) -> Done:
    """Run all blocks in a folder, which is the current one."""
    namespace: dict = {"__name__": page.stem}
    printed, compared, started, files = "", 0, [], set()
    blocks = blocks_of(page)
    for k, (kind, text) in enumerate(blocks):
        where = f"{page.name}, block {k + 1}"
        if kind == "python" and (name := FILE.match(text)):
            (folder / name[1]).write_text(text, encoding="utf-8")
            files.add(name[1])
        elif kind == "python":
            told = k + 1 < len(blocks) and blocks[k + 1].kind == "text"
            printed = _run(text, namespace, where, may_fail=told)
        elif kind == "sh":
            for command in (line.split() for line in text.splitlines()):
                if command[:1] == ["python"] and command[1] in files:
                    printed = _start(command[1:], folder)
                    started.append(command[1])
        elif kind == "text" and k and blocks[k - 1].kind in ("python", "sh"):
            assert same(text, printed), f"{where}: it prints\n{printed}"
            compared += 1
    return Done(compared, started)


def _run(text: str, namespace: dict, where: str, *, may_fail: bool) -> str:
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        try:
            exec(compile(text, where, "exec"), namespace)
        except WbcError as error:
            if not may_fail:
                raise
            print(f"{type(error).__name__}: {error}")
    return out.getvalue()


def _start(arguments: list[str], folder: Path) -> str:
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def same(told: str, printed: str) -> bool:
    """Word by word, with room for round-off and for what `...` leaves out."""
    wanted, found = told.split(), printed.split()
    parts: list[list[str]] = [[]]
    for word in wanted:
        if word == "...":
            parts.append([])
        else:
            parts[-1].append(word)
    at = 0
    for k, part in enumerate(parts):
        last = k == len(parts) - 1
        at = len(found) - len(part) if last and len(parts) > 1 else at
        while not all(map(alike, part, found[at : at + len(part)])):
            if k == 0 or last or at + len(part) >= len(found):
                return False
            at += 1
        if at < 0 or len(found) < at + len(part):
            return False
        at += len(part)
    return at == len(found)


def alike(told: str, printed: str) -> bool:
    """The same word, but for numbers that differ little."""
    if NUMBER.sub("#", told) != NUMBER.sub("#", printed):
        return False
    pairs = zip(NUMBER.findall(told), NUMBER.findall(printed), strict=True)
    return all(
        math.isclose(float(a), float(b), rel_tol=ROUGHLY, abs_tol=ROUND_OFF)
        for a, b in pairs
    )
