"""The results of the shards of a batch, merged into those of the whole batch."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from heapq import merge as merge_sorted
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import BinaryIO

import msgspec

from satcheck.audit.batch.options import World
from satcheck.audit.batch.results import PART, part_of, resolved
from satcheck.core.errors import SatcheckError
from satcheck.report.atomic_file import replace_file
from satcheck.report.json import read_line

# Files at a time: a process may have 256 of them open on macOS, and 1024 on Linux.
_MOST_OPEN = 128


class _Head(msgspec.Struct, frozen=True):
    files: World


class _Line(msgspec.Struct, frozen=True, order=True):
    """path: of the file that has it."""

    files: World
    text: bytes
    path: str


def merge(paths: Sequence[Path], out: Path) -> None:
    """Writes the results of all these files to one, whole or not at all. Raises what `merged`
    raises; OSError."""
    replace_file(out, merged(paths))


def merged(paths: Sequence[Path]) -> Iterator[bytes]:
    """The lines of finished files of results, in the order of the files of worlds: those of the
    whole batch, if these are its shards. Holds one line of each file in memory.

    Raises SatcheckError: `unreadable-file`, `bad-results`; `unfinished-results`, if a run has
    not finished a file; `results-differ`, if two files have different results of a world.
    """
    with ExitStack() as opened:
        while len(paths) > _MOST_OPEN:
            folder = Path(opened.enter_context(TemporaryDirectory()))
            paths = list(_fewer(paths, folder))
        yield from _merged(paths, opened)


def _fewer(paths: Sequence[Path], folder: Path) -> Iterator[Path]:
    """Each of the merged files has those of as many as may be open."""
    for begin in range(0, len(paths), _MOST_OPEN):
        some = folder / str(begin)
        merge(paths[begin : begin + _MOST_OPEN], some)
        yield some


def _merged(paths: Sequence[Path], opened: ExitStack) -> Iterator[bytes]:
    last: _Line | None = None
    for line in merge_sorted(*(_lines(path, _opened(path, opened)) for path in paths)):
        if last is not None and line.files == last.files:
            _refuse_other(line, last)
            continue
        last = line
        yield line.text


def _opened(path: Path, opened: ExitStack) -> BinaryIO:
    if path.suffix == PART or part_of(resolved(path)).exists():
        reason = "its run has not finished: satcheck batch --resume does so"
        raise SatcheckError("unfinished-results", reason, file=str(path))
    try:
        return opened.enter_context(path.open("rb"))
    except OSError as error:
        reason = f"cannot be read: {error.strerror}"
        raise SatcheckError("unreadable-file", reason, file=str(path)) from None


def _lines(path: Path, file: BinaryIO) -> Iterator[_Line]:
    last: World = ()
    for number, text in enumerate(file, 1):
        try:
            files = read_line(text, _Head).files
        except msgspec.DecodeError as error:
            reason = f"line {number}: no result of a batch: {error}"
            raise SatcheckError("bad-results", reason, file=str(path)) from None
        if files <= last or not text.endswith(b"\n"):
            reason = f"line {number} is not in order: the run that writes the file has not finished"
            raise SatcheckError("unfinished-results", reason, file=str(path))
        last = files
        yield _Line(files, text, str(path))


def _refuse_other(line: _Line, last: _Line) -> None:
    if line.text != last.text:
        reason = f"its result for {line.files[0]} is not that of {last.path}"
        raise SatcheckError("results-differ", reason, file=line.path)
