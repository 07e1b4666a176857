"""The report as a table: one row for each pair, the worst first, then remarks and the summary."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import accumulate, chain, pairwise
from typing import TYPE_CHECKING

from satcheck.audit.request.settings import LISTED_PAIRS
from satcheck.cli.formats.columns import columns_of, fit
from satcheck.cli.formats.config import config_line
from satcheck.cli.formats.grid import Grid
from satcheck.cli.formats.lines import (
    BOLD_MAGENTA,
    BOLD_RED,
    CYAN,
    GREEN,
    YELLOW,
    fitted,
    joined,
)
from satcheck.cli.formats.order import groups_of, severity, worst_first
from satcheck.cli.formats.remarks import remarks
from satcheck.cli.formats.summary import counts_line
from satcheck.cli.formats.verdict import next_step, verdict_line
from satcheck.cli.formats.words import counted, is_unusable, past_holes

if TYPE_CHECKING:
    from satcheck.cli.formats.columns import Column
    from satcheck.cli.output import Page
    from satcheck.report.report import Finding, Report, Severity

# Colour only repeats what the words beside it say. A touch is a note, too.
_STYLES: dict[Severity, str] = {
    "error": BOLD_RED,
    "warning": YELLOW,
    "note": CYAN,
    "silenced": "",
    "none": GREEN,
}


def render(
    report: Report, page: Page, *, explain: bool, timings: bool, top: int | None = None
) -> str:
    """The whole text, final newline included. Errors are not in it: they go to stderr.

    top: how many pairs at most; all count in the summary.
    """
    rows = worst_first(_listed(report))
    groups = groups_of(rows[:top], _titled(report))
    shown = list(chain.from_iterable(groups))
    lines: list[str] = []
    if shown:
        columns = columns_of(shown, report.units, timings=explain and timings)
        styles = [_style(finding) for finding in shown]
        layout = fit(columns, page.width)
        if layout is None:
            lines += _stacked(columns, page, styles)
        else:
            lines += Grid(layout, page, styles, set(_breaks(groups))).lines()
    for rest in _left_out(report, rows, top):
        lines += fitted(rest, page)
    if any(finding.components for finding in shown):
        from satcheck.cli.formats.components import component_lines

        lines += component_lines(page, shown)
    if report.support is not None:
        from satcheck.cli.formats.support import support_lines

        lines += support_lines(report, page)
    if report.regions:
        from satcheck.cli.formats.body_answers import region_lines

        lines += region_lines(report, page)
    if explain:
        from satcheck.cli.formats.explain import explanation  # rich's tables

        lines += explanation(page, report, shown, timings=timings)
    for remark in remarks(report, shown):
        lines += fitted(remark.text, page, remark.style)
    if report.config is not None:
        lines += fitted(config_line(report.config), page)
    lines += fitted(counts_line(report), page)
    lines += fitted(" ".join([verdict_line(report), *next_step(report)]), page)
    return joined(lines, page)


def _listed(report: Report) -> Sequence[Finding]:
    """What could be examined; of more than LISTED_PAIRS only what is not plainly separated, at rest
    and on the way."""
    unusable = {body.id for body in report.bodies if is_unusable(body)}
    findings = [f for f in report.findings if f.a not in unusable and f.b not in unusable]
    if len(findings) > LISTED_PAIRS:
        findings = [f for f in findings if _is_told(f)]
    return findings


def _is_told(finding: Finding) -> bool:
    if finding.relation != "separated":
        return True
    return finding.reason is not None and not past_holes(finding)


def _titled(report: Report) -> set[str]:
    """The ids of elements that have names of their own, such as those of IFC files."""
    return {body.id for body in report.bodies if body.path is not None and body.name != body.id}


def _style(finding: Finding) -> str:
    return BOLD_MAGENTA if finding.relation == "indeterminate" else _STYLES[severity(finding)]


def _breaks(groups: Sequence[Sequence[Finding]]) -> Iterator[int]:
    """The rows that begin behind a rule: where a group of several findings begins or ends."""
    ends = accumulate(map(len, groups))
    for end, (before, after) in zip(ends, pairwise(groups), strict=False):
        if severity(before[0]) != "none" and (len(before) > 1 or len(after) > 1):
            yield end


def _left_out(report: Report, rows: Sequence[Finding], top: int | None) -> Iterator[str]:
    hidden = len(rows[top:]) if top else 0
    if hidden:
        yield f"{counted(hidden, 'more pair')} not shown (--top {top})"
    listed = sum(finding.relation == "separated" for finding in rows)
    rest = report.summary.by_relation.get("separated", 0) - listed
    if rows and rest:
        yield f"{counted(rest, 'more pair')}, all separated"


def _stacked(columns: Sequence[Column], page: Page, styles: Sequence[str]) -> Iterator[str]:
    """Pairs as paragraphs, for a terminal that is too narrow for a table: `box and lid:
    penetrating`, then a line for each figure.

    columns: A, B and the relation come first. styles: of each pair.
    """
    a, b, relation, *others = columns
    rows = zip(a.cells, b.cells, relation.cells, styles, strict=True)
    for number, (first, second, told, style) in enumerate(rows):
        yield from fitted(f"{first} and {second}: {told}", page, style)
        for column in others:
            if cell := column.cells[number]:
                yield from fitted(f"  {column.name}: {cell}", page)
