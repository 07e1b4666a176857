"""`--explain`: what was computed and why, the known facts of each body, the plan of each pair."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from satcheck.audit.words import at_most, counted, duration, number
from satcheck.cli.formats.tables import BOLD, aligned, fitted
from satcheck.scene.words import listed

if TYPE_CHECKING:
    from satcheck.cli.output import Page
    from satcheck.report.regions import Regions
    from satcheck.report.report import BodyReport, EffectReport, Finding, Report
    from satcheck.report.statics import Statics


# What was computed, its pairs or result, microseconds (None: none), and more about it.
_Row = tuple[str, str, float | None, str]


def explanation(
    page: Page, report: Report, findings: Sequence[Finding], *, timings: bool
) -> list[str]:
    """Return the lines between the table and the remarks."""
    effects = [*map(_effect, report.effects)]
    if report.support is not None:
        effects.append(_support(report.support))
    if report.regions:
        effects.append(_in_regions(report.regions))
    lines = [*aligned(_rows(effects, timings=timings), page), ""]
    lines += aligned([row for body in report.bodies for row in _about(body)], page)
    for finding in findings:
        title = f"{finding.a} against {finding.b}: {finding.relation}"
        plan = [(s.stage, s.result, s.microseconds, s.detail) for s in finding.plan]
        lines += ["", *fitted(title, page, BOLD)]
        lines += aligned(_rows(plan, timings=timings), page, bold=False)
    return [*lines, ""]


def _rows(rows: Sequence[_Row], *, timings: bool) -> list[tuple[str, ...]]:
    if not timings:
        return [(name, result, more) for name, result, _, more in rows]
    return [
        (name, result, "" if cost is None else duration(cost), more)
        for name, result, cost, more in rows
    ]


def _effect(effect: EffectReport) -> _Row:
    cost = effect.microseconds if effect.pairs else None
    return effect.effect, counted(effect.pairs, "pair"), cost, _who(effect)


def _support(statics: Statics) -> _Row:
    points = sum(len(contact.points) for contact in statics.contacts)
    islands = counted(len(statics.islands), "island")
    more = f"{listed(statics.asked_by)}; {counted(points, 'contact point')}, {islands}"
    return "support", counted(statics.pairs, "pair"), statics.microseconds, more


def _in_regions(regions: Regions) -> _Row:
    names = dict.fromkeys(finding.region for finding in regions.findings)
    bodies = counted(len(regions.findings), "body", "bodies")
    return "inside", bodies, regions.microseconds, ", ".join(names)


def _who(effect: EffectReport) -> str:
    """`--depth; not on 2 (boxes apart), 1 (allowed)`."""
    if not effect.asked_by:
        return "not asked"
    who = listed(effect.asked_by)
    reasons = [f"{count:,} ({reason})" for reason, count in effect.not_run.items()]
    return f"{who}; not on {', '.join(reasons)}" if reasons else who


def _about(body: BodyReport) -> Iterator[tuple[str, str]]:
    if body.triangles is None:
        yield body.id, f"{body.file}: unreadable"
        return
    words = [f"{body.file}: {counted(body.triangles, 'triangle')}"]
    if body.health is not None and not body.health.closed:
        words.append("not closed")
    if body.convex is not None:
        words.append("convex" if body.convex else "concave")
    if body.resolution is not None:
        words.append(f"precision {number(body.resolution)}")
    yield body.id, ", ".join(words)
    if body.parts is not None and body.part_error is not None:
        error = body.part_error
        yield (
            "",
            f"{counted(body.parts, 'convex part')}: they stick out of the mesh by at most "
            f"{at_most(error.outside)}, and the mesh out of them by at most "
            f"{at_most(error.missing)}",
        )
