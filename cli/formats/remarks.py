"""The lines below the table: details of pairs, then warnings and notes about the inputs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from satcheck.audit.bodies import UNUSED_RULE
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
from satcheck.cli.formats.summary import MESHES, issues_to_tell
from satcheck.cli.formats.tables import YELLOW, fitted, fitted_each
from satcheck.cli.output import issue_line
from satcheck.report.report import (
    CROSS_CHECK,
    NO_ANSWER,
    NOT_AVAILABLE,
    NOTHING_TO_CHECK,
    OF_ANSWERS,
    ON_TRIANGLES,
)
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.cli.output import Page
    from satcheck.report.report import Finding, Report

_ISSUE_STYLES = {"warning": YELLOW, "note": ""}


# Lines on pairs, and issues of one code.
MOST = 10
ALIKE = 3


def remarks(report: Report, shown: Sequence[Finding], page: Page) -> list[str]:
    """One line for pairs of which the same is to be said, one a body, one for meshes that are not
    in order and decide nothing."""
    pairs: dict[str, list[str]] = {}
    unit = unit_of(report.units)
    for finding in shown:
        said = (*_band(finding, report), *_undecided(finding, report), *_ruled(finding, report))
        for text in (*said, *_moving(finding, unit)):
            pairs.setdefault(text, []).append(f"{finding.a} and {finding.b}")
    lines = [
        f"{about[0] if len(about) == 1 else counted(len(about), 'pair')}: {text}"
        for text, about in pairs.items()
    ]
    if (more := len(lines) - MOST) > 0:
        lines[MOST:] = [f"{counted(more, 'more remark')} on pairs: JSON has all"]
    lines += [*_curved(report), *(_no_opinion(report) if report.settings.cross_check else ())]
    lines += _of_bodies(report)
    return [*fitted_each(lines, page), *_issues(report, shown, page)]


def _band(finding: Finding, report: Report) -> Iterator[str]:
    """What touching is without its tolerance."""
    if finding.at_rest != "touching" or finding.exact_relation in (None, "touching"):
        return
    band = f"no more than the tolerance {number(finding.tolerance or 0.0)}"
    off = [b.surface_tolerance or 0.0 for b in report.bodies if b.id in (finding.a, finding.b)]
    if finding.exact_relation == "separated":
        yield f"apart, but by {band}"
    elif max(off, default=0.0) > 0.5 * (finding.tolerance or 0.0):
        yield "overlapping, but no deeper than their surfaces may be off"
    else:
        yield f"overlapping, but by {band}"


def _undecided(finding: Finding, report: Report) -> Iterator[str]:
    """The reason, unless a line on the body or the summary says it for many pairs at once."""
    capped = finding.quality == "estimate" and report.settings.accuracy != "exact"
    is_told = finding.undecided in ("limit", "motion") or finding.quality in ("exact", "bounded")
    if finding.reason is not None and not (capped or is_told):
        yield finding.reason


def _ruled(finding: Finding, report: Report) -> Iterator[str]:
    """What a rule of the scene made of the pair."""
    if finding.undecided == "limit":
        yield finding.reason or ""
    elif any(rule.name == finding.rule for rule in report.rules):
        rule = rule_of(finding, report)
        why = f" ({rule.reason})" if rule is not None and rule.reason else ""
        said = [f"{finding.severity} by {finding.rule}", *limits(finding, report)]
        yield f"{', '.join(said)}{why}"


def _moving(finding: Finding, unit: str | None) -> Iterator[str]:
    """The worst pose of bodies that hit while they move, and what a sweep left open."""
    swept = finding.motion
    if swept is None:
        return
    if swept.reason is not None:
        yield f"in motion: {swept.reason}"
    elif swept.worst is not None and swept.worst.depth is not None:
        where = ", ".join(place(at, unit) for at in swept.worst.at)
        yield f"deepest at {where}: {with_unit(bounds(*swept.worst.depth), unit)}"


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
        if is_unusable(body):
            lost = counted(pairs[body.id], "pair")
            yield f"{body.id}: could not be used, its {lost} not checked"
        elif body.health is not None and body.health.holes and swept[body.id]:
            moving = counted(swept[body.id], "pair moves", "pairs move")
            if body.health.doubtful:
                yield f"{body.id} has parts that may be solid or cavities: {moving} past them"
            else:
                yield f"{body.id} has holes: {moving} past them, and they may be filled"


def _issues(report: Report, shown: Sequence[Finding], page: Page) -> Iterator[str]:
    """The first issues of a kind, and how many more there are; in one line the meshes that no
    listed pair depends on."""
    ids = {id_ for finding in shown for id_ in (finding.a, finding.b)}
    files = {body.file for body in report.bodies if body.id in ids}
    told: Counter[str] = Counter()
    more: Counter[str] = Counter()
    idle: Counter[str] = Counter()
    unused = 0
    for issue in issues_to_tell(report):
        if issue.severity == "error" or issue.code in (*OF_ANSWERS, NOTHING_TO_CHECK):
            continue
        if issue.code == UNUSED_RULE and issue.severity == "note":
            unused += 1
            continue
        is_mesh = issue.code in MESHES
        in_rows = issue.body in ids if issue.body else issue.file in files
        kind = "mesh" if is_mesh else issue.code
        told[kind] += not is_mesh or in_rows
        if is_mesh and not in_rows:
            idle[issue.code] += 1
        elif told[kind] <= ALIKE:
            yield from fitted(issue_line(issue), page, _ISSUE_STYLES[issue.severity])
        else:
            more[issue.code] += 1
    if more:
        yield from fitted(f"{codes_counted(more)} more: JSON has all", page)
    if idle:
        yield from fitted(f"{codes_counted(idle)}; none mattered", page)
    if unused:
        yield from fitted(f"{counted(unused, 'suggested rule')} about no pair of bodies here", page)


def codes_counted(codes: Counter[str]) -> str:
    """`19 open meshes, 2 [far-vertex]`"""
    counts = ((count, MESHES.get(code, (f"[{code}]",) * 2)) for code, count in codes.items())
    return ", ".join(counted(count, *words) for count, words in counts)
