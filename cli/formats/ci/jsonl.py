"""JSON Lines: for each report a line with everything but its findings, then a line for each
finding. `record` says which it is. Times are left out: the same input gives the same bytes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from msgspec import to_builtins

from satcheck.report.json import line
from satcheck.report.report import without_timings

if TYPE_CHECKING:
    from collections.abc import Iterator

    from satcheck.cli.formats.registry import Reports


def render(reports: Reports) -> Iterator[str]:
    return map(line, _records(reports))


def _records(reports: Reports) -> Iterator[dict[str, Any]]:
    for name, report in reports.items():
        values: dict[str, Any] = without_timings(to_builtins(report))
        findings = values.pop("findings")
        yield {"record": "report", "asset": name, **values}
        for finding in findings:
            yield {"record": "finding", "asset": name, **finding}
