"""Which files are read or looked for, for callers that keep results of a check.

Whatever opens an input, or asks whether it is there, notes it here; nothing depends on whether
anybody listens. A child process cannot note for its parent: its answer names what it has read.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

# Of a file: what changes when its content does; the last two are times. None: nothing is there, or
# nobody may look.
Signature = tuple[int, ...] | None
# A file that changed this recently may change again within the grain of its times.
_GRAIN_NS = 2_000_000_000
_status = os.stat


class FilesRead:
    """The files that a check has read or looked for, in that order. `folder/` stands for the names
    of the folders in it."""

    def __init__(self) -> None:
        self._signatures: dict[str, Signature] = {}
        self._lost = False
        self._began_ns = time.time_ns()

    def __iter__(self) -> Iterator[str]:
        return iter(self._signatures)

    def signature(self, name: str) -> Signature:
        """When it was noted."""
        return self._signatures[name]

    def add(self, name: str) -> None:
        if name not in self._signatures:
            self._signatures[name] = signature(name)

    def lose(self) -> None:
        self._lost = True

    def are_certain(self) -> bool:
        """Whether these are all files, and none has changed since it was noted."""
        known = self._signatures.items()
        return not self._lost and all(signature(name) == at for name, at in known)

    def are_settled(self) -> bool:
        """Whether they are certain, and each later change will show in a signature."""
        return all(map(self.is_settled, self)) and self.are_certain()

    def is_settled(self, name: str) -> bool:
        at = self._signatures[name]
        return at is None or max(at[-2:]) < self._began_ns - _GRAIN_NS

    def note_again(self) -> None:
        for name in self:
            note(name)


_listening: list[FilesRead] = []


def note(location: str | Path) -> None:
    """location: of a file that the answer depends on, even if it is not there."""
    for listener in _listening:
        listener.add(str(location))


def note_folders_in(folder: Path) -> None:
    """The answer depends on the names of the folders in this one."""
    note(f"{folder}/")


def note_lost_reader() -> None:
    """A process died that may have read files which nobody knows."""
    for listener in _listening:
        listener.lose()


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
