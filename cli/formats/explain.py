"""`--explain`: what was computed and why, the known facts of each body, the plan of each pair."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from rich.table import Table
from rich.text import Text

from satcheck.cli.formats.canvas import Canvas
from satcheck.cli.formats.numbers import at_most, duration, number
from satcheck.cli.formats.words import counted

if TYPE_CHECKING:
    from satcheck.cli.output import Page
    from satcheck.report.regions import Regions
    from satcheck.report.report import BodyReport, EffectReport, Finding, Report
    from satcheck.report.statics import Statics


# Of those who ask for an effect.
MOST_NAMES = 4


def explanation(
    page: Page, report: Report, findings: Sequence[Finding], *, timings: bool
) -> list[str]:
    """The lines between the table and the remarks."""
    canvas = Canvas(page)
    canvas.print(_effects(report.effects, timings=timings))
    if report.support is not None:
        canvas.print(_support(report.support, timings=timings))
    if report.regions:
        canvas.print(_in_regions(report.regions, timings=timings))
    canvas.print()
    canvas.print(_bodies(report.bodies))
    for finding in findings:
        canvas.print(Text(f"\n{finding.a} against {finding.b}: {finding.relation}", style="bold"))
        canvas.print(_plan(finding, timings=timings))
    canvas.print()
    return canvas.text().removesuffix("\n").split("\n")


def _effects(effects: Sequence[EffectReport], *, timings: bool) -> Table:
    table = _grid(columns=4 if timings else 3)
    for effect in effects:
        cost = [duration(effect.microseconds) if effect.pairs else ""] if timings else []
        table.add_row(
            "",
            Text(effect.effect, style="bold"),
            counted(effect.pairs, "pair"),
            *cost,
            _who(effect),
        )
    return table


def _support(statics: Statics, *, timings: bool) -> Table:
    """What the support of bodies took, as the effects above."""
    table = _grid(columns=4 if timings else 3)
    cost = [duration(statics.microseconds)] if timings else []
    points = sum(len(contact.points) for contact in statics.contacts)
    islands = counted(len(statics.islands), "island")
    who = ", ".join(statics.asked_by[:MOST_NAMES])
    if len(statics.asked_by) > MOST_NAMES:
        who += f" and {len(statics.asked_by) - MOST_NAMES} more"
    contacts = f"{counted(points, 'contact point')}, {islands}"
    name = Text("support", style="bold")
    table.add_row("", name, counted(statics.pairs, "pair"), *cost, f"{who}; {contacts}")
    return table


def _in_regions(regions: Regions, *, timings: bool) -> Table:
    table = _grid(columns=4 if timings else 3)
    cost = [duration(regions.microseconds)] if timings else []
    names = dict.fromkeys(finding.region for finding in regions.findings)
    name = Text("inside", style="bold")
    bodies = counted(len(regions.findings), "body", "bodies")
    table.add_row("", name, bodies, *cost, ", ".join(names))
    return table


def _who(effect: EffectReport) -> str:
    """`--depth; not on 2 (boxes apart), 1 (allowed)`."""
    if not effect.asked_by:
        return "not asked"
    who = ", ".join(effect.asked_by[:MOST_NAMES])
    if len(effect.asked_by) > MOST_NAMES:
        who += f" and {len(effect.asked_by) - MOST_NAMES} more"
    reasons = [f"{count:,} ({reason})" for reason, count in effect.not_run.items()]
    return f"{who}; not on {', '.join(reasons)}" if reasons else who


def _bodies(bodies: Sequence[BodyReport]) -> Table:
    table = _grid(columns=2)
    for body in bodies:
        first, *more = _about(body)
        table.add_row("", Text(body.id, style="bold"), first)
        for line in more:
            table.add_row("", "", line)
    return table


def _about(body: BodyReport) -> Iterator[str]:
    if body.triangles is None:
        yield f"{body.file}: unreadable"
        return
    words = [f"{body.file}: {counted(body.triangles, 'triangle')}"]
    if body.health is not None and not body.health.closed:
        words.append("not closed")
    if body.convex is not None:
        words.append("convex" if body.convex else "concave")
    if body.resolution is not None:
        words.append(f"precision {number(body.resolution)}")
    yield ", ".join(words)
    if body.parts is not None and body.part_error is not None:
        error = body.part_error
        yield (
            f"{counted(body.parts, 'convex part')}: they stick out of the mesh by at most "
            f"{at_most(error.outside)}, and the mesh out of them by at most "
            f"{at_most(error.missing)}"
        )


def _plan(finding: Finding, *, timings: bool) -> Table:
    table = _grid(columns=4 if timings else 3)
    for stage in finding.plan:
        cost = [duration(stage.microseconds)] if timings else []
        table.add_row("", stage.stage, stage.result, *cost, stage.detail)
    return table


def _grid(columns: int) -> Table:
    """Indented; only the last column is folded, between words."""
    table = Table.grid(padding=(0, 2, 0, 0))
    table.add_column(width=0)
    for _ in range(columns - 1):
        table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    return table
