"""What shows a run as it goes: a window, a video, both or neither."""

from __future__ import annotations

import copy
import sys
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from types import TracebackType
from typing import TypeVar, final

import mujoco
from numpy.typing import ArrayLike

from sims.run import Decision
from sims.view.jogger import Jogger
from sims.view.overlay import Overlay, Own, World
from sims.view.video import Video, termination_interrupts
from sims.view.window import (
    KEYS,
    NoWindow,
    Restart,
    Window,
    WindowClosed,
    need_display,
)

__all__ = ["Display", "WindowClosed", "nearer"]

T = TypeVar("T")


@final
class Display:
    """A watcher of runs (`sims.run`), to be used in a `with` statement.

    A video that the operator ends early, by closing the window, by an interrupt or by
    terminating the process, is kept as far as it came; one of a run that fails is not.

    Args:
        view: open a window; where none opens, it says so and goes on without.
        video: file for a video; None for none.
        camera: from where to look.

    Raises:
        InputError, NoVideo, NoDisplay: no video can be written, as `check_video` says.

    Attributes:
        jogger: the keys of the window; None without one.
    """

    def __init__(
        self,
        *,
        view: bool = False,
        video: str | None = None,
        camera: mujoco.MjvCamera | None = None,
    ) -> None:
        self._camera, self._title, self._playing = camera, "", False
        self._ending = ExitStack()
        self._window: Window | None = None
        self._video = None if video is None else Video(video, copy.copy(camera))
        self.jogger = Jogger() if view and _can_open() else None

    def attach(self, world: World) -> None:
        """Show this cell from now on."""
        self._world, self._overlay = world, Overlay(world)
        if self._video is not None:
            self._video.attach(world)
        if self.jogger is not None:
            self._open(world, self.jogger)

    def add(self, own: Own) -> None:
        """Draw marks of the cell's own, too, in the place of earlier ones."""
        self._overlay.own = own

    def _open(self, world: World, jogger: Jogger) -> None:
        """A window has one model for life: the next one looks from the same place."""
        if self._window is None:
            sys.stderr.write(f"wbc: {KEYS}\n")
        else:
            self._camera = copy.copy(self._window.camera)
            self._window.close()
        try:
            self._window = Window(world, jogger, self._camera)
        except NoWindow as error:
            self.jogger = self._window = None
            _headless(error)

    def play(self, title: str, job: Callable[[], T]) -> T:
        """Do a job of one or several runs, and again when the operator wants it.

        Each time the cell's state is what it was before.

        Raises:
            WindowClosed: the operator has had enough.
        """
        self._title = title
        if self._window is None:
            return job()
        model, data = self._world.model, self._world.data
        before = copy.copy(data)
        while True:
            self._playing = True
            try:
                return job()
            except Restart:
                mujoco.mj_copyData(data, model, before)
            finally:
                self._playing = False

    def __call__(self, cell: object, decisions: Sequence[Decision]) -> bool:
        """See a tick; false where the operator wants a restart that none will `play`.

        Raises:
            WindowClosed: the operator has had enough.
        """
        del cell
        try:
            self._see(decisions)
        except Restart:
            if self._playing:
                raise
            return False
        return True

    def _see(self, decisions: Sequence[Decision]) -> None:
        window, video = self._window, self._video
        live = window is not None and window.due()
        filmed = video is not None and video.due(self._world.model.opt.timestep)
        if live or filmed:
            frame = self._overlay.frame(self._title, decisions)
            if video is not None and filmed:
                video.show(frame)
            if window is not None and live:
                window.show(frame)

    def __enter__(self) -> Display:
        if self._video is not None:
            self._ending.enter_context(termination_interrupts())
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the window, and finish the video or drop it."""
        self._ending.close()
        if self._window is not None:
            self._window.close()
        if self._video is None:
            return
        if kind is None or issubclass(kind, KeyboardInterrupt | WindowClosed):
            self._video.finish()
            print(f"wrote {self._video.path}, {self._video.count} frames")
        else:
            self._video.abandon()


def nearer(
    camera: mujoco.MjvCamera, distance: float, lookat: ArrayLike
) -> mujoco.MjvCamera:
    """The same look at a point (3,) [m] from so near [m] that tasks can be seen."""
    close = copy.copy(camera)
    close.distance, close.lookat[:] = distance, lookat
    return close


def _can_open() -> bool:
    try:
        need_display()
    except NoWindow as error:
        _headless(error)
        return False
    return True


def _headless(why: NoWindow) -> None:
    sys.stderr.write(f"wbc: no display for --view ({why}); running headless\n")
