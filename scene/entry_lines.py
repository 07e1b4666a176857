"""The lines of a scene file or a robot that state bodies."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from satcheck.scene.bodies import Entry, Scene
from satcheck.scene.errors import SceneFileError
from satcheck.scene.format.item_lines import item_lines
from satcheck.scene.format.text import is_toml, parsed, read_text

_HEADER = re.compile(r"\s*\[\[\s*bodies\s*\]\]")
# Strings of several lines, which may hold what looks like a header.
_NOT_PLAIN_TOML = ('"""', "'''")


class Line(NamedTuple):
    """file: as given. number: from 1."""

    file: str
    number: int


def entry_lines(scene: Scene, ids: Iterable[str]) -> dict[str, Line]:
    """Of those of these bodies that such a file states. Reads scene files again: raises
    SceneFileError."""
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
    text = read_text(path, location)
    if is_toml(location):
        return _toml_lines(path, location, text, numbers)
    try:
        lines = list(item_lines(text, "bodies"))
        return {number: lines[number] for number in numbers}
    except (ValueError, IndexError):
        message = "the scene file has changed since it was read"
        raise SceneFileError("bad-scene", message, file=path) from None


def _toml_lines(path: str, location: Path, text: str, numbers: Sequence[int]) -> dict[int, int]:
    """A text whose every body has a header of its own, as most have, needs no syntax tree."""
    if not any(mark in text for mark in _NOT_PLAIN_TOML):
        headers = [number for number, line in enumerate(text.split("\n"), 1) if _HEADER.match(line)]
        if max(numbers) < len(headers):
            return {number: headers[number] for number in numbers}
    positions = parsed(path, location, text).positions
    return {number: positions.line(("bodies", number)) for number in numbers}
