"""CSV (RFC 4180) for spreadsheets: a row for each finding that the reports list, for each wrong or
open answer about a body, and for what lets nothing pass, the worst first. Left out are columns that
would be empty and, unless a report has one pair only, separated pairs whose gap was not asked for.

A spreadsheet takes a cell that begins with one of `=+-@` for a formula, whatever its quotes. A text
that begins so gets an apostrophe in front (OWASP, CSV Injection); numbers stay as they are. Texts
have no control characters: a table in a terminal is text, too. A byte order mark says that the text
is UTF-8, which spreadsheets do not guess.
"""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, Any

from satcheck.audit.messages import answer_message
from satcheck.audit.words import rank
from satcheck.cli.formats.ci.problems import stops_pass
from satcheck.cli.formats.summary import summary_line
from satcheck.cli.output import harmless
from satcheck.report.rows import row_of
from satcheck.report.verdict import is_unmet
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from satcheck.cli.formats.registry import Reports
    from satcheck.report.report import Report

_BYTE_ORDER_MARK = "\ufeff"
_DIGITS = 6
_LENGTHS = (
    *("thickness", "thickness_lower", "depth", "depth_lower", "distance", "distance_lower"),
    *("mtv_x", "mtv_y", "mtv_z"),
)
_POINT = ("impact_x", "impact_y", "impact_z")
_TIME = ("impact_time", "impact_time_lower", "impact_pose_before", "impact_pose_after")
# In every file, also if they are empty.
_ALWAYS = ("a", "b", "relation", "severity", "fails")
_COLUMNS = (
    *("asset", *_ALWAYS, "undecided", *_LENGTHS, "mtv_verified", "volume"),
    *(*_TIME, *_POINT, "placed_relation", "exact_relation"),
    *("quality", "rule", "baseline", "reason", "units", "id", "file_a", "file_b"),
)
# The begin of a formula; in some countries also in full width.
_FORMULA = ("=", "+", "-", "@", *"\uff1d\uff0b\uff0d\uff20")


def render(reports: Reports) -> Iterator[str]:
    """Units are in the header, or, if they differ, in a column."""
    rows: list[tuple[tuple[float, ...], Mapping[str, Any]]] = []
    units = set()
    for name, report in reports.items():
        unit = unit_of(report.units)
        units.add(unit)
        beside = {"asset": name, "units": unit}
        rows += ((key, beside | cells) for key, cells in _rows(report))
    rows.sort(key=lambda row: row[0])
    alike = units.pop() if len(units) == 1 else None
    left_out = {"asset" if len(reports) == 1 else "", "units" if alike else ""}
    columns = [
        column
        for column in _COLUMNS
        if column not in left_out
        and (column in _ALWAYS or any(cells.get(column) is not None for _, cells in rows))
    ]
    yield _BYTE_ORDER_MARK + _line(_with_unit(column, alike) for column in columns)
    for _, cells in rows:
        yield _line(_cell(cells.get(column)) for column in columns)


def _rows(report: Report) -> Iterator[tuple[tuple[float, ...], dict[str, Any]]]:
    """Yield what rows are sorted by, and their cells. The code of an issue is its id."""
    files = {body.id: body.file for body in report.bodies}
    for cells in _of_no_pair(report, files):
        yield (-1,), cells
    for finding in report.findings:
        has_answer = finding.distance is not None or finding.undecided is not None
        if finding.relation == "separated" and len(report.findings) > 1 and not has_answer:
            continue
        both = {"file_a": files[finding.a], "file_b": files[finding.b]}
        yield rank(finding, report.units), row_of(finding, report) | both


def _of_no_pair(report: Report, files: Mapping[str, str]) -> Iterator[dict[str, Any]]:
    """Yield the cells of what lets nothing pass, and of wrong or open answers about a body."""
    is_open = report.summary.verdict == "incomplete"
    for issue in filter(stops_pass, report.issues):
        is_open = False
        cells = {"id": issue.code, "a": issue.body, "severity": issue.severity}
        file = issue.file or files.get(issue.body or "")
        yield {**cells, "reason": issue.message, "file_a": file}
    for answer in report.answers:
        if answer.answer != "yes":
            yield {
                "id": answer.question,
                "a": answer.body,
                "severity": answer.severity,
                "fails": is_unmet(answer, report.settings.fail_on),
                "undecided": answer.question if answer.answer == "open" else None,
                "reason": answer_message(answer),
                "file_a": files[answer.body],
            }
    open_ = [each.answer == "open" for each in report.answers]
    open_ += [each.undecided is not None for each in report.findings]
    if is_open and not any(open_):
        yield {"severity": "warning", "reason": summary_line(report)}


def _with_unit(column: str, unit: str | None) -> str:
    """`depth [mm]`"""
    if unit is None or column not in (*_LENGTHS, *_POINT, "volume"):
        return column
    return f"{column} [{unit}{'^3' if column == 'volume' else ''}]"


def _line(cells: Iterable[Any]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\r\n").writerow(cells)
    return text.getvalue()


def _cell(value: Any) -> Any:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value + 0.0:.{_DIGITS}g}"
    if not isinstance(value, str):
        return value
    text = harmless(value)
    return f"'{text}" if text.lstrip().startswith(_FORMULA) else text
