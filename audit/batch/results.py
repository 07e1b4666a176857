"""The file of the results of a batch: JSON Lines, kept so that no death of a process loses what is
done."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from io import FileIO
from os import SEEK_END, fsync
from pathlib import Path
from typing import BinaryIO, NamedTuple, Self

import msgspec
from filelock import FileLock, Timeout

from satcheck.audit.batch.options import World
from satcheck.core.errors import SatcheckError
from satcheck.report.assets import AssetVerdict, InputFile
from satcheck.report.atomic_file import replace_file
from satcheck.report.json import read_line

# What the name of the file of an unfinished run ends with.
PART = ".part"
_BLOCK_BYTES = 1 << 16


class Head(msgspec.Struct, frozen=True):
    """`report.assets.Result` without the report."""

    files: World
    key: str | None
    verdict: AssetVerdict
    inputs: tuple[InputFile, ...]


class _Line(NamedTuple):
    """Where a result lies, in bytes."""

    file: FileIO
    begin: int
    end: int


class ResultsFile:
    """`path` has the results of a finished batch, and nothing else: whoever finds it finds all of
    them. A run appends to a second file, `part`, as results come; `finish` makes of both one file
    in the order of the files of worlds, so that a finished batch has the same bytes, whatever
    the order in which its results came. A lock keeps other runs out.

    Use it in a `with` statement. Raises SatcheckError: `results-in-use`, `bad-results`,
    `cannot-write`.
    """

    def __init__(self, path: Path, *, stays: bool = True) -> None:
        """stays: it is for a later run, too, and has to outlive a failure of the machine."""
        self.path = resolved(path)
        self.part = part_of(self.path)
        self._stays = stays
        self._lock = FileLock(f"{self.path}.lock")
        self._lines: dict[World, _Line] = {}
        self._end = 0
        self._open: list[FileIO] = []

    def __enter__(self) -> Self:
        if self.path.exists() and not self.path.is_file():  # a device may be read without end
            raise self._error("cannot-write", "is not a regular file: name one for the results")
        try:
            self._lock.acquire(timeout=0)
        except Timeout:
            raise self._error("results-in-use", "another run is writing it") from None
        except OSError as error:
            raise self._cannot_write(error) from None
        try:
            self.part.touch()
            self._added = self._opened(self.part, "r+")
        except OSError as error:
            self._unlock()
            raise self._cannot_write(error) from None
        return self

    def __exit__(self, *_: object) -> None:
        empty = self._added.seek(0, SEEK_END) == 0
        for file in self._open:
            file.close()
        if empty:
            self.part.unlink(missing_ok=True)
        self._unlock()

    def existing(self) -> Path | None:
        """A file with results of an earlier run."""
        return next((each for each in (self.path, self.part) if _has_bytes(each)), None)

    def keep(self, valid: Callable[[Head], bool]) -> Iterator[Head]:
        """The results of earlier runs that are valid; the others are forgotten. Of a last line that
        is not complete, as a killed run leaves it, nothing stays."""
        if self.path.exists():
            yield from self._kept(self._opened(self.path, "r"), self.path, valid)
        yield from self._kept(self._added, self.part, valid)
        self._cut()

    def _kept(self, file: FileIO, path: Path, valid: Callable[[Head], bool]) -> Iterator[Head]:
        with path.open("rb") as text:
            for begin, line in complete_lines(text, path.stat().st_size):
                try:
                    head = read_line(line, Head)
                except msgspec.DecodeError as error:
                    reason = f"byte {begin}: no result of a batch: {error}"
                    raise SatcheckError("bad-results", reason, file=str(path)) from None
                end = begin + len(line)
                if file is self._added:
                    self._end = end
                if valid(head):
                    self._lines[head.files] = _Line(file, begin, end)
                    yield head

    def append(self, results: Iterable[tuple[World, bytes]]) -> None:
        """Returns when the lines of these results are on the disk, if they are to stay. If that
        fails, the file ends with the line before them."""
        text = bytearray()
        added: dict[World, _Line] = {}
        for world, line in results:
            begin = self._end + len(text)
            added[world] = _Line(self._added, begin, begin + len(line))
            text += line
        try:
            self._added.seek(self._end)
            view = memoryview(text)
            while view:
                view = view[self._added.write(view) :]
            if self._stays:
                fsync(self._added.fileno())
        except OSError as error:
            self._cut()
            raise self._cannot_write(error) from None
        self._end += len(text)
        self._lines |= added

    def finish(self, worlds: Iterable[World] | None = None) -> None:
        """Puts the results of these worlds, in the order of their names, at the path. None: of all
        that have one."""
        try:
            replace_file(
                self.path, map(self._read, sorted(self._lines if worlds is None else worlds))
            )
            self._added.truncate(0)
        except OSError as error:
            raise self._cannot_write(error) from None

    def _read(self, world: World) -> bytes:
        line = self._lines[world]
        line.file.seek(line.begin)
        return line.file.read(line.end - line.begin)

    def _opened(self, path: Path, mode: str) -> FileIO:
        file = FileIO(path, mode)
        self._open.append(file)
        return file

    def _cut(self) -> None:
        with suppress(OSError):  # the next reader drops an incomplete line
            self._added.truncate(self._end)

    def _unlock(self) -> None:
        """The file of the lock goes before the lock: else it may be that of another run by then."""
        with suppress(OSError):
            Path(self._lock.lock_file).unlink()
        self._lock.release()

    def _error(self, code: str, reason: str) -> SatcheckError:
        return SatcheckError(code, reason, file=str(self.path))

    def _cannot_write(self, error: OSError) -> SatcheckError:
        return self._error("cannot-write", f"cannot be written: {error.strerror}")


def resolved(path: Path) -> Path:
    """The file that links lead to: it has one part and one lock, by whatever name it goes."""
    return Path(os.path.realpath(path)) if path.is_symlink() else path


def part_of(path: Path) -> Path:
    return Path(f"{path}{PART}")


def _has_bytes(path: Path) -> bool:
    return path.exists() and path.stat().st_size > 0


def complete_lines(file: BinaryIO, end: int) -> Iterator[tuple[int, bytes]]:
    """Yield the offset of each line before this end, and the line with its end. Others may read the
    file in between, and the run that writes it may cut it."""
    begin = 0
    while begin < end:
        file.seek(begin)
        lines = file.readlines(_BLOCK_BYTES)
        for line in lines:
            if begin >= end or not line.endswith(b"\n"):
                return
            yield begin, line
            begin += len(line)
        if not lines:
            return
