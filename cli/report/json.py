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
    pieces = ["{"]
    for number, (key, value) in enumerate(report.members(timings)):
        pieces.append(f"{',' if number else ''}\n  {text(key)}: ")
        if isinstance(value, Iterator):
            pieces += _list_pieces(value)
        else:
            pieces.append(text(value, 1))
    pieces.append("\n}\n")
    return pieces


def _list_pieces(members: Iterator[Any]) -> Iterator[str]:
    """Of a list at the top, objects all."""
    number = -1
    for number, member in enumerate(members):
        yield f"{',' if number else '['}\n    {text(member, 2)}"
    yield "[]" if number < 0 else "\n  ]"


def document(values: dict[str, Any]) -> str:
    """Any JSON values in that form, and a final newline."""
    return text(values) + "\n"
