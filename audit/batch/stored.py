"""Results files, read back: those of several shards together, a result for each world."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack
from heapq import merge as merge_sorted
from itertools import groupby
from os import fstat
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal, NamedTuple, Self, TypeVar

import msgspec

from satcheck.audit.batch.check_world import unreadable_asset
from satcheck.audit.batch.options import World, name_of
from satcheck.audit.batch.results import PART, complete_lines, part_of, resolved
from satcheck.core.errors import SatcheckError
from satcheck.report.assets import Asset, AssetVerdict, InputFile, Result, worst_verdict
from satcheck.report.atomic_file import replace_file
from satcheck.report.json import read_line
from satcheck.report.report import NOTHING_TO_CHECK, Issue

# The names of such files end so.
ENDINGS = (".jsonl", ".ndjson", PART)
BAD_RESULT = "bad-result"
UNFINISHED = "unfinished-results"
NO_RESULTS = "no-results"
MISSING = "missing-results"
DIFFERENT = "different-results"
INTERRUPTED = "interrupted"
# What an issue allows at best.
_VERDICTS: dict[str, AssetVerdict] = {
    BAD_RESULT: "error",
    UNFINISHED: "incomplete",
    NO_RESULTS: "incomplete",
    MISSING: "incomplete",
    DIFFERENT: "pass",
    INTERRUPTED: "incomplete",
    NOTHING_TO_CHECK: "incomplete",
}
_LAST_COUNTS = "; the last file counts"  # in a report; nothing is merged then
_NO_RESULTS = (
    "there is no result in these files: satcheck batch writes them with -o results.jsonl, "
    "and a check stores its report with -o report.json"
)
# Issues for which nothing is merged, and the codes of these errors.
_REFUSED = {BAD_RESULT: "bad-results", UNFINISHED: UNFINISHED, DIFFERENT: "results-differ"}
# Lines of a file that are named one by one.
_NAMED = 10
# Files that are merged at a time: a process may have 256 of them open on macOS, 1024 on Linux.
_MOST_OPEN = 128
_SURROGATE = b"\\ud"
_T = TypeVar("_T")


def least_of(issues: Iterable[Issue]) -> AssetVerdict:
    """Return the verdict that issues about a whole batch allow at best."""
    return worst_verdict(Counter(_VERDICTS.get(issue.code, "pass") for issue in issues))


class Stored(NamedTuple):
    """A result, read back. files: of the world. inputs: that the answer depends on."""

    files: World
    inputs: tuple[InputFile, ...]
    asset: Asset


class _Name(msgspec.Struct, frozen=True):
    """What says which result a line is."""

    files: World
    key: str | None


class _Line(NamedTuple):
    name: _Name
    text: bytes
    path: Path


class StoredResults:
    """The results in files, one for each world, sorted by the names of the files of the worlds.
    Each iteration reads the files again.

    The memory does not grow with a file that is sorted, as a finished batch leaves it; of another
    one, the places of its lines are kept. Of a batch that did not finish, its part is read. In one
    file the last result of a world counts. In several
    files the same key means the same answer; of different ones that of the last file counts.

    expected: worlds that need a result. issues: what is wrong with the files. Use it in a `with`
    statement. Raises SatcheckError: `unreadable-file`.
    """

    def __init__(self, paths: Sequence[Path], expected: Iterable[World] = ()) -> None:
        self._paths = paths
        self._expected = expected
        self._stack = ExitStack()
        self._count = 0
        self.issues: tuple[Issue, ...] = ()

    def __enter__(self) -> Self:
        with ExitStack() as stack:
            files = (each for path in self._paths for each in _files_of(path))
            self._files = [_File(path, stack) for path in files]
            self._stack = stack.pop_all()
        self.issues = (*(issue for file in self._files for issue in file.issues), *self._scan())
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def __len__(self) -> int:
        return self._count

    def __iter__(self) -> Iterator[Stored]:
        return map(_read, self._last())

    def lines(self) -> Iterator[bytes]:
        return (line.text for line in self._last())

    def _last(self) -> Iterator[_Line]:
        return (lines[-1] for lines in self._worlds())

    def _worlds(self) -> Iterator[list[_Line]]:
        """The lines of each world, in the order of the files."""
        lines = merge_sorted(*self._files, key=lambda line: line.name.files)
        for _, same in groupby(lines, key=lambda line: line.name.files):
            yield list(same)

    def _scan(self) -> Iterator[Issue]:
        different, first_different = 0, ""
        missing = dict.fromkeys(self._expected)
        for lines in self._worlds():
            self._count += 1
            missing.pop(lines[0].name.files, None)
            if _differ(lines):
                different += 1
                first_different = first_different or name_of(lines[0].name.files)
        if different:
            which = f"{first_different}{_more(different - 1)}"
            reason = f"{which}: different results in several files{_LAST_COUNTS}"
            yield Issue(DIFFERENT, "warning", None, None, reason)
        if missing:
            which = f"{name_of(next(iter(missing)))}{_more(len(missing) - 1)}"
            yield Issue(MISSING, "warning", None, None, f"{which}: no result in these files")
        if not self._count:
            yield Issue(NO_RESULTS, "warning", None, None, _NO_RESULTS)


class NewResults:
    """The results that a batch of this process has finished: nobody else has written them, so that
    one reading is enough. count: of them."""

    def __init__(self, path: Path, count: int) -> None:
        self._path = path
        self._count = count

    def __len__(self) -> int:
        return self._count

    def __iter__(self) -> Iterator[Stored]:
        with self._path.open("rb") as lines:
            for line in lines:
                yield _stored(read_line(line, Result))


def _stored(result: Result) -> Stored:
    asset = Asset(name_of(result.files), result.verdict, result.report)
    return Stored(result.files, result.inputs, asset)


def _files_of(path: Path) -> Iterator[Path]:
    """An unfinished run leaves a part beside the file of an earlier run, or in its place."""
    path = resolved(path)
    part = part_of(path)
    if path.exists() or not part.exists():
        yield path
    if part.exists():
        yield part


def _more(scenes: int) -> str:
    return f" and {scenes:,} more" if scenes else ""


class _File:
    """The complete lines of one file, in the order of their worlds. issues: about the file."""

    def __init__(self, path: Path, stack: ExitStack) -> None:
        self._path = path
        self._places: dict[World, int] | None = None
        try:
            self._file = stack.enter_context(path.open("rb"))
            self._end = fstat(self._file.fileno()).st_size  # a batch may still write
            self.issues = list(self._scan())
        except OSError as error:
            reason = f"cannot be read: {error.strerror}"
            raise SatcheckError("unreadable-file", reason, file=str(path)) from None

    def __iter__(self) -> Iterator[_Line]:
        lines: Iterator[bytes]
        if self._places is None:
            lines = (line for _, line in complete_lines(self._file, self._end))
        else:
            lines = map(self._line_at, self._places.values())
        named = ((_name(line), line) for line in lines)
        return (_Line(name, line, self._path) for name, line in named if name is not None)

    def _line_at(self, place: int) -> bytes:
        self._file.seek(place)
        return self._file.readline()

    def _scan(self) -> Iterator[Issue]:
        """Find what is wrong, and the last place of each world if the lines are not sorted, as a
        finished batch leaves them."""
        bad, is_sorted, last, end = 0, True, None, 0
        for number, (begin, line) in enumerate(complete_lines(self._file, self._end), 1):
            end, name = begin + len(line), _name(line)
            if name is None:
                bad += 1
                if bad <= _NAMED:
                    yield self._issue(BAD_RESULT, "no result of a batch", number)
                continue
            is_sorted &= last is None or last < name.files
            last = name.files
        if bad > _NAMED:
            yield self._issue(BAD_RESULT, f"{bad - _NAMED:,} more lines are no results")
        if not is_sorted:
            named = ((_name(line), at) for at, line in complete_lines(self._file, self._end))
            self._places = {name.files: at for name, at in named if name is not None}
            self._places = dict(sorted(self._places.items()))
        signs = {
            "it is a part": self._path.suffix == PART,
            "its last line is cut off": end < self._end,
            "its lines are not sorted": not is_sorted,
        }
        if any(signs.values()):
            why = ", ".join(sign for sign, is_there in signs.items() if is_there)
            reason = f"the batch did not finish, so scenes may be missing ({why})"
            yield self._issue(UNFINISHED, reason)

    def _issue(self, code: str, reason: str, line: int | None = None) -> Issue:
        severity: Literal["error", "warning"] = "error" if code == BAD_RESULT else "warning"
        place = f"{self._path}" if line is None else f"{self._path}:{line}"
        return Issue(code, severity, None, str(self._path), f"{place}: {reason}", line)


def _differ(lines: list[_Line]) -> bool:
    """Without a key nothing says that two results are the same."""
    keys = {line.name.key for line in lines}
    return len(keys) > 1 or (None in keys and len({line.text for line in lines}) > 1)


def _name(line: bytes) -> _Name | None:
    try:
        name = _decoded(line, _Name)
    except msgspec.MsgspecError:
        return None
    return name if name.files else None


def _decoded(line: bytes, kind: type[_T]) -> _T:
    """Raises msgspec.MsgspecError."""
    try:
        if _SURROGATE in line:  # it may stand for no byte of a file name
            json.dumps(json.loads(line), ensure_ascii=False).encode(errors="surrogateescape")
        return read_line(line, kind)
    except (ValueError, RecursionError) as error:
        raise msgspec.DecodeError(str(error)) from None


def _read(line: _Line) -> Stored:
    name = name_of(line.name.files)
    try:
        result = _decoded(line.text, Result)
        _require_bodies(result)
    except msgspec.MsgspecError as error:
        reason = f"{line.path}: no result of this version of satcheck: {error}"
        asset = unreadable_asset(name, SatcheckError(BAD_RESULT, reason, file=name))
        return Stored(line.name.files, (), asset)
    return _stored(result)


def _require_bodies(result: Result) -> None:
    known = {body.id for body in result.report.bodies}
    for finding in result.report.findings:
        if not {finding.a, finding.b} <= known:
            raise msgspec.ValidationError(f"no body is {finding.a}, or {finding.b}")


def merge(paths: Sequence[Path], out: Path) -> None:
    """Write the results of finished files to one, whole or not at all: those of the whole batch, if
    these are its shards. Holds one line of each file in memory.

    Raises SatcheckError: `unreadable-file`, `bad-results`; `unfinished-results`, if a run has not
    finished a file; `results-differ`, if two files have different results of a world. OSError.
    """
    with TemporaryDirectory() as folder:
        while len(paths) > _MOST_OPEN:
            groups = [paths[k : k + _MOST_OPEN] for k in range(0, len(paths), _MOST_OPEN)]
            paths = [Path(folder) / f"{len(groups)}-{k}" for k in range(len(groups))]
            for some, path in zip(groups, paths, strict=True):
                merge(some, path)
        with StoredResults(paths) as results:
            for issue in results.issues:
                if issue.code in _REFUSED:
                    reason = issue.message.removesuffix(_LAST_COUNTS)
                    raise SatcheckError(_REFUSED[issue.code], reason)
            replace_file(out, results.lines())
