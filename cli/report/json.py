"""The report as one JSON document: fixed key order, one form for every number, full precision."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from satcheck.cli._json import pieces, text

if TYPE_CHECKING:
    from satcheck.audit.report.report import Report


def render(report: Report, *, timings: bool) -> list[str]:
    """The document in pieces, final newline included; without timings the same bytes every time.

    Not as one text: the report of a scene can be larger than the scene in memory.
    """
    from satcheck.audit.report.report import TIME

    without = None if timings else TIME
    found = ["{"]
    for number, (key, value) in enumerate(report.members()):
        found.append(f"{',' if number else ''}\n  {text(key)}: ")
        found += pieces(value, 1, without)
    found.append("\n}\n")
    return found


def document(values: dict[str, Any]) -> str:
    """Any JSON values in that form, and a final newline."""
    return text(values) + "\n"
