"""The lines of a scene file or a robot that state bodies."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from satcheck.scene.bodies import Entry, Scene
from satcheck.scene.errors import SceneFileError
from satcheck.scene.format.lines import Keys, lines_of
from satcheck.scene.format.text import is_toml, read_text


class Line(NamedTuple):
    """file: as given. number: from 1."""

    file: str
    number: int


def entry_lines(scene: Scene, ids: Iterable[str]) -> dict[str, Line]:
    """Return the lines of those of these bodies that such a file states. Reads scene files again:
    raises SceneFileError."""
    entries = {id_: scene.entries[id_] for id_ in ids if id_ in scene.entries}
    numbers: dict[str, list[int]] = {}
    for entry in entries.values():
        if entry.number is not None:
            numbers.setdefault(entry.file, []).append(entry.number)
    lines = {file: _lines(file, Path(file), of) for file, of in numbers.items()}
    return {id_: Line(e.file, _line(e, lines)) for id_, e in entries.items()}


def _line(entry: Entry, lines: Mapping[str, Mapping[int, int]]) -> int:
    if entry.number is not None:
        return lines[entry.file][entry.number]
    assert entry.line is not None
    return entry.line


def _lines(path: str, location: Path, numbers: Sequence[int]) -> dict[int, int]:
    """The lines of the bodies with these numbers. path: for messages."""
    keys: list[Keys] = [("bodies", number) for number in numbers]
    try:
        lines = lines_of(read_text(path, location), keys, toml=is_toml(location))
        return {number: lines[of] for number, of in zip(numbers, keys, strict=True)}
    except (ValueError, LookupError):
        message = "the scene file has changed since it was read"
        raise SceneFileError("bad-scene", message, file=path) from None
