"""What follows from proven findings: their severities, and the summary of the report.

That an overlap is within its limit, or a gap keeps its clearance, has to be proven. That it is not
follows from the figures of the finding. Volumes are not certified.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from fractions import Fraction
from math import inf

from msgspec.structs import replace

from satcheck.report.judge import by_rule, disputed, judged
from satcheck.report.report import (
    CROSS_CHECK,
    EFFECTS,
    OVERLAPS,
    Finding,
    PairCounts,
    Report,
    Summary,
)
from satcheck.report.verdict import fails, summarise
from satcheck.verify.distances import Claim, keeps
from satcheck.verify.exact import Rejected
from satcheck.verify.figures import EXACT_WIDTH

WIDER = 1 + EXACT_WIDTH  # the share of a limit that rounding is granted


def check_severity(claim: Claim, depth: Fraction | None, thickness: Fraction | None) -> None:
    """Rejects a severity, a rule or an `undecided` that does not follow. depth, thickness: proven
    upper bounds; None: there is none."""
    finding, request = claim.finding, claim.request
    kept, overlap = None, finding.relation in OVERLAPS
    if request.clearance and not overlap and finding.relation != "near":
        kept = keeps(claim)
    judgement = judged(finding, replace(request, severity=None), (0.0, inf), kept)
    if overlap and judgement.severity == "note":
        limits = request.max_depth, request.max_thickness, request.max_volume
        for limit, bound in zip(limits, (depth, thickness, None), strict=True):
            if limit is not None and not (bound is not None and bound <= Fraction(limit) * WIDER):
                raise Rejected("that it is within its limits is not certified")
    judgement = by_rule(judgement, request)
    if any(stage.stage == CROSS_CHECK and stage.result == "disagrees" for stage in finding.plan):
        judgement = disputed(judgement, None)
    follows = judgement.severity, judgement.undecided, judgement.rule
    if (finding.severity, finding.undecided, finding.rule) != follows:
        raise Rejected(
            f"its severity is {judgement.severity!r} by the rule {judgement.rule!r}, "
            f"and what is undecided {judgement.undecided!r}"
        )


def check_summary(
    report: Report,
    findings: Sequence[Finding],
    counted: tuple[int, int],
    pruned: int,
    listed_apart: int,
    left_open: int,
) -> None:
    """counted: the pairs, and the allowed ones. pruned: pairs without a finding whose boxes are
    apart. listed_apart: pairs with one whose boxes may be apart. left_open: pairs without a finding
    that nothing decides."""
    total, allowed = counted
    stated, bodies = report.summary.pairs, len(report.bodies)
    indeterminate = left_open + sum(f.relation == "indeterminate" for f in findings)
    pairs = PairCounts(
        total=total,
        pruned=stated.pruned,
        decided=total - allowed - indeterminate - stated.pruned,
        allowed=allowed,
        indeterminate=indeterminate,
        exempt=bodies * (bodies - 1) // 2 - total,
    )
    for key in ("total", "allowed", "indeterminate", "exempt"):
        if (count := getattr(stated, key)) != (follows := getattr(pairs, key)):
            raise Rejected(f"the summary counts {count!r} pairs as {key}, not {follows!r}")
    if stated.pruned != pruned and not (pruned == 0 and stated.pruned <= listed_apart):
        raise Rejected("the summary's count of pruned pairs is not that of the boxes apart")
    summary = replace(report.summary, pairs=pairs)
    expected = summarise(replace(report, findings=tuple(findings), summary=summary))
    for key in Summary.__struct_fields__:
        if getattr(report.summary, key) != (follows := getattr(expected, key)):
            raise Rejected(f"the summary's {key} that follows from the findings is {follows!r}")
    _check_effects(report, total)
    truncated = report.truncated
    if (0 if truncated is None else truncated.pairs) != pruned + left_open:
        raise Rejected(f"the findings leave out {pruned + left_open} pairs")
    for finding in findings:  # those that fail have a state if there is a baseline, and no others
        has_state = report.baseline is not None and fails(finding, report.settings.fail_on)
        if report.baseline and finding.undecided and finding.baseline_state == "accepted":
            continue
        if (finding.baseline_state is not None) != has_state:
            raise Rejected(f"{finding.a} and {finding.b}: the baseline_state is out of place")


def _check_effects(report: Report, total: int) -> None:
    names = Counter(effect.effect for effect in report.effects)
    expected = set(EFFECTS) if report.motions else set(EFFECTS) - {"sweep"}
    if names.keys() != expected or names.total() > len(names):
        raise Rejected("the list of effects has each of them once")
    for effect in report.effects:
        if effect.pairs + sum(effect.not_run.values()) != total:
            raise Rejected(f"the pairs of the effect {effect.effect} are not all pairs")
