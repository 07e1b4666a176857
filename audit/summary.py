"""The summary of a report, and its other parts that are not about one pair."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from msgspec import Struct, convert, to_builtins

from satcheck._version import __version__
from satcheck.audit.acceptance import with_states
from satcheck.audit.bodies.placed_bodies import PlacedBodies, UnusableBody
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.severity import is_failure, is_unmet
from satcheck.core.errors import SatcheckError
from satcheck.core.shapes import values_of
from satcheck.report.bodies import Health, StatedShape
from satcheck.report.report import (
    NOTHING_TO_CHECK,
    NOTHING_TO_COMPARE,
    RELATIONS,
    BodyAnswer,
    BodyReport,
    Exempt,
    Finding,
    Issue,
    PairCounts,
    PartError,
    Relation,
    Report,
    RuleReport,
    Summary,
    Tool,
    Truncated,
    Verdict,
)
from satcheck.report.settings import StatedReading
from satcheck.scene.bodies import Accepted
from satcheck.scene.loading.readers import stated_options

if TYPE_CHECKING:
    from satcheck.audit.request.settings import FailOn
    from satcheck.scene import Scene
    from satcheck.scene.rules import Rule


def tool() -> Tool:
    return Tool("satcheck", __version__)


def count(
    bodies: PlacedBodies, close: Sequence[Finding], findings: Sequence[Finding]
) -> PairCounts:
    """close: of the pairs that the broad phase kept. Raises RuntimeError if a pair is missing."""
    undecidable, left_open = bodies.undecidable_count, _indeterminate(close)
    total, allowed = bodies.book.count()
    number = len(bodies.ids)
    counts = PairCounts(
        total=total,
        pruned=total - allowed - undecidable - len(close),
        decided=len(close) - left_open,
        allowed=allowed,
        indeterminate=undecidable + left_open,
        exempt=number * (number - 1) // 2 - total,
    )
    unlisted_open = unlisted_indeterminate(counts, findings)
    unlisted_apart = _unlisted(counts, findings) - unlisted_open
    if min(counts.pruned, unlisted_open) < 0 or unlisted_apart not in (0, counts.pruned):
        raise RuntimeError(f"pairs do not add up: {counts}, {len(findings)} findings")
    return counts


def _indeterminate(findings: Iterable[Finding]) -> int:
    return sum(finding.relation == "indeterminate" for finding in findings)


def _unlisted(counts: PairCounts, findings: Sequence[Finding]) -> int:
    """The number of checked pairs without a finding."""
    return counts.asked - len(findings)


def unlisted_indeterminate(counts: PairCounts, findings: Sequence[Finding]) -> int:
    """The number of undecidable pairs without a finding."""
    return counts.indeterminate - _indeterminate(findings)


def summarise(
    counts: PairCounts,
    findings: Sequence[Finding],
    fail_on: FailOn,
    *,
    issues: Sequence[Issue] = (),
    alone: bool = False,
    answers: Sequence[BodyAnswer] = (),
) -> Summary:
    """alone: no pair has to be checked, because the scene is one usable body, or because rules ask
    for regions only. answers: to questions about single bodies."""
    by_relation: Counter[Relation] = Counter(finding.relation for finding in findings)
    unlisted_open = unlisted_indeterminate(counts, findings)
    by_relation["separated"] += _unlisted(counts, findings) - unlisted_open
    by_relation["indeterminate"] += unlisted_open
    undecided = Counter(finding.undecided for finding in findings)
    return Summary(
        verdict=_worse(_verdict(counts, findings, fail_on, issues, alone=alone), answers, fail_on),
        pairs=counts,
        by_relation={relation: by_relation[relation] for relation in RELATIONS},
        surfaces_only=undecided["inside"],
        limits_undecided=undecided["limit"],
        sweeps_undecided=undecided["motion"],
        disputed=undecided["cross-check"],
    )


def verdict_of(report: Report) -> Verdict:
    """The verdict of a report beside a baseline, which can only excuse findings."""
    summary = report.summary
    if summary.verdict == "pass":
        return "pass"
    fail_on = report.settings.fail_on
    alone = bool(report.regions)
    verdict = _verdict(summary.pairs, report.findings, fail_on, report.issues, alone=alone)
    return _worse(verdict, report.answers, fail_on)


def _verdict(
    counts: PairCounts,
    findings: Sequence[Finding],
    fail_on: FailOn,
    issues: Sequence[Issue],
    *,
    alone: bool,
) -> Verdict:
    """A failure stays a failure even if other pairs are undecided. A check without pairs never
    passes. A finding that a baseline contains, unchanged, does not fail."""
    if any(is_failure(finding, fail_on) for finding in findings):
        return "fail"
    unchecked = (
        unlisted_indeterminate(counts, findings)
        or any(finding.undecided is not None for finding in findings)
        or any(issue.state == "blocking" for issue in issues)
    )
    return "incomplete" if unchecked or not (counts.asked or alone) else "pass"


def _worse(verdict: Verdict, answers: Sequence[BodyAnswer], fail_on: FailOn) -> Verdict:
    """The verdict on pairs and on single bodies together."""
    if any(is_unmet(answer, fail_on) for answer in answers):
        return "fail"
    is_open = any(answer.answer == "open" for answer in answers)
    return "incomplete" if is_open and verdict == "pass" else verdict


def body_reports(bodies: PlacedBodies) -> tuple[BodyReport, ...]:
    meshes = {id(body.shared): body.shared for body in bodies.placed.values()}
    health = {key: convert(to_builtins(mesh.file.health), Health) for key, mesh in meshes.items()}
    return tuple(
        _unusable_report(bodies.unusable[k])
        if k in bodies.unusable
        else _body_report(bodies.placed[k], health[id(bodies.placed[k].shared)])
        for k in range(len(bodies.ids))
    )


def _unusable_report(body: UnusableBody) -> BodyReport:
    return BodyReport(
        id=body.id,
        name=body.id,
        file=body.file,
        sha256=None,
        path=body.path,
        transform=None,
        groups=body.groups,
        static=body.static,
        triangles=None,
        health=None,
        resolution=None,
        convex=None,
        parts=None,
        part_error=None,
    )


def _body_report(body: PlacedBody, health: Health) -> BodyReport:
    file, given = body.body.file, body.body.as_given or body.body
    known = body.shared.decomposition.known
    parts = None if isinstance(known, SatcheckError) else known
    return BodyReport(
        id=body.id,
        name=body.body.name,
        file=file.path,
        sha256=file.sha256,
        path=body.body.path,
        transform=None if given.transform is None else tuple(map(float, given.transform)),
        units=body.body.units,
        unit_scale=body.body.unit_scale,
        groups=body.body.groups,
        static=body.body.static,
        triangles=file.mesh.triangle_count,
        health=health,
        resolution=body.resolution,
        surface_tolerance=body.surface_tolerance or None,
        convex=body.shared.geometry.known_convex,
        parts=None if parts is None else len(parts.parts),
        part_error=None if parts is None else PartError(parts.outside, parts.missing),
        shape=stated_shape(given.shape),
    )


def stated_reading(scene: Scene) -> StatedReading | None:
    """The options that count for the formats of the files in the scene."""
    stated = stated_options(scene.reading, {body.file.format for body in scene.bodies})
    return None if stated is None else StatedReading(**stated)


def stated_shape(shape: Struct | None) -> StatedShape | None:
    return None if shape is None else convert(values_of(shape), StatedShape)


def rule_reports(rules: Iterable[Rule]) -> tuple[RuleReport, ...]:
    return tuple(
        RuleReport(
            a=rule.a.text,
            b=rule.b.text,
            allowed=rule.allowed,
            max_depth=rule.max_depth,
            max_thickness=rule.max_thickness,
            max_volume=rule.max_volume,
            clearance=rule.clearance,
            tolerance=rule.tolerance,
            severity=rule.severity,
            reason=rule.reason,
            where=rule.where,
        )
        for rule in rules
    )


def exempt_of(scene: Scene) -> Exempt:
    return Exempt(
        groups=tuple(sorted(scene.ignore_within_groups)), static_pairs=not scene.check_static
    )


def truncated_of(counts: PairCounts, findings: Sequence[Finding]) -> Truncated | None:
    """The findings that the report leaves out."""
    left_out = _unlisted(counts, findings)
    if not left_out:
        return None
    unlisted_open = unlisted_indeterminate(counts, findings)
    why = ", or nothing decides them, as a body cannot be used or compared" if unlisted_open else ""
    return Truncated(left_out, f"their boxes are apart{why}")


def issues_of(
    scene: Scene,
    bodies: PlacedBodies,
    counts: PairCounts,
    of_pairs: Iterable[Issue],
    accept: Sequence[str],
) -> tuple[Issue, ...]:
    """The issues of the input, then those of the run; each once. accept: those that block nothing,
    beside those that the scene accepts."""
    issues = [
        Issue(issue.code, issue.severity, issue.body, issue.file, issue.message)
        for issue in scene.issues
    ]
    asks = counts.asked or scene.asks_for_regions or scene.asks_for_support
    lone = len(bodies.ids) == 1
    empty = [] if asks or lone else [_nothing_to_check(scene, bodies, counts)]
    once = dict.fromkeys((*issues, *bodies.issues, *empty, *of_pairs))
    return tuple(with_states(once, (*scene.accept, *map(Accepted, accept))))


def _nothing_to_check(scene: Scene, bodies: PlacedBodies, counts: PairCounts) -> Issue:
    """Return why no pair was checked."""
    if not bodies.ids:
        message = "nothing to compare: no body can collide"
        return Issue(NOTHING_TO_COMPARE, "note", None, None, message)
    in_link = sum(robot.pairs_within_links for robot in scene.robots)
    static_bodies = 0 if scene.check_static else sum(body.static for body in scene.in_order())
    static, in_group = exempt_by(counts, static_bodies)
    why = {
        "within one link": in_link,
        "allowed by rules": counts.allowed - in_link,
        "of static bodies": static,
        "within ignored groups": in_group,
    }
    said = ", ".join(f"{count:,} {what}" for what, count in why.items() if count)
    return Issue(NOTHING_TO_CHECK, "warning", None, None, f"no pair was checked: {said}")


def exempt_by(counts: PairCounts, static_bodies: int) -> tuple[int, int]:
    """The numbers of exempt pairs of static bodies, and of exempt pairs within ignored groups.
    static_bodies: 0 if pairs of static bodies are checked."""
    static = static_bodies * (static_bodies - 1) // 2
    return static, counts.exempt - static
