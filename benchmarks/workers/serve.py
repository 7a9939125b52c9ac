"""The worker's side of the line protocol: one JSON object a line, question, answer."""

from __future__ import annotations

import gc
import json
import os
import sys
from collections.abc import Callable
from importlib.metadata import version
from typing import Any, TextIO

from benchmarks.jobs import Job
from benchmarks.workers.loop import Loop

__all__ = ["serve"]

Open = Callable[[Job, str], Loop]


def serve(open_loop: Open, packages: tuple[str, ...]) -> None:
    """Answer until the input ends.

    Questions: about; open(job, kind) -> id; run(id, ticks) -> times; close(id) ->
    report. What peers print goes to the error stream, so that it disturbs nobody.
    """
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    gc.disable()
    loops: dict[int, Loop] = {}
    for line in sys.stdin:
        question = json.loads(line)
        try:
            answer = _answer(question, loops, open_loop, packages)
        except Exception as error:
            answer = {"error": f"{type(error).__name__}: {error}"}
        _send(answers, answer)


def _answer(
    question: dict[str, Any],
    loops: dict[int, Loop],
    open_loop: Open,
    packages: tuple[str, ...],
) -> dict[str, object]:
    kind, key = question["ask"], question.get("id", -1)
    if kind == "about":
        return {"versions": {name: version(name) for name in packages}}
    if kind == "open":
        key = max(loops, default=-1) + 1
        loops[key] = open_loop(Job.from_dict(question["job"]), str(question["kind"]))
        return {"id": key}
    if kind == "run":
        ticks, aims = loops[key].run(question["ticks"])
        return {"ticks": ticks, "aims": aims}
    if kind == "close":
        report = loops.pop(key).report()
        gc.collect()
        return {"report": report}
    raise ValueError(f"unknown question {kind!r}")


def _send(stream: TextIO, answer: dict[str, object]) -> None:
    stream.write(json.dumps(answer) + "\n")
    stream.flush()
