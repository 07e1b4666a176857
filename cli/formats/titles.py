"""The names that people know beside ids that only programs know, such as those of IFC elements."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from msgspec.structs import replace

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
