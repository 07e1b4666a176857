"""The lines of a scene file or a robot that state bodies."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from satcheck.scene.bodies import Entry, Scene
from satcheck.scene.format.positions import Positions
from satcheck.scene.format.text import parse


class Line(NamedTuple):
    """file: as given. number: from 1."""

    file: str
    number: int


def entry_lines(scene: Scene, ids: Iterable[str]) -> dict[str, Line]:
    """Of those of these bodies that such a file states. Reads scene files again: raises
    SceneFileError."""
    entries = {id_: scene.entries[id_] for id_ in ids if id_ in scene.entries}
    scenes = dict.fromkeys(e.file for e in entries.values() if e.number is not None)
    positions = {file: parse(file, Path(file)).positions for file in scenes}
    return {id_: Line(e.file, _line(e, positions.get(e.file))) for id_, e in entries.items()}


def _line(entry: Entry, positions: Positions | None) -> int:
    if positions is None:
        assert entry.line is not None
        return entry.line
    return positions.line(("bodies", entry.number or 0))
