"""The reports of many assets as a table: a row for each, the worst first, and the count of them."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING

import click
from rich import box
from rich.table import Table
from rich.text import Text

from satcheck.cli.report.beside_baseline import beside_baseline
from satcheck.cli.report.canvas import Canvas
from satcheck.cli.report.ci.problems import problems
from satcheck.cli.report.config import config_lines
from satcheck.cli.report.words import counted, issue_line
from satcheck.report.assets import ASSET_VERDICTS
from satcheck.report.report import NOTHING_TO_CHECK

if TYPE_CHECKING:
    from satcheck.cli.output import Page
    from satcheck.cli.report.ci.problems import Problem
    from satcheck.report.assets import Asset, AssetsReport
    from satcheck.report.report import Issue

# Passing assets are listed up to this many assets.
LISTED = 60
# So many are named in the summary.
NAMED = 3
# Kinds of problems that make an asset incomplete.
_OPEN = (NOTHING_TO_CHECK, "undecided")
# Colour only repeats what the word says.
_COLOURS = {
    "pass": "green",
    "fail": "bold red",
    "incomplete": "bold magenta",
    "error": "bold magenta",
}


def render(report: AssetsReport, page: Page, *, top: int | None = None) -> str:
    """The whole text, final newline included. top: how many assets at most; all count in the
    summary."""
    console = Canvas(page)
    shown = sorted(report.assets, key=lambda asset: ASSET_VERDICTS.index(asset.verdict))
    if len(shown) > LISTED:
        shown = [asset for asset in shown if asset.verdict != "pass"]
    if shown:
        console.print(_table(shown[:top], unicode=page.unicode))
    if hidden := len(shown) - len(shown[:top]):
        console.print(f"{counted(hidden, 'more asset')} not shown (--top {top})")
    if passing := report.counts.total - len(shown):
        console.print(f"{counted(passing, 'more asset')} {'passes' if passing == 1 else 'pass'}")
    for issue in report.issues:
        console.print(issue_line(issue))
    for line in config_lines(asset.report for asset in report.assets):
        console.print(line)
    console.print(summary_line(report))
    return console.text()


def summary_line(report: AssetsReport) -> str:
    """`FAIL: 39 assets: 1 has errors (c.glb), 2 fail (a.glb, b.glb), 36 pass.`"""
    counts = report.counts
    unsure = "ERROR" if counts.error else "INCOMPLETE"
    word = "PASS" if report.verdict == "pass" else "FAIL" if counts.fail else unsure
    parts = [
        f"{count:,} {words}{_named(report, verdict)}"
        for count, words, verdict in (
            (counts.error, "have errors" if counts.error > 1 else "has errors", "error"),
            (counts.fail, "fail" if counts.fail > 1 else "fails", "fail"),
            (counts.incomplete, "incomplete", "incomplete"),
            (counts.passed, "pass" if counts.passed > 1 else "passes", "pass"),
        )
        if count
    ]
    line = f"{word}: {counted(counts.total, 'asset')}: {', '.join(parts)}."
    beside = beside_baseline(asset.report for asset in report.assets)
    return " ".join([line, *_by_rules(report), *beside, *_next_step(report)])


def _by_rules(report: AssetsReport) -> list[str]:
    """`No pair of 1 passing asset was checked: rules allow them all.`"""
    passing = (asset.report for asset in report.assets if asset.verdict == "pass")
    count = sum(any(map(_is_unchecked, each.issues)) for each in passing)
    named = counted(count, "passing asset")
    return [f"No pair of {named} was checked: rules allow them all."] if count else []


def _is_unchecked(issue: Issue) -> bool:
    return issue.code == NOTHING_TO_CHECK


def _next_step(report: AssetsReport) -> list[str]:
    failing = (asset.file for asset in report.assets if asset.verdict == "fail")
    return [f"Next: {_check_of(file)} lists its pairs." for file in failing][:1]


def _check_of(file: str) -> str:
    """With the options of this call, if a command renders."""
    ctx = click.get_current_context(silent=True)
    if ctx is None or ctx.info_name != "each":
        return f"satcheck {shlex.quote(file)}"
    from satcheck.cli.slips import check_of

    return check_of(file, ctx)


def _named(report: AssetsReport, verdict: str) -> str:
    """` (a.glb, b.glb, c.glb, ...)`; what passes is not named."""
    files = [asset.file for asset in report.assets if asset.verdict == verdict != "pass"]
    more = ", ..." if len(files) > NAMED else ""
    return f" ({', '.join(files[:NAMED])}{more})" if files else ""


def _table(assets: list[Asset], *, unicode: bool) -> Table:
    table = Table(box=box.ROUNDED if unicode else box.ASCII)
    for name in ("asset", "verdict", "bodies", "pairs", "worst"):
        right = name in ("bodies", "pairs")
        table.add_column(
            name,
            justify="right" if right else "left",
            overflow="fold",
            no_wrap=name not in ("asset", "worst"),
        )
    for asset in assets:
        report, listed = asset.report, _listed(asset)
        more = f" (and {len(listed) - 1:,} more)" if len(listed) > 1 else ""
        table.add_row(
            Text(asset.file),
            Text(asset.verdict, style=_COLOURS[asset.verdict]),
            f"{len(report.bodies):,}",
            f"{report.summary.pairs.total:,}",
            Text(f"{listed[0].message}{more}" if listed else ""),
        )
    return table


def _listed(asset: Asset) -> list[Problem]:
    """What the row of an asset tells, the worst first; of an incomplete one, first what is open."""
    told = problems({asset.file: asset.report})
    listed = [p for p in told if p.level != "note" or p.kind in _OPEN]
    if asset.verdict == "incomplete":
        listed.sort(key=lambda p: p.kind not in _OPEN)
    return listed
