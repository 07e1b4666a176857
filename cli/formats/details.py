"""Lines below a table: the support of bodies, overlaps by component, bodies in regions, and with
`--explain` what was computed and why, the known facts of each body, the trace of each pair."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from satcheck.audit.words import (
    at_most,
    counted,
    duration,
    interval,
    number,
    stated,
    vector,
    with_unit,
)
from satcheck.cli.formats.tables import BOLD, BOLD_RED, YELLOW, aligned, fitted
from satcheck.report.part_pairs import number_of
from satcheck.scene.units import unit_of
from satcheck.scene.words import listed

if TYPE_CHECKING:
    from satcheck.cli.output import Page
    from satcheck.report.contacts import Component
    from satcheck.report.part_pairs import PartPair, PartPairs
    from satcheck.report.regions import InsideFinding, Regions
    from satcheck.report.report import BodyReport, EffectReport, Finding, Report
    from satcheck.report.statics import BodyIsland, Statics, SupportedBody, SupportFinding

MOST_BODIES = 40  # JSON has them all
MOST_LINKS = 5  # of a chain
_RANK = {"no": 0, "open": 1, "yes": 2}
_WORDS = {"yes": "{}", "no": "not {}", "open": "{} is open"}
_STYLES = {"no": BOLD_RED, "open": YELLOW, "yes": ""}

MOST_COMPONENTS = 8  # of each pair; JSON has them all
MOST_PART_PAIRS = 8
# What was computed, its pairs or result, microseconds (None: none), and more about it.
_Row = tuple[str, str, float | None, str]


def support_lines(statics: Statics, units: str | None, page: Page) -> list[str]:
    """The lines between the table and the remarks."""
    lines = fitted(f"Support: {', '.join(_assumptions(statics, units))}", page, BOLD)
    bodies = {body.id: body for body in statics.bodies}
    answers = _by_body(statics)
    for body, findings in answers[:MOST_BODIES]:
        stated = bodies.get(body)
        number = None if stated is None else stated.island
        island = None if number is None else statics.islands[number]
        style = _style(findings)
        lines += fitted(f"  {_answers(body, findings, stated, island)}", page, style)
    return lines + _more(len(answers) - MOST_BODIES, "and {}", "more body", "more bodies")


def _by_body(statics: Statics) -> list[tuple[str, list[SupportFinding]]]:
    """The findings of each body, the worst first."""
    groups = [(body, list(of)) for body, of in groupby(statics.findings, key=lambda f: f.body)]
    for _, findings in groups:
        findings.sort(key=lambda f: _RANK[f.answer])
    return sorted(groups, key=lambda group: _RANK[group[1][0].answer])


def _answers(
    body: str,
    findings: list[SupportFinding],
    stated: SupportedBody | None,
    island: BodyIsland | None,
) -> str:
    """`top: not stable: no forces hold it; held by base; chain: top, base, floor`."""
    said = ", ".join(_WORDS[f.answer].format(f.question) for f in findings)
    reasons = dict.fromkeys(f.reason for f in findings if f.reason)
    parts = [f"{body}: {said}", *reasons]
    if stated is not None:
        parts += _held(stated)
    if island is not None:
        parts += _margins(island)
    return "; ".join(map(str, parts))


def _style(findings: list[SupportFinding]) -> str:
    if any(finding.severity == "warning" for finding in findings):
        return YELLOW
    return _STYLES[findings[0].answer]


def _margins(island: BodyIsland) -> Iterator[str]:
    """Of the island as a whole."""
    if island.margin is not None:
        yield f"tilt {_degrees(*island.margin)}"
    if island.least_friction:
        yield f"friction from {island.least_friction:.2g}"


def _degrees(low: float, high: float) -> str:
    """`1.5 deg`, or `24 to 26 deg`."""
    near, far = f"{low:.3g}", f"{high:.3g}"
    return f"{near} deg" if near == far else f"{near} to {far} deg"


def _held(body: SupportedBody) -> Iterator[str]:
    if body.fixed is not None:
        yield body.fixed
    elif len(body.chain) > 1:
        links = body.chain[1:]
        shown = " > ".join(links[:MOST_LINKS])
        yield f"chain: {shown}" + (" > ..." if len(links) > MOST_LINKS else "")


def _assumptions(statics: Statics, units: str | None) -> Iterator[str]:
    unit = unit_of(units)
    values = {
        "gravity": vector(statics.gravity),
        "friction": stated(statics.friction),
        "tolerance": with_unit(number(statics.tolerance), unit),
    }
    for name, value in values.items():
        yield f"{name} {value}" + ("" if name in statics.stated else " (assumed)")


def component_lines(page: Page, findings: Sequence[Finding]) -> list[str]:
    """The lines between the table and the remarks."""
    lines: list[str] = []
    for finding in findings:
        if finding.components is None or not (items := finding.components.items):
            continue
        title = f"{finding.a} and {finding.b}: {counted(len(items), 'connected overlap')}"
        title += "" if finding.components.resolved else ", perhaps not all"
        lines += fitted(title, page, BOLD)
        for item in items[:MOST_COMPONENTS]:
            lines += fitted("  " + ", ".join(facts(item, finding)), page)
        lines += _more(len(items) - MOST_COMPONENTS, "{}", "thinner one")
    return lines


def facts(item: Component, finding: Finding) -> Iterator[str]:
    if item.thickness_bounds is None:
        yield "thickness not known"
    else:
        yield f"{interval(item.thickness_bounds)} thick"
    yield f"at {vector(item.point)}"
    if item.volume is not None:
        yield f"volume {number(item.volume)}"
    if item.passes in ("a-through-b", "both"):
        yield f"{finding.a} passes through {finding.b}"
    if item.passes in ("b-through-a", "both"):
        yield f"{finding.b} passes through {finding.a}"


def part_lines(page: Page, findings: Sequence[Finding]) -> list[str]:
    """The lines between the table and the remarks: the deepest pairs of parts of each pair. What
    several pairs have in common is said once."""
    split = [(finding, found) for finding in findings if (found := finding.part_pairs)]
    lines: list[str] = []
    without: dict[str, int] = {}  # pairs of bodies, by why they have no parts
    unlisted = 0
    for finding, found in split:
        if not found.known and found.remark is not None:
            without[found.remark] = without.get(found.remark, 0) + 1
        elif found.pairs or found.remark is not None or found.untested or len(split) == 1:
            lines += _parts_of(finding, found, page)
        else:
            unlisted += 1
    if unlisted:
        lines += fitted(f"{counted(unlisted, 'pair')} with no parts that overlap", page)
    for why, count in without.items():
        said = why if len(split) == 1 else f"{why} ({counted(count, 'pair')})"
        lines += fitted(said, page, YELLOW)
    return lines


def _parts_of(finding: Finding, found: PartPairs, page: Page) -> list[str]:
    first, second = counted(found.parts[0], "convex part"), found.parts[1]
    verb = "overlaps" if found.overlapping == 1 else "overlap"
    said = f"{counted(found.overlapping, 'pair')} of parts {verb}"
    if not found.overlapping:
        is_open = found.undecided or found.untested
        said = "no overlap of parts was found" if is_open else "no parts overlap"
    lines = fitted(f"{finding.a} ({first}) and {finding.b} ({second:,}): {said}", page, BOLD)
    rows = [_part_row(pair, finding) for pair in found.pairs[:MOST_PART_PAIRS]]
    lines += aligned(rows, page) if rows else []
    rest = found.overlapping + found.touching + found.undecided
    lines += _more(rest - min(len(found.pairs), MOST_PART_PAIRS), "{}", "more pair")
    lines += _more(found.untested, "{} of parts not tested", "pair")
    if found.remark is not None:
        lines += fitted(f"  {found.remark}", page, YELLOW)
    return lines


def _part_row(pair: PartPair, finding: Finding) -> tuple[str, ...]:
    """`kettle#3 x snowflake#1  penetrating  depth 0.31  axis (0, 0, 1)  gjk+epa, 7 iterations`."""
    a, b = f"{finding.a}#{number_of(pair.a)}", f"{finding.b}#{number_of(pair.b)}"
    steps = {"axis": pair.axes_tested, "iteration": pair.iterations}
    names = {"axis": "axes", "iteration": "iterations"}
    by = [counted(count, name, names[name]) for name, count in steps.items() if count]
    return (
        f"{a} x {b}",
        pair.relation,
        f"depth {number(pair.depth)}" if pair.depth else "",
        "" if pair.axis is None else f"axis {vector(pair.axis)}",
        ", ".join([pair.method, *by]),
    )


def region_lines(regions: Regions, units: str | None, page: Page) -> list[str]:
    """A line for each region with the number of bodies in it, and one for each other body."""
    lines = []
    findings = sorted(regions.findings, key=lambda finding: finding.region)
    for region, group in groupby(findings, key=lambda finding: finding.region):
        own = list(group)
        count = sum(finding.answer == "yes" for finding in own)
        tolerance = with_unit(number(regions.tolerance), unit_of(units))
        said = f"Inside {region}: {count} of {counted(len(own), 'body', 'bodies')}"
        lines += fitted(f"{said} (tolerance {tolerance})", page, BOLD)
        lines += _others(own, page)
    return lines


def _others(findings: list[InsideFinding], page: Page) -> Iterator[str]:
    """Bodies that are outside first."""
    others = [finding for finding in findings if finding.answer != "yes"]
    others.sort(key=lambda finding: finding.answer)  # no before open
    for finding in others[:MOST_BODIES]:
        state = "not inside" if finding.answer == "no" else "open"
        style = BOLD_RED if finding.answer == "no" else YELLOW
        yield from fitted(f"  {finding.body}: {state}: {finding.reason}", page, style)
    yield from _more(len(others) - MOST_BODIES, "and {}", "more body", "more bodies")


def _more(count: int, words: str, *names: str) -> list[str]:
    """Return a line about those that are not shown; nothing for none."""
    return [f"  {words.format(counted(count, *names))}"] if count > 0 else []


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
        trace = [(s.stage, s.result, s.microseconds, s.detail) for s in finding.plan]
        lines += ["", *fitted(title, page, BOLD)]
        lines += aligned(_rows(trace, timings=timings), page, bold=False)
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
