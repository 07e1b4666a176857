"""The report for people: one row a pair, then what else they should know, then one sentence."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich import box
from rich.table import Table
from rich.text import Text

from satcheck.cli.report.canvas import Canvas
from satcheck.cli.report.columns import columns_of, fit
from satcheck.cli.report.explain import explain as print_explanation
from satcheck.cli.report.remarks import is_lost, remarks
from satcheck.cli.report.summary import summary_line
from satcheck.cli.report.words import by_surfaces, counted

if TYPE_CHECKING:
    from collections.abc import Sequence

    from satcheck.audit.report import Finding, Report
    from satcheck.cli.output import Page
    from satcheck.cli.report.canvas import Canvas
from satcheck.cli.report.columns import Layout

# More rows than this, and separated pairs are counted instead of listed.
ROWS = 60
# Colour only repeats what the word beside it says.
_COLOURS = {
    "separated": "green",
    "near": "yellow",
    "touching": "yellow",
    "penetrating": "bold red",
    "contains": "bold red",
    "inside": "bold red",
    "coincident": "bold red",
    "indeterminate": "bold magenta",
}


def render(report: Report, page: Page, *, explain: bool, timings: bool) -> str:
    """The whole text, final newline included. Errors are not in it: they go to stderr."""
    console = Canvas(page)
    shown = _shown(report)
    if shown:
        layout = fit(columns_of(shown, report.units, timings=timings), page.width)
        console.width = max(layout.width, page.width)
        console.print(_pairs(layout, unicode=page.unicode))
        console.width = page.width
    listed = sum(finding.relation == "separated" for finding in shown)
    rest = report.summary.by_relation.get("separated", 0) - listed
    if shown and rest:
        console.print(f"{counted(rest, 'more pair')}, all separated")
    if explain:
        print_explanation(console, report, shown, timings=timings)
    for line in remarks(report, shown):
        console.print(line)
    console.print(summary_line(report))
    return console.text()


def _shown(report: Report) -> Sequence[Finding]:
    """What could be examined; of more than ROWS only what is not plainly separated, at rest and on
    the way."""
    lost = {body.id for body in report.bodies if is_lost(body)}
    findings = [f for f in report.findings if f.a not in lost and f.b not in lost]
    if len(findings) <= ROWS:
        return findings
    return [f for f in findings if _is_told(f)]


def _is_told(finding: Finding) -> bool:
    swept = finding.motion
    if finding.relation != "separated" or (swept is not None and swept.relation != "separated"):
        return True
    return finding.reason is not None and not by_surfaces(finding)


def _pairs(layout: Layout, *, unicode: bool) -> Table:
    table = Table(header_style="bold", box=box.ROUNDED if unicode else box.ASCII)
    if not layout.framed:  # two spaces between columns instead of three characters
        table.box = box.SIMPLE_HEAD if unicode else box.ASCII2
        table.show_edge = False
        table.pad_edge = False
        table.padding = (0, 1, 0, 0)
    for column, width in zip(layout.columns, layout.widths, strict=True):
        table.add_column(
            column.name,
            justify="right" if column.right else "left",
            overflow="fold",
            width=width,
        )
    for cells in zip(*(column.cells for column in layout.columns), strict=True):
        table.add_row(
            *(
                Text(cell, style=_COLOURS[cell] if column.name == "relation" else "")
                for column, cell in zip(layout.columns, cells, strict=True)
            )
        )
    return table
