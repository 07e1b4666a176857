"""Names with line breaks, for lines of text: each would begin a line that looks like ours."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from satcheck.cli.output import harmless

if TYPE_CHECKING:
    from satcheck.report.report import Report


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
