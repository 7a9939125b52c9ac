"""Our side of the line protocol: a worker process that is asked one thing at a time."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from pathlib import Path
from typing import Any

from benchmarks.machine import SINGLE_THREAD

__all__ = ["ROOT", "Worker", "WorkerError", "environment"]

ROOT = Path(__file__).resolve().parent.parent


class WorkerError(RuntimeError):
    """A worker died, or could not do what it was asked."""


def environment() -> dict[str, str]:
    """Of worker processes: one thread, and this package importable."""
    return {**os.environ, **SINGLE_THREAD, "PYTHONPATH": str(ROOT)}


class Worker:
    """A process that serves one environment; end it with `stop`.

    Args:
        name: module of `benchmarks.workers`.
        python: interpreter of its environment.
    """

    def __init__(self, name: str, python: Path | str) -> None:
        self.name = name
        self._errors = tempfile.TemporaryFile("w+")  # noqa: SIM115 - closed by stop
        self._process = subprocess.Popen(
            [str(python), "-m", f"benchmarks.workers.{name}"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            text=True,
            cwd=ROOT,
            env=environment(),
        )

    def ask(self, what: str, **details: Any) -> dict[str, Any]:
        """The answer to a question.

        Raises:
            WorkerError: it has none.
        """
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        try:
            self._process.stdin.write(json.dumps({"ask": what, **details}) + "\n")
            self._process.stdin.flush()
            line = self._process.stdout.readline()
        except BrokenPipeError:
            line = ""
        if not line:
            raise WorkerError(f"{self.name} died: {self._last_words()}")
        answer: dict[str, Any] = json.loads(line)
        if "error" in answer:
            raise WorkerError(f"{self.name}: {answer['error']}")
        return answer

    def stop(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.communicate()
        self._errors.close()

    def _last_words(self) -> str:
        self._process.wait(timeout=10)
        self._errors.seek(0)
        lines = self._errors.read().strip().splitlines()
        return lines[-1] if lines else f"exit code {self._process.returncode}"
