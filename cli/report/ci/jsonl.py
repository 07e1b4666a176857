"""JSON Lines: first a line with everything of the report but its findings, then a line for each
finding. `record` says which it is. Times are left out: the same input gives the same bytes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from msgspec import to_builtins

from satcheck.cli.report.json import line
from satcheck.report.report import without_timings

if TYPE_CHECKING:
    from satcheck.report.report import Report


def render(report: Report) -> str:
    values: dict[str, Any] = without_timings(to_builtins(report))
    findings = values.pop("findings")
    records = [{"record": "report", **values}]
    records += [{"record": "finding", **finding} for finding in findings]
    return "".join(map(line, records))
