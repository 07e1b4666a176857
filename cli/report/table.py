"""The report for people: one row a pair, then what else they should know, then one sentence."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from satcheck.cli.lengths import unit_of
from satcheck.cli.output import UNBOUNDED_WIDTH
from satcheck.cli.report.numbers import duration, number, vector
from satcheck.cli.report.words import counted, depth, issue_line, relation, summary_line

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from satcheck.audit.report import BodyReport, Finding, Report
    from satcheck.cli.output import Page

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
_ISSUE_COLOURS = {"warning": "yellow", "note": ""}


def render(report: Report, page: Page, *, explain: bool, timings: bool) -> str:
    """The whole text, final newline included. Errors are not in it: they go to stderr."""
    written = io.StringIO()
    console = Console(
        file=written,
        width=page.width,
        force_terminal=page.colour,
        color_system="standard" if page.colour else None,
        no_color=not page.colour,
        legacy_windows=False,
        highlight=False,
        emoji=False,
        markup=False,
    )
    shown = _shown(report.findings)
    if shown:
        table = _pairs(shown, unit_of(report.units), timings)
        table.box = box.ROUNDED if page.unicode else box.ASCII
        unfolded = console.measure(table, options=console.options.update(max_width=UNBOUNDED_WIDTH))
        if unfolded.maximum > page.width:
            _narrow(table, page)
        console.print(table)
    listed = sum(finding.relation == "separated" for finding in shown)
    rest = report.summary.by_relation.get("separated", 0) - listed
    if shown and rest:
        console.print(f"{counted(rest, 'more pair')}, all separated")
    if explain:
        _explain(console, report.bodies, shown, timings)
    for line in _remarks(report, shown):
        console.print(line)
    console.print(summary_line(report))
    return "".join(f"{line.rstrip()}\n" for line in written.getvalue().splitlines())


def _shown(findings: Sequence[Finding]) -> Sequence[Finding]:
    """All of them, unless they are many: then what is not plainly separated."""
    if len(findings) <= ROWS:
        return findings
    return [finding for finding in findings if finding.relation != "separated" or finding.reason]


def _narrow(table: Table, page: Page) -> None:
    """No frame: two spaces between columns instead of three characters."""
    table.box = box.SIMPLE_HEAD if page.unicode else box.ASCII2
    table.show_edge = False
    table.pad_edge = False
    table.padding = (0, 1, 0, 0)


def _pairs(findings: Sequence[Finding], units: str | None, timings: bool) -> Table:
    """Columns that would be empty in every row are left out."""
    table = Table(header_style="bold")
    unit = f" ({units})" if units else ""
    columns: list[Callable[[Finding], str | Text]] = []

    def add(name: str, cell: Callable[[Finding], str | Text], *, right: bool = False) -> None:
        """A figure is broken between numbers, never within one; a word not at all."""
        words = [len(word) for finding in findings for word in str(cell(finding)).split()]
        table.add_column(
            name,
            justify="right" if right else "left",
            overflow="fold",
            no_wrap=name in ("relation", "quality", "time"),
            min_width=None if name in ("A", "B") else max(words, default=0),
        )
        columns.append(cell)

    add("A", lambda finding: finding.a)
    add("B", lambda finding: finding.b)
    add("relation", _relation)
    if any(finding.distance is not None and finding.distance > 0 for finding in findings):
        add(f"gap{unit}", _gap, right=True)
    if any(finding.depth is not None for finding in findings):
        add(f"depth{unit}", depth, right=True)
    if any(finding.mtv is not None for finding in findings):
        add(f"move A by{unit}", _mtv)
    add("quality", lambda finding: finding.quality or "")
    if timings:
        add("time", _time, right=True)
    for finding in findings:
        table.add_row(*(cell(finding) for cell in columns))
    return table


def _relation(finding: Finding) -> Text:
    return Text(relation(finding), style=_COLOURS[finding.relation])


def _gap(finding: Finding) -> str:
    return "" if finding.distance is None or finding.distance <= 0 else number(finding.distance)


def _mtv(finding: Finding) -> str:
    if finding.mtv is None:
        return ""
    return vector(finding.mtv) + ("" if finding.mtv_verified else " not verified")


def _time(finding: Finding) -> str:
    return duration(sum(stage.microseconds for stage in finding.plan)) if finding.plan else ""


def _explain(
    console: Console, bodies: Sequence[BodyReport], findings: Sequence[Finding], timings: bool
) -> None:
    console.print(_bodies(bodies))
    for finding in findings:
        console.print(Text(f"\n{finding.a} against {finding.b}: {relation(finding)}", style="bold"))
        plan = Table.grid(padding=(0, 2))
        for stage in finding.plan:
            cost = [duration(stage.microseconds)] if timings else []
            plan.add_row("", stage.stage, stage.result, *cost, stage.detail)
        console.print(plan)
    console.print()


def _bodies(bodies: Sequence[BodyReport]) -> Table:
    table = Table.grid(padding=(0, 2))
    table.add_row("", "body", "triangles", "shape", "precision", "file", style="bold")
    for body in bodies:
        table.add_row(
            "",
            body.id,
            "unreadable" if body.triangles is None else f"{body.triangles:,}",
            _shape(body),
            "" if body.resolution is None else number(body.resolution),
            body.file,
        )
    return table


def _shape(body: BodyReport) -> str:
    words = []
    if body.health is not None and not body.health.get("closed", True):
        words.append("open")
    if body.convex is not None:
        words.append("convex" if body.convex else "concave")
    if body.parts is not None:
        words.append(f"{body.parts} parts")
    if body.part_error is not None:
        error = body.part_error
        words.append(f"outside {number(error.outside)}, missing {number(error.missing)}")
    return ", ".join(words)


def _remarks(report: Report, shown: Sequence[Finding]) -> list[Text]:
    """What a row has no room for, then the warnings and notes about the inputs."""
    lines = []
    for finding in shown:
        pair = f"{finding.a} and {finding.b}"
        if finding.relation == "touching" and finding.exact_relation not in (None, "touching"):
            band = number(finding.tolerance or 0.0)
            lines.append(Text(f"{pair}: exactly {finding.exact_relation}, by no more than {band}"))
        if finding.reason:
            lines.append(Text(f"{pair}: {finding.reason}"))
    for issue in report.issues:
        if issue.severity != "error":
            lines.append(Text(issue_line(issue), style=_ISSUE_COLOURS[issue.severity]))
    return lines
