"""The difference of two batches as a table or as Markdown: a row for each change, the worst
first."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, get_args

from satcheck.cli.formats.ci.markdown import as_text
from satcheck.cli.formats.numbers import number
from satcheck.cli.formats.words import counted, issue_line, with_unit
from satcheck.cli.output import harmless
from satcheck.report.assets import ASSET_VERDICTS
from satcheck.report.baseline import Figure
from satcheck.report.difference import FINDING_STATES
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from satcheck.cli.output import Page
    from satcheck.report.baseline import KnownFinding
    from satcheck.report.difference import (
        Difference,
        FindingCounts,
        SceneChange,
        SceneCounts,
    )

COLUMNS = ("change", "scene", "A", "B", "before", "now")
_FIGURES: tuple[Figure, ...] = get_args(Figure)
_WORDS = {"pass": "PASS", "fail": "FAIL", "incomplete": "INCOMPLETE", "error": "ERROR"}
# Colour only repeats what the word says.
_COLOURS = {"new": "bold red", "worse": "bold red", "better": "green", "gone": "green"}


class Row(NamedTuple):
    change: str
    scene: str
    a: str
    b: str
    before: str
    now: str


def render(difference: Difference, page: Page, top: int | None) -> str:
    """The whole text of the table, final newline included. top: rows at most."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    from satcheck.cli.formats.canvas import Canvas

    console, rows = Canvas(page), rows_of(difference)
    if rows:
        table = Table(box=box.ROUNDED if page.unicode else box.ASCII)
        for name in COLUMNS:
            table.add_column(name, overflow="fold", no_wrap=name == "change")
        for row in rows[:top]:
            change = Text(row.change, style=_COLOURS.get(row.change, ""))
            table.add_row(change, *map(Text, row[1:]))
        console.print(table)
    for line in lines_of(difference, hidden=len(rows) - len(rows[:top])):
        console.print(line)
    return console.text()


def markdown(difference: Difference, top: int | None) -> Iterator[str]:
    rows = rows_of(difference)
    yield "## satcheck: difference of two batches\n\n"
    for line in lines_of(difference, hidden=len(rows) - len(rows[:top])):
        yield f"{as_text(harmless(line))}\n\n"
    if rows:
        yield f"| {' | '.join(COLUMNS)} |\n|{'---|' * len(COLUMNS)}\n"
    for row in rows[:top]:
        yield f"| {' | '.join(as_text(harmless(cell)) for cell in row)} |\n"


def lines_of(difference: Difference, *, hidden: int) -> Iterator[str]:
    if hidden:
        yield f"{counted(hidden, 'more change')} not shown (--top)"
    for issue in difference.issues:
        yield issue_line(issue)
    yield summary_line(difference)


def summary_line(difference: Difference) -> str:
    """`FAIL: failing findings: 1 new, 7 unchanged; scenes: 1 added, 9 same.`"""
    findings, scenes = _counts(difference.findings), _counts(difference.scenes)
    word = _WORDS[difference.verdict]
    return f"{word}: failing findings: {findings or 'none'}; scenes: {scenes or 'none'}."


def _counts(counts: FindingCounts | SceneCounts) -> str:
    by_name = {name: getattr(counts, name) for name in counts.__struct_fields__}
    return ", ".join(f"{count:,} {name}" for name, count in by_name.items() if count)


def rows_of(difference: Difference) -> list[Row]:
    """The worst first."""
    ranked = [(rank, row) for scene in difference.changes for rank, row in _rows(scene)]
    return [row for _, row in sorted(ranked, key=lambda each: each[0])]


def _rows(scene: SceneChange) -> Iterator[tuple[tuple[float, ...], Row]]:
    """Each with its rank, the lower the worse. A scene has a row of its own if its verdict
    changed."""
    for each in scene.findings:
        known = each.now or each.before
        thick = (known and (known.thickness or known.depth)) or 0.0
        before, now = _figures(each.before), _figures(each.now)
        row = Row(each.state, scene.file, each.a, each.b, before, now)
        yield (FINDING_STATES.index(each.state), -thick), row
    if scene.before != scene.now:
        change = "verdict" if scene.state == "both" else scene.state
        row = Row(change, scene.file, "", "", scene.before or "", scene.now or "")
        is_open = scene.now in ("error", "incomplete")
        verdict = ASSET_VERDICTS.index(scene.now) if scene.now else len(ASSET_VERDICTS)
        yield (-1 if is_open else len(FINDING_STATES), verdict), row


def _figures(known: KnownFinding | None) -> str:
    """`penetrating, depth 1 mm`; empty without a finding."""
    if known is None:
        return ""
    unit = unit_of(known.units)
    figures = ((name, known.figure(name)) for name in _FIGURES)
    said = (
        f"{name.replace('_', ' ')} {with_unit(number(value), None if name == 'volume' else unit)}"
        for name, value in figures
        if value is not None
    )
    return ", ".join([known.relation, *said])
