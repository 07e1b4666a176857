"""Reads regular files only. Pipes, devices and folders are refused."""

from __future__ import annotations

import stat
from pathlib import Path
from typing import TypeVar

from satcheck.core.errors import SatcheckError
from satcheck.scene.files_read import note

STANDARD_INPUT = "-"
_ENDS = (b"\n", b"\r", b"}", b">")  # of a line, JSON, XML
E = TypeVar("E", bound=SatcheckError)

# Opening one of these may block, or reading it may never end.
_SPECIAL = (
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


def size_of(location: Path) -> int:
    """Size of a regular file in bytes. Raises SatcheckError, without a file name, for anything
    else."""
    if str(location) == STANDARD_INPUT:
        raise SatcheckError("not-a-file", "standard input is not read: give the path of a file")
    note(location)
    try:
        status = location.stat()
    except (FileNotFoundError, NotADirectoryError):
        raise SatcheckError("file-not-found", "no such file") from None
    except OSError as error:
        raise SatcheckError("unreadable-file", f"cannot be read: {error.strerror}") from None
    except ValueError as error:  # a path with a NUL character
        raise SatcheckError("unreadable-file", f"cannot be read: {error}") from None
    if stat.S_ISDIR(status.st_mode):
        raise SatcheckError("not-a-file", "is a directory, not a file")
    if not stat.S_ISREG(status.st_mode):
        kind = next((name for test, name in _SPECIAL if test(status.st_mode)), "a special file")
        raise SatcheckError("not-a-file", f"is {kind}, not a file: not read")
    return status.st_size


def read_whole(path: str, location: Path, most: int, kind: type[E]) -> bytes:
    """The bytes of a text file, without padding. Raises an error of this kind, with the path, if it
    is not a regular file, has more than `most` bytes, or cannot be read."""
    try:
        if size_of(location) > most:
            raise _too_large(most)
        with location.open("rb") as file:
            data = file.read(most + 1)  # a system file states no size
        if len(data) > most:
            raise _too_large(most)
        return without_padding(data)
    except SatcheckError as error:
        raise kind(error.code, error.message, file=path) from None
    except OSError as error:
        raise kind("unreadable-file", f"cannot be read: {error.strerror}", file=path) from None


def without_padding(data: bytes) -> bytes:
    """Return a text without the NUL bytes that some programs write after its last line; data that
    are no text as they are. NUL bytes within a line may stand where others were lost."""
    if not data.endswith(b"\0"):
        return data
    end = data.index(b"\0")
    is_text = data.endswith(_ENDS, 0, end) and data.count(b"\0", end) == len(data) - end
    return data[:end] if is_text else data


def _too_large(most: int) -> SatcheckError:
    return SatcheckError("too-large", f"larger than {most >> 20} MiB, the most for such a file")
