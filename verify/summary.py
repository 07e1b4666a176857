"""Whether the summary of a report follows from its findings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from satcheck.report.report import EFFECTS, Finding, PairCounts, Report, Summary
from satcheck.report.verdict import fails, summarise
from satcheck.verify.exact import Rejected


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
    fail_on = report.settings.fail_on
    expected = summarise(
        pairs,
        findings,
        fail_on,
        issues=report.issues,
        alone=report.alone,
        answers=report.answers,
    )
    for key in Summary.__struct_fields__:
        if getattr(report.summary, key) != (follows := getattr(expected, key)):
            raise Rejected(f"the summary's {key} that follows from the findings is {follows!r}")
    _check_effects(report, total)
    truncated = report.truncated
    if (0 if truncated is None else truncated.pairs) != pruned + left_open:
        raise Rejected(f"the findings leave out {pruned + left_open} pairs")
    for finding in findings:  # those that fail have a state if there is a baseline, and no others
        has_state = report.baseline is not None and fails(finding, fail_on)
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
