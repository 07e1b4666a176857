"""Where scene files and robots state the bodies that a report has something to say about."""

from __future__ import annotations

from msgspec.structs import replace

from satcheck.report.bodies import Place
from satcheck.report.report import Report
from satcheck.scene import Scene

_TOLD = ("error", "warning", "note")


def with_stated_places(report: Report, scene: Scene) -> Report:
    """scene: that the report is about. Raises SceneFileError where a scene file is gone by now."""
    told = {id_ for f in report.findings if f.severity in _TOLD for id_ in (f.a, f.b)}
    if told.isdisjoint(scene.entries):
        return report
    from satcheck.scene.entry_lines import entry_lines

    lines = entry_lines(scene, told)
    places = {id_: Place(line.file, line.number) for id_, line in lines.items()}
    bodies = (replace(body, stated_at=places.get(body.id)) for body in report.bodies)
    return replace(report, bodies=tuple(bodies))
