"""CSV (RFC 4180): a row for each finding that the reports list, and for each error of
an input.

A spreadsheet takes a cell that begins with one of `=+-@` for a formula, whatever its quotes. A text
that begins so gets an apostrophe in front (OWASP, CSV Injection); numbers stay as they are. Texts
have no control characters: a table in a terminal is text, too.
"""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, Any

from satcheck.cli.output import harmless
from satcheck.report.verdict import is_failure

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from satcheck.cli.formats.registry import Reports
    from satcheck.report.report import Finding, Issue, Report

# Columns that are fields of a finding with one value.
_FIELDS = (
    "id",
    "a",
    "b",
    "relation",
    "exact_relation",
    "severity",
    "rule",
    "undecided",
    "quality",
    "thickness",
    "depth",
    "distance",
    "volume",
    "mtv_verified",
    "reason",
)
_ENDS = ("thickness_lower", "depth_lower", "mtv_x", "mtv_y", "mtv_z", "file_a", "file_b")
# Beside a baseline; and whether the check fails by the finding.
_VERDICT = ("baseline", "fails")
# The begin of a formula; in some countries also in full width.
_FORMULA = ("=", "+", "-", "@", *"\uff1d\uff0b\uff0d\uff20")
_COLUMNS = ("asset", *_FIELDS, *_ENDS, *_VERDICT)


def render(reports: Reports) -> Iterator[str]:
    yield lines([_COLUMNS])
    for name, report in reports.items():
        yield lines(_rows(name, report))


def lines(rows: Iterable[Iterable[Any]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\r\n").writerows(map(_cell, row) for row in rows)
    return text.getvalue()


def _rows(asset: str, report: Report) -> Iterator[list[Any]]:
    files = {body.id: body.file for body in report.bodies}
    for finding in report.findings:
        files_of_both = (files[finding.a], files[finding.b])
        verdict = (finding.baseline_state, is_failure(finding, report.settings.fail_on))
        yield [asset, *_values(finding), *files_of_both, *verdict]
    for issue in report.issues:
        if issue.severity == "error":
            yield _of_issue(asset, issue, files)


def _cell(value: Any) -> Any:
    if isinstance(value, bool):
        return str(value).lower()
    if not isinstance(value, str):
        return value
    text = harmless(value)
    return f"'{text}" if text.lstrip().startswith(_FORMULA) else text


def _of_issue(asset: str, issue: Issue, files: Mapping[str, str]) -> list[str | None]:
    """Its code is the id."""
    cells = {
        "asset": asset,
        "id": issue.code,
        "a": issue.body,
        "severity": issue.severity,
        "reason": issue.message,
        "file_a": issue.file or files.get(issue.body or ""),
    }
    return [cells.get(column) for column in _COLUMNS]


def _values(finding: Finding) -> list[Any]:
    """An empty cell is a value that is not known or does not apply."""
    bounds = (finding.thickness_bounds, finding.depth_bounds)
    return [
        *(getattr(finding, field) for field in _FIELDS),
        *(None if interval is None else interval[0] for interval in bounds),
        *(finding.mtv or (None, None, None)),
    ]
