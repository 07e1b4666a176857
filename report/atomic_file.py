"""Write a file as a whole: a reader finds the old content or the new, never half of it.

The new content goes to a file beside the old one, down to the disk, and takes its name at the end.
When the disk is full, or the run is interrupted, the old file is still what it was.
"""

from __future__ import annotations

import contextlib
import errno
import os
import stat
from collections.abc import Iterable
from pathlib import Path

# Paths below these lead to what is already open: terminals, pipes, the files of a redirection.
_OPEN_ALREADY = ("/dev/", "/proc/")
_MOST_LINKS = 40
# Errors of file systems that cannot flush a file to the disk on request.
_NO_SYNC = (errno.EINVAL, errno.ENOTSUP, errno.ENOSYS)


def replace_file(path: Path, pieces: Iterable[bytes]) -> None:
    """Raises OSError; what was at the path is then still there.

    A symbolic link stays, and the file that it leads to is replaced; one that leads out of the
    folder is refused. The file keeps its permissions, and its owner where the system allows that.
    What is no regular file is written to as it is, and so is a file in a folder that takes no new
    one.
    """
    target = last_link(path)
    folder = path.absolute().parent.resolve()
    is_link = target != path.absolute() and not str(target).startswith(_OPEN_ALREADY)
    if is_link and not target.resolve().is_relative_to(folder):
        raise PermissionError(errno.EACCES, f"the link leads out of its folder, to {target}")
    known = _known(target)
    if known is not None and not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    if str(target).startswith(_OPEN_ALREADY) or (known and not stat.S_ISREG(known.st_mode)):
        _write_in_place(target, pieces)
        return
    beside = target.with_name(f".satcheck-{os.urandom(6).hex()}")
    try:
        descriptor = os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_EXCL | _BINARY, 0o666)
    except PermissionError:
        if known is None:
            raise
        _write_in_place(target, pieces)
        return
    try:
        with os.fdopen(descriptor, "wb") as stream:
            stream.writelines(pieces)
            stream.flush()
            _to_disk(stream.fileno())
        if known is not None:
            _adopt(beside, known)
        beside.replace(target)
    except BaseException:
        with contextlib.suppress(OSError):
            beside.unlink()
        raise


_BINARY = getattr(os, "O_BINARY", 0)  # of Windows


def last_link(path: Path) -> Path:
    """Where symbolic links lead, up to the first that leads to what is already open."""
    for _ in range(_MOST_LINKS):
        path = path.absolute()
        if str(path).startswith(_OPEN_ALREADY) or not path.is_symlink():
            return path
        path = path.parent / path.readlink()
    raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))


def _known(path: Path) -> os.stat_result | None:
    try:
        return path.stat()
    except FileNotFoundError:
        return None


def _write_in_place(path: Path, pieces: Iterable[bytes]) -> None:
    number = _descriptor(str(path))
    # Opening the file of a redirection again by its name would truncate it.
    with path.open("wb") if number is None else os.fdopen(os.dup(number), "wb") as stream:
        stream.writelines(pieces)


def _descriptor(path: str) -> int | None:
    """The number of the descriptor that the path names."""
    named = {"/dev/stdout": 1, "/dev/stderr": 2}
    folder, _, number = path.rpartition("/")
    if folder in ("/dev/fd", "/proc/self/fd") and number.isdecimal():
        return int(number)
    return named.get(path)


def _to_disk(descriptor: int) -> None:
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in _NO_SYNC:
            raise


def _adopt(path: Path, known: os.stat_result) -> None:
    """Owner and permissions, in that order: a change of owner clears some of these."""
    made = path.stat()
    if (made.st_uid, made.st_gid) != (known.st_uid, known.st_gid) and hasattr(os, "chown"):
        with contextlib.suppress(PermissionError):
            os.chown(path, known.st_uid, known.st_gid)
    path.chmod(stat.S_IMODE(known.st_mode))
