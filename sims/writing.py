"""Files that are there whole or not at all: written beside their place, moved there."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import final

from wbc.errors import InputError, WbcError

__all__ = ["NotWritten", "beside", "check_folder", "place", "write"]


@final
class NotWritten(WbcError, OSError):
    """A file cannot be written, such as on a full disk."""


def write(path: str | Path, content: bytes | str) -> None:
    """Write a file; what stood there before stays if that fails.

    Args:
        path: of the file; its folder must exist.
        content: of the file, text as UTF-8.

    Raises:
        NotWritten: no room, no right to, or no such folder.
    """
    path = Path(path)
    data = content.encode("utf-8") if isinstance(content, str) else content
    try:
        _write(path, data)
    except OSError as error:
        raise NotWritten(f"{path}: {error.strerror or error}.") from error


def _write(path: Path, data: bytes) -> None:
    draft = beside(path)
    try:
        draft.write_bytes(data)
        place(draft, path)
    finally:
        draft.unlink(missing_ok=True)


def beside(path: Path) -> Path:
    """A new empty file, hidden, in the folder of `path` and with its ending.

    Raises:
        OSError: none can be made.
    """
    handle, name = tempfile.mkstemp(
        dir=path.parent, prefix=f".{path.stem}-", suffix=path.suffix
    )
    os.close(handle)
    return Path(name)


def place(draft: Path, path: Path) -> None:
    """Move a file to its place, with the rights of any written file.

    `tempfile.mkstemp` withholds these.

    Raises:
        OSError: it cannot be moved.
    """
    mask = os.umask(0)
    os.umask(mask)
    draft.chmod(0o666 & ~mask)
    draft.replace(path)


def check_folder(folder: Path, option: str) -> None:
    """See that files can be written to a folder that exists.

    Args:
        folder: the folder.
        option: of the command line that asked for it, with what it was given.

    Raises:
        InputError: it is read-only.
    """
    try:
        with tempfile.NamedTemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise InputError(f"{option}: {error.strerror or error}.") from error
