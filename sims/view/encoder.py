"""An MP4 file that any browser plays, written beside its place and moved there."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final, final

from sims.report.snapshot import Image
from sims.writing import beside, check_folder, place
from wbc.errors import InputError, WbcError

__all__ = ["RATE", "Encoder", "NoVideo", "check_path"]

RATE: Final = 30
"""Frames a second."""
CODEC: Final = "libx264"
OPTIONS: Final = {"preset": "veryfast", "crf": "23"}
BT709: Final = 1
"""What players take colours for at this size, as the standard's tables number it."""


@final
class NoVideo(WbcError, RuntimeError):
    """No video can be written here."""


def check_path(path: str | Path) -> Path:
    """A place where a video can be written.

    Raises:
        InputError: no .mp4, a folder that does not exist, or one that is read-only.
        NoVideo: the package that encodes is not installed.
    """
    film = Path(path)
    if film.suffix.lower() != ".mp4":
        raise InputError(f"--video {path}: must end in .mp4, the only format written.")
    if not film.parent.is_dir():
        raise InputError(f"--video {path}: there is no folder '{film.parent}'.")
    if film.is_dir():
        raise InputError(f"--video {path}: is a folder.")
    _codec()
    check_folder(film.parent, f"--video {path}")
    return film


def _codec() -> Any:
    """The package that encodes.

    Raises:
        NoVideo: it is not installed, or without H.264.
    """
    try:
        import av
    except ImportError as error:
        raise NoVideo(
            f"--video needs the package 'av' ({error}): pip install 'wbc[video]'."
        ) from error
    if CODEC not in av.codecs_available:
        raise NoVideo(
            f"the installed package 'av' cannot write H.264 ({CODEC}): take its wheel, "
            "pip install --force-reinstall 'wbc[video]'."
        )
    return av


@final
class Encoder:
    """Writes pictures of one size as H.264, 30 a second.

    Args:
        path: of the file, which appears when it is finished.
        width: of every picture; even.
        height: likewise.

    Raises:
        InputError, NoVideo: as `check_path`.

    Attributes:
        count: pictures so far.
    """

    def __init__(self, path: str | Path, width: int, height: int) -> None:
        self.path, self.count = check_path(path), 0
        self._av = _codec()
        self._beside = beside(self.path)
        self._file = self._av.open(
            str(self._beside), "w", format="mp4", options={"movflags": "+faststart"}
        )
        self._stream = self._file.add_stream(CODEC, rate=RATE, options=OPTIONS)
        self._stream.width, self._stream.height = width, height
        self._stream.pix_fmt = "yuv420p"
        context = self._stream.codec_context
        context.colorspace = context.color_primaries = context.color_trc = BT709

    def add(self, picture: Image) -> None:
        """Append a picture (height, width, 3).

        Raises:
            NoVideo: it cannot be written, such as on a full disk.
        """
        frame = self._av.VideoFrame.from_ndarray(picture, format="rgb24")
        even = frame.reformat(format="yuv420p", dst_colorspace="ITU709")
        even.pts = self.count
        self.count += 1
        self._write(even)

    def _write(self, frame: Any) -> None:
        try:
            self._file.mux(self._stream.encode(frame))
        except self._av.FFmpegError as error:
            raise NoVideo(f"--video {self.path}: {error}") from error

    def finish(self) -> None:
        """Close the file and move it to its place; nothing to move without pictures.

        Raises:
            NoVideo: it cannot be written.
        """
        try:
            if self.count:
                self._write(None)
            self._close()
            if self.count:
                place(self._beside, self.path)
        finally:
            self._beside.unlink(missing_ok=True)

    def _close(self) -> None:
        try:
            self._file.close()
        except self._av.FFmpegError as error:
            raise NoVideo(f"--video {self.path}: {error}") from error

    def abandon(self) -> None:
        """Leave nothing behind."""
        try:
            self._file.close()
        except self._av.FFmpegError:
            pass  # what is lost is not wanted any more
        finally:
            self._beside.unlink(missing_ok=True)
