"""Where scene files and robots state the bodies that a report has something to say about."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from msgspec.structs import replace

from satcheck.report.bodies import Place
from satcheck.report.report import Report
from satcheck.scene import Scene
from satcheck.scene.errors import Refused

_TOLD = ("error", "warning", "note")


def with_stated_places(report: Report, scene: Scene) -> Report:
    """scene: that the report is about. Scene files are read again: raises Refused where one
    is gone by now."""
    told = {id_ for f in report.findings if f.severity in _TOLD for id_ in (f.a, f.b)}
    entries = {id_: scene.entries[id_] for id_ in told if id_ in scene.entries}
    if not entries:
        return report
    numbers: dict[str, list[int]] = {}
    for entry in entries.values():
        if entry.number is not None:
            numbers.setdefault(entry.file, []).append(entry.number)
    lines = {file: _lines(file, of) for file, of in numbers.items()}
    places = {}
    for id_, entry in entries.items():
        line = entry.line if entry.number is None else lines[entry.file][entry.number]
        places[id_] = Place(entry.file, line) if line else None
    bodies = (
        replace(body, stated_at=places[body.id]) if body.id in places else body
        for body in report.bodies
    )
    return replace(report, bodies=tuple(bodies))


def _lines(path: str, numbers: Iterable[int]) -> dict[int, int]:
    """The lines of the bodies with these numbers in a scene file."""
    from satcheck.scene.scene_file.text import is_toml, lines_of, read_text

    keys = {number: ("bodies", number) for number in numbers}
    try:
        lines = lines_of(read_text(path, Path(path)), keys.values(), toml=is_toml(Path(path)))
        return {number: lines[of] for number, of in keys.items()}
    except (ValueError, LookupError):
        message = "the scene file has changed since it was read"
        raise Refused("bad-scene", message, file=path) from None
