"""The lines below the table: details of pairs, then warnings and notes about the inputs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from satcheck.audit.words import (
    bounds,
    counted,
    is_unusable,
    limits,
    number,
    past_holes,
    place,
    rule_of,
    with_unit,
)
from satcheck.cli.formats.tables import YELLOW
from satcheck.cli.output import issue_line
from satcheck.report.report import (
    CROSS_CHECK,
    NO_ANSWER,
    NOT_AVAILABLE,
    OF_ANSWERS,
    ON_TRIANGLES,
)
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.report.report import BodyReport, Finding, Report

_ISSUE_STYLES = {"warning": YELLOW, "note": ""}


class Remark(NamedTuple):
    """One line, and its style (`cli/formats/tables.py`)."""

    text: str
    style: str = ""


def remarks(report: Report, shown: Sequence[Finding]) -> list[Remark]:
    """One line a pair for the touch band and for what was not decided, one a body otherwise."""
    tolerances = {body.id: body.surface_tolerance or 0.0 for body in report.bodies}
    lines = [
        Remark(line)
        for finding in shown
        for line in (
            *_band(finding, tolerances),
            *_undecided(finding, report),
            *_ruled(finding, report),
            *_moving(finding, unit_of(report.units)),
        )
    ]
    lines += [
        Remark(line) for line in (*_curved(report), *_no_opinion(report), *_of_bodies(report))
    ]
    for issue in report.issues:
        if issue.severity != "error" and issue.code not in OF_ANSWERS:
            lines.append(Remark(issue_line(issue), _ISSUE_STYLES[issue.severity]))
    return lines


def _band(finding: Finding, tolerances: Mapping[str, float]) -> list[str]:
    """What touching is without its tolerance. tolerances: of the surfaces of bodies."""
    if finding.at_rest != "touching" or finding.exact_relation in (None, "touching"):
        return []
    pair, band = f"{finding.a} and {finding.b}", number(finding.tolerance or 0.0)
    if finding.exact_relation == "separated":
        return [f"{pair} are apart, but by no more than the tolerance {band}"]
    off = max(tolerances.get(id_, 0.0) for id_ in (finding.a, finding.b))
    if off > 0.5 * (finding.tolerance or 0.0):
        return [f"{pair} overlap, but no deeper than their surfaces may be off"]
    return [f"{pair} overlap, but by no more than the tolerance {band}"]


def _undecided(finding: Finding, report: Report) -> list[str]:
    """The reason, unless a line on the body or the summary says it for many pairs at once."""
    capped = finding.quality == "estimate" and report.settings.accuracy != "exact"
    said = finding.undecided in ("limit", "motion") or finding.quality in ("exact", "bounded")
    if finding.reason is None or capped or said:
        return []
    return [f"{finding.a} and {finding.b}: {finding.reason}"]


def _ruled(finding: Finding, report: Report) -> list[str]:
    """What a rule of the scene made of the pair."""
    pair = f"{finding.a} and {finding.b}"
    if finding.undecided == "limit":
        return [f"{pair}: {finding.reason}"]
    if all(rule.name != finding.rule for rule in report.rules):
        return []
    rule = rule_of(finding, report)
    why = f" ({rule.reason})" if rule is not None and rule.reason else ""
    said = [f"{pair}: {finding.severity} by {finding.rule}", *limits(finding, report)]
    return [f"{', '.join(said)}{why}"]


def _moving(finding: Finding, unit: str | None) -> list[str]:
    """The worst pose of bodies that hit while they move, and what a sweep left open."""
    swept, pair = finding.motion, f"{finding.a} and {finding.b}"
    if swept is None:
        return []
    if swept.reason is not None:
        return [f"{pair}, while they move: {swept.reason}"]
    if swept.worst is None or swept.worst.depth is None:
        return []
    where = ", ".join(place(at, unit) for at in swept.worst.at)
    deep = with_unit(bounds(*swept.worst.depth), unit)
    return [f"{pair}, while they move: deepest at {where}, {deep}"]


def _curved(report: Report) -> Iterator[str]:
    """A line for each effect that curved shapes do not have, on all of their pairs."""
    if not any(effect.asked_by and effect.effect in ON_TRIANGLES for effect in report.effects):
        return
    pairs = Counter(
        stage.stage
        for finding in report.findings
        for stage in finding.plan
        if stage.result == NOT_AVAILABLE
    )
    for effect, count in pairs.items():
        where = counted(count, "pair")
        yield f"{effect}: not known of {where} with a curved shape, which has no triangles"


def _no_opinion(report: Report) -> Iterator[str]:
    """A line for each reason why another library gave no answer, on all of its pairs."""
    pairs = Counter(
        stage.detail
        for finding in report.findings
        for stage in finding.plan
        if stage.stage == CROSS_CHECK and stage.result == NO_ANSWER
    )
    for why, count in pairs.items():
        yield f"cross-check: no answer on {counted(count, 'pair')}: {why}"


def _of_bodies(report: Report) -> Iterator[str]:
    """A line for each body that something was left out for."""
    pairs: Counter[str] = Counter()
    swept: Counter[str] = Counter()
    for finding in report.findings:
        for id_ in (finding.a, finding.b):
            pairs[id_] += 1
            swept[id_] += past_holes(finding)
    for body in report.bodies:
        yield from _body(body, pairs[body.id], swept[body.id])


def _body(body: BodyReport, pairs: int, swept: int) -> list[str]:
    if is_unusable(body):
        return [f"{body.id}: could not be used, its {counted(pairs, 'pair')} not checked"]
    if body.health is None or not body.health.holes or not swept:
        return []
    verb = "moves" if swept == 1 else "move"
    return [
        f"{body.id} has holes: {counted(swept, 'pair')} {verb} past them, and they may be filled"
    ]
