"""The report as one JSON document: fixed key order, one form for every number, full precision."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from satcheck.cli._json import text

if TYPE_CHECKING:
    from satcheck.audit.report.report import Report


def render(report: Report, *, timings: bool) -> list[str]:
    """The document in pieces, final newline included; without timings the same bytes every time.

    Not as one text: the report of a scene can be larger than the scene in memory.
    """
    from satcheck.audit.report.report import TIME

    without = None if timings else TIME
    pieces = ["{"]
    for number, (key, value) in enumerate(report.members()):
        pieces.append(f"{',' if number else ''}\n  {text(key)}: ")
        if isinstance(value, tuple) and value:
            pieces += _list_pieces(value, without)
        else:
            pieces.append(text(value, 1, without))
    pieces.append("\n}\n")
    return pieces


def _list_pieces(members: tuple[Any, ...], without: str | None) -> Iterator[str]:
    """Of a list at the top, objects all."""
    for number, member in enumerate(members):
        yield f"{',' if number else '['}\n    {text(member, 2, without)}"
    yield "\n  ]"


def document(values: dict[str, Any]) -> str:
    """Any JSON values in that form, and a final newline."""
    return text(values) + "\n"
