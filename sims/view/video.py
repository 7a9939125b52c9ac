"""A video of a run: a picture of every thirtieth of a simulated second."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NoReturn, final

import mujoco

from sims.view.encoder import RATE, Encoder, NoVideo, check_path
from sims.view.offscreen import HEIGHT, WIDTH, Offscreen
from sims.view.overlay import Frame, World

__all__ = ["NoVideo", "Video", "check_video", "termination_interrupts"]

EARLY = 1e-9
"""By which a picture may come before its time, for times that are sums [s]."""


def check_video(path: str | Path) -> None:
    """See that a video could be written, before anything runs.

    Raises:
        InputError: not a place for a video.
        NoVideo: the package that encodes is not installed.
        NoDisplay: no OpenGL on this machine.
    """
    check_path(path)
    Offscreen().close()


@final
class Video:
    """Draws and writes; runs that follow each other follow each other there.

    Args:
        path: of the file, which appears when it is finished.
        camera: from where it is seen.

    Raises:
        InputError, NoVideo, NoDisplay: as `check_video`.
    """

    def __init__(
        self, path: str | Path, camera: mujoco.MjvCamera | None = None
    ) -> None:
        self._camera = Offscreen(camera)
        try:
            self._encoder = Encoder(path, WIDTH, HEIGHT)
        except Exception:
            self._camera.close()
            raise
        self._simulated = 0.0

    @property
    def path(self) -> Path:
        """Where it will be."""
        return self._encoder.path

    @property
    def count(self) -> int:
        """Pictures so far."""
        return self._encoder.count

    def attach(self, world: World) -> None:
        """Show this cell from now on."""
        self._camera.attach(world)

    def due(self, dt: float) -> bool:
        """Whether the tick, of dt [s], needs a picture."""
        due = self._simulated >= self.count / RATE - EARLY
        self._simulated += dt
        return due

    def show(self, frame: Frame) -> None:
        """Add a picture.

        Raises:
            NoVideo: it cannot be written.
        """
        self._encoder.add(self._camera.shoot(frame))

    def finish(self) -> None:
        """Put the file in its place.

        Raises:
            NoVideo: it cannot be written.
        """
        self._camera.close()
        self._encoder.finish()

    def abandon(self) -> None:
        """Leave nothing behind."""
        self._camera.close()
        self._encoder.abandon()


@contextmanager
def termination_interrupts() -> Iterator[None]:
    """Let a SIGTERM end what is within as Ctrl-C does, so that a video is finished.

    Signals reach the main thread alone; elsewhere nothing changes.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, _interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _interrupt(number: int, frame: object) -> NoReturn:
    del number, frame
    raise KeyboardInterrupt
