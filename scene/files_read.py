"""The files that the answer to a check depends on.

Whatever opens an input, or asks whether it is there, notes it for callers that keep results of a
check; nothing depends on whether anybody listens. A child process cannot note for its parent: its
answer names what it has read.
"""

from __future__ import annotations

import hashlib
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from msgspec import Struct, field

# Of a file: what changes when its content does; the last two are times. None: nothing is there, or
# nobody may look.
Signature = tuple[int, ...] | None
# A file that changed this recently may change again within the grain of its times.
_GRAIN_NS = 2_000_000_000
_status = os.stat


class FilesRead(Struct, eq=False):
    """The files that a check has read or looked for, in that order.

    signatures: when they were noted. `folder/` stands for the names of the folders in it. digests:
    SHA-256, hex, of the bytes, if it was made as they were read. are_all: False: a process died
    that may have read others.
    """

    signatures: dict[str, Signature] = {}
    digests: dict[str, str] = {}
    are_all: bool = True
    began_ns: int = field(default_factory=time.time_ns)

    def __iter__(self) -> Iterator[str]:
        return iter(self.signatures)

    def are_certain(self) -> bool:
        """Whether these are all files, and none has changed since it was noted."""
        known = self.signatures.items()
        return self.are_all and all(signature(name) == at for name, at in known)

    def are_settled(self) -> bool:
        """Whether these are all files, and each change since they were noted will show in a
        signature."""
        return self.are_all and all(map(self.is_settled, self))

    def is_settled(self, name: str) -> bool:
        at = self.signatures[name]
        return at is None or max(at[-2:]) < self.began_ns - _GRAIN_NS

    def note_again(self) -> None:
        for name in self:
            note(name)
        for name, digest in self.digests.items():
            note_digest(name, digest)


_listening: list[FilesRead] = []


def note(location: str | Path) -> None:
    """location: of a file that the answer depends on, even if it is not there."""
    if not _listening:
        return
    name, known = os.fspath(location), _listening[0].signatures
    at = known[name] if name in known else signature(name)
    for listener in _listening:
        listener.signatures.setdefault(name, at)


def note_digest(location: str | os.PathLike[str], digest: str) -> None:
    for listener in _listening:
        listener.digests[str(location)] = digest


def note_bytes(location: str | os.PathLike[str], data: bytes) -> None:
    """data: the bytes of this file, as they were read."""
    if _listening:
        note_digest(location, hashlib.sha256(data).hexdigest())


def note_folders_in(folder: Path) -> None:
    """The answer depends on the names of the folders in this one."""
    note(f"{folder}/")


def note_lost_reader() -> None:
    """A process died that may have read files which nobody knows."""
    for listener in _listening:
        listener.are_all = False


@contextmanager
def files_read() -> Iterator[FilesRead]:
    """The files noted while it lasts."""
    files = FilesRead()
    _listening.append(files)
    try:
        yield files
    finally:
        _listening.remove(files)


def signature(name: str) -> Signature:
    try:
        status = _status(name)
    except (OSError, ValueError):
        return None
    return (
        status.st_dev,
        status.st_ino,
        status.st_mode,
        status.st_size,
        status.st_mtime_ns,
        status.st_ctime_ns,
    )
