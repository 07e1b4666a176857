"""Where scene files and robots state the bodies that a report has something to say about."""

from __future__ import annotations

from msgspec.structs import replace

from satcheck.report.bodies import Place
from satcheck.report.report import Report
from satcheck.scene import Scene
from satcheck.scene.table import Keys

_TOLD = ("error", "warning", "note")


def with_stated_places(report: Report, scene: Scene) -> Report:
    """scene: that the report is about."""
    told = {id_ for f in report.findings if f.severity in _TOLD for id_ in (f.a, f.b)}
    entries = {id_: scene.entries[id_] for id_ in told if id_ in scene.entries}
    if not entries:
        return report
    from satcheck.scene.scene_file.text import is_toml, lines_of

    wanted: dict[tuple[str, str], list[Keys]] = {}
    for entry in entries.values():
        if entry.number is not None:
            wanted.setdefault((entry.file, entry.text), []).append(("bodies", entry.number))
    lines = {
        (file, text): lines_of(text, keys, toml=is_toml(file))
        for (file, text), keys in wanted.items()
    }
    places = {}
    for id_, entry in entries.items():
        line = entry.line
        if entry.number is not None:
            line = lines[entry.file, entry.text]["bodies", entry.number]
        places[id_] = Place(entry.file, line) if line else None
    bodies = (
        replace(body, stated_at=places[body.id]) if body.id in places else body
        for body in report.bodies
    )
    return replace(report, bodies=tuple(bodies))
