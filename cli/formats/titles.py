"""Names in lines of text: those that people know beside ids that only programs know, as those of
IFC elements, and none with a line break, which would begin a line that looks like ours."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from satcheck.cli.output import harmless

if TYPE_CHECKING:
    from satcheck.report.report import Report


def with_titles(report: Report) -> Report:
    """The report with `name (id)` for the id of each node of a file whose name is not its id, for
    reading only."""
    shown = {
        body.id: f"{body.name} ({body.id})"
        for body in report.bodies
        if body.path is not None and body.name != body.id
    }
    if not shown:
        return report
    return replace(
        report,
        bodies=tuple(replace(body, id=shown.get(body.id, body.id)) for body in report.bodies),
        findings=tuple(
            replace(f, a=shown.get(f.a, f.a), b=shown.get(f.b, f.b)) for f in report.findings
        ),
        issues=tuple(replace(i, body=_of(shown, i.body)) for i in report.issues),
        motions=tuple(
            replace(motion, bodies=tuple(shown.get(body, body) for body in motion.bodies))
            for motion in report.motions
        ),
    )


def _of(shown: Mapping[str, str], body: str | None) -> str | None:
    return None if body is None else shown.get(body, body)


def in_one_line_each(report: Report) -> Report:
    """The report with texts that a terminal can show."""
    names = ((body.id, body.name, body.file, body.path or "") for body in report.bodies)
    if all(name.isprintable() for each in names for name in each):
        return report
    from msgspec import convert, to_builtins

    return convert(_shown(to_builtins(report)), type(report))


def _shown(value: Any) -> Any:
    if isinstance(value, str):
        return harmless(value)
    if isinstance(value, dict):
        return {key: _shown(member) for key, member in value.items()}
    return [_shown(member) for member in value] if isinstance(value, list | tuple) else value
