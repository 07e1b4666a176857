"""The reports of many assets as a table: a row for each, the worst first, and the count of them."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING

import click
from rich import box
from rich.table import Table
from rich.text import Text

from satcheck.cli.formats.canvas import Canvas
from satcheck.cli.formats.ci.problems import problems
from satcheck.cli.formats.overview import NAMED
from satcheck.cli.formats.words import counted, issue_line
from satcheck.report.report import NOTHING_TO_CHECK
from satcheck.scene.path_kind import is_folder

if TYPE_CHECKING:
    from satcheck.cli.formats.ci.problems import Problem
    from satcheck.cli.formats.overview import Overview
    from satcheck.cli.output import Page
    from satcheck.report.assets import Asset, AssetVerdict

# Kinds of problems that make an asset incomplete.
_OPEN = (NOTHING_TO_CHECK, "undecided")
# Colour only repeats what the word says.
_COLOURS = {
    "pass": "green",
    "fail": "bold red",
    "incomplete": "bold magenta",
    "error": "bold magenta",
}


def render(seen: Overview, page: Page) -> str:
    """The whole text, final newline included."""
    console = Canvas(page)
    if seen.shown:
        console.print(_table(seen.shown, unicode=page.unicode))
    if hidden := seen.listed - len(seen.shown):
        console.print(f"{counted(hidden, 'more asset')} not shown (--top {len(seen.shown)})")
    if passing := seen.total - seen.listed:
        console.print(f"{counted(passing, 'more asset')} {'passes' if passing == 1 else 'pass'}")
    for issue in seen.issues:
        console.print(issue_line(issue))
    for line in seen.config:
        console.print(line)
    console.print(summary_line(seen))
    return console.text()


def summary_line(seen: Overview) -> str:
    """`FAIL: 39 assets: 1 has errors (c.glb), 2 fail (a.glb, b.glb), 36 pass.`"""
    counts = seen.counts
    unsure = "ERROR" if seen.has("error") else "INCOMPLETE"
    word = "PASS" if seen.verdict == "pass" else "FAIL" if counts["fail"] else unsure
    words: dict[AssetVerdict, str] = {
        "error": "have errors" if counts["error"] > 1 else "has errors",
        "fail": "fail" if counts["fail"] > 1 else "fails",
        "incomplete": "incomplete",
        "pass": "pass" if counts["pass"] > 1 else "passes",
    }
    parts = [
        f"{counts[verdict]:,} {said}{_named(seen, verdict)}"
        for verdict, said in words.items()
        if counts[verdict]
    ]
    line = f"{': '.join([word, counted(seen.total, 'asset'), *filter(None, [', '.join(parts)])])}."
    return " ".join([line, *_by_rules(seen), *seen.beside.lines(), *_next_step(seen)])


def _by_rules(seen: Overview) -> list[str]:
    """`No pair of 1 passing asset was checked: rules allow them all.`"""
    named, lone = counted(seen.unchecked, "passing asset"), counted(seen.lone, "passing asset")
    said = [f"No pair of {named} was checked: rules allow them all."] if seen.unchecked else []
    return said + ([f"Nothing to compare in {lone}: one body or none."] if seen.lone else [])


def _next_step(seen: Overview) -> list[str]:
    failing = seen.named.get("fail", [])[:1]
    unsure = [] if failing else seen.named.get("incomplete", [])[:1]
    unsure = [file for file in unsure if not is_folder(file)]  # of files that no check reads
    ctx = click.get_current_context(silent=True)
    if ctx is None or ctx.info_name != "report":
        steps = [f"Next: {_check_of(file)} lists its pairs." for file in failing]
        return steps + [f"Next: {_check_of(file)} says what is open." for file in unsure]
    is_written = ctx.params.get("output") is not None
    return ["Next: -o worst.html shows the worst pairs."] if failing and not is_written else []


def _check_of(file: str) -> str:
    """With the options of this call, if a command renders."""
    ctx = click.get_current_context(silent=True)
    if ctx is None or ctx.info_name != "each":
        return f"satcheck {shlex.quote(file)}"
    from satcheck.cli.slips import check_of

    return check_of(file, ctx)


def _named(seen: Overview, verdict: AssetVerdict) -> str:
    """` (a.glb, b.glb, c.glb, ...)`; what passes is not named."""
    files = seen.named[verdict] if verdict != "pass" else []
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
        file, verdict, *others = cells_of(asset)
        styled = Text(verdict, style=_COLOURS[asset.verdict])
        table.add_row(Text(file), styled, *map(Text, others))
    return table


def cells_of(asset: Asset) -> tuple[str, ...]:
    """The asset, its verdict, bodies and pairs, and its worst problem."""
    report, listed = asset.report, _listed(asset)
    more = f" (and {len(listed) - 1:,} more)" if len(listed) > 1 else ""
    worst = f"{listed[0].message}{more}" if listed else ""
    pairs = f"{report.summary.pairs.total:,}"
    return (asset.file, asset.verdict, f"{len(report.bodies):,}", pairs, worst)


def _listed(asset: Asset) -> list[Problem]:
    """What the row of an asset tells, the worst first; of an incomplete one, first what is open."""
    told = problems({asset.file: asset.report})
    listed = [p for p in told if p.level != "note" or p.kind in _OPEN]
    if asset.verdict == "incomplete":
        listed.sort(key=lambda p: p.kind not in _OPEN)
    return listed
