"""The file of the results of a batch: JSON Lines, kept so that no death of a process loses what is
done."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from io import FileIO
from os import fsync
from pathlib import Path
from typing import NamedTuple, Self

import msgspec
from filelock import FileLock, Timeout

from satcheck.batch.check_options import World
from satcheck.core.errors import SatcheckError
from satcheck.report.assets import AssetVerdict
from satcheck.report.atomic_file import replace_file
from satcheck.report.batch import InputFile


class Head(msgspec.Struct, frozen=True):
    """`report.batch.Result` without the report."""

    files: World
    key: str | None
    verdict: AssetVerdict
    inputs: tuple[InputFile, ...]


class _Line(NamedTuple):
    """Where a result lies in the file, in bytes."""

    begin: int
    end: int


class ResultsFile:
    """Results are appended as they come. `finish` sorts them by the files of their worlds, so that
    a finished batch has the same bytes, whatever the order in which its results came. A lock keeps
    other runs out.

    Use it in a `with` statement. Raises SatcheckError: `results-in-use`, `bad-results`,
    `cannot-write`.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._lock = FileLock(f"{path}.lock")
        self._lines: dict[World, _Line] = {}
        self._end = 0

    def __enter__(self) -> Self:
        try:
            self._lock.acquire(timeout=0)
        except Timeout:
            raise self._error("results-in-use", "another run is writing it") from None
        except OSError as error:
            raise self._cannot_write(error) from None
        try:
            self._path.touch()
            self._file = FileIO(self._path, "r+")
        except OSError as error:
            self._unlock()
            raise self._cannot_write(error) from None
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()
        self._unlock()

    def known(self) -> Iterator[Head]:
        """The results of an earlier run. Of a last line that is not complete, as a killed run
        leaves it, nothing stays."""
        for begin, line in _complete_lines(self._path):
            try:
                head = msgspec.json.decode(line, type=Head)
            except msgspec.DecodeError as error:
                reason = f"byte {begin}: no result of a batch: {error}"
                raise self._error("bad-results", reason) from None
            self._end = begin + len(line)
            self._lines[head.files] = _Line(begin, self._end)
            yield head
        self._cut()

    def is_empty(self) -> bool:
        return self._path.stat().st_size == 0

    def append(self, results: Iterable[tuple[World, bytes]]) -> None:
        """Returns when the lines of these results are on the disk. If that fails, the file ends
        with the line before them."""
        text = bytearray()
        added: dict[World, _Line] = {}
        for world, line in results:
            begin = self._end + len(text)
            added[world] = _Line(begin, begin + len(line))
            text += line
        try:
            self._file.seek(self._end)
            view = memoryview(text)
            while view:
                view = view[self._file.write(view) :]
            fsync(self._file.fileno())
        except OSError as error:
            self._cut()
            raise self._cannot_write(error) from None
        self._end += len(text)
        self._lines |= added

    def finish(self, worlds: Iterable[World]) -> None:
        """Keeps the results of these worlds, in the order of their names."""
        try:
            replace_file(self._path, map(self._read, sorted(worlds)))
        except OSError as error:
            raise self._cannot_write(error) from None

    def _read(self, world: World) -> bytes:
        line = self._lines[world]
        self._file.seek(line.begin)
        return self._file.read(line.end - line.begin)

    def _cut(self) -> None:
        with suppress(OSError):  # the next reader drops an incomplete line
            self._file.truncate(self._end)

    def _unlock(self) -> None:
        self._lock.release()
        with suppress(OSError):
            Path(self._lock.lock_file).unlink()

    def _error(self, code: str, reason: str) -> SatcheckError:
        return SatcheckError(code, reason, file=str(self._path))

    def _cannot_write(self, error: OSError) -> SatcheckError:
        return self._error("cannot-write", f"cannot be written: {error.strerror}")


def _complete_lines(path: Path) -> Iterator[tuple[int, bytes]]:
    """(offset, line) of each line that ends."""
    begin = 0
    with path.open("rb") as file:
        for line in file:
            if line.endswith(b"\n"):
                yield begin, line
            begin += len(line)
