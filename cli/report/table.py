"""The report as a table: one row for each pair, then remarks, then the summary."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.audit.request.settings import LISTED_PAIRS
from satcheck.cli.report.columns import columns_of, fit
from satcheck.cli.report.grid import Grid
from satcheck.cli.report.lines import fitted, joined
from satcheck.cli.report.remarks import is_lost, remarks
from satcheck.cli.report.summary import summary_line
from satcheck.cli.report.words import counted, past_holes
from satcheck.report.report import OVERLAPS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from satcheck.cli.output import Page
    from satcheck.report.report import Finding, Report


def render(report: Report, page: Page, *, explain: bool, timings: bool) -> str:
    """The whole text, final newline included. Errors are not in it: they go to stderr."""
    lines: list[str] = []
    shown = _shown(report)
    if shown:
        layout = fit(columns_of(shown, report.units, timings=timings), page.width)
        lines += Grid(layout, page).lines()
    listed = sum(finding.relation == "separated" for finding in shown)
    rest = report.summary.by_relation.get("separated", 0) - listed
    if shown and rest:
        lines += fitted(f"{counted(rest, 'more pair')}, all separated", page)
    if any(finding.components for finding in shown):
        from satcheck.cli.report.components import component_lines

        lines += component_lines(page, shown)
    if explain:
        from satcheck.cli.report.explain import explanation  # rich's tables

        lines += explanation(page, report, shown, timings=timings)
    for remark in remarks(report, shown):
        lines += fitted(remark.text, page, remark.style)
    lines += fitted(summary_line(report), page)
    return joined(lines, page)


def _shown(report: Report) -> Sequence[Finding]:
    """What could be examined, the thickest overlaps first; of more than LISTED_PAIRS only what is
    not plainly separated, at rest and on the way."""
    lost = {body.id for body in report.bodies if is_lost(body)}
    findings = [f for f in report.findings if f.a not in lost and f.b not in lost]
    if len(findings) > LISTED_PAIRS:
        findings = [f for f in findings if _is_told(f)]
    return sorted(findings, key=_by_thickness)


def _by_thickness(finding: Finding) -> float:
    """The thickest overlaps come first; all else stays as it is."""
    return -(finding.thickness or 0.0) if finding.at_rest in OVERLAPS else 0.0


def _is_told(finding: Finding) -> bool:
    if finding.relation != "separated":
        return True
    return finding.reason is not None and not past_holes(finding)
