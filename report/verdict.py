"""The summary and the verdict of a report, as they follow from its findings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from satcheck.report.baseline import HELD
from satcheck.report.report import (
    RELATIONS,
    SEVERITIES,
    BodyAnswer,
    Finding,
    PairCounts,
    Relation,
    Report,
    Severity,
    Summary,
    Truncated,
    Verdict,
)
from satcheck.report.settings import FailOn
from satcheck.report.statics import State

_RANK = {severity: place for place, severity in enumerate(SEVERITIES)}


def fails(finding: Finding, fail_on: FailOn) -> bool:
    """Return whether the finding is decided and at least as grave as `fail_on`. An error always
    counts as decided."""
    decided = finding.undecided is None or finding.severity == "error"
    return decided and _RANK[finding.severity] <= _RANK[fail_on]


def is_failure(finding: Finding, fail_on: FailOn) -> bool:
    """Return whether the check fails by it: a baseline does not hold it."""
    return fails(finding, fail_on) and finding.baseline_state not in HELD


def severity(finding: Finding) -> Severity:
    """Return its severity for the check: a finding that a baseline holds is a note."""
    return "note" if finding.baseline_state in HELD else finding.severity


def is_unmet(finding: BodyAnswer, fail_on: FailOn) -> bool:
    """Return whether the check fails by the answer to a question about a single body."""
    return finding.answer != "open" and _RANK[finding.severity] <= _RANK[fail_on]


def severity_of_answer(answer: State, own: str | None) -> Severity:
    """Return the severity of an answer to a question about a single body, without a doubt. own: the
    severity that rules give the errors of the body."""
    if answer == "yes":
        return "none"
    if answer == "open":
        return "error" if own == "error" else "warning"
    return "silenced" if own == "none" else own or "error"  # type: ignore[return-value]


def unlisted_indeterminate(counts: PairCounts, findings: Sequence[Finding]) -> int:
    """Return the number of undecidable pairs without a finding."""
    return counts.indeterminate - sum(f.relation == "indeterminate" for f in findings)


def summarise(report: Report) -> Summary:
    """Return the summary that follows from the rest of a report, and from its counts of pairs."""
    counts, findings, answers = report.summary.pairs, report.findings, report.answers
    fail_on = report.settings.fail_on
    by_relation: Counter[Relation] = Counter(finding.relation for finding in findings)
    unlisted_open = unlisted_indeterminate(counts, findings)
    by_relation["separated"] += counts.asked - len(findings) - unlisted_open
    by_relation["indeterminate"] += unlisted_open
    undecided = Counter(finding.undecided for finding in findings)
    verdict: Verdict = "pass"
    if any(is_failure(f, fail_on) for f in findings) or any(is_unmet(a, fail_on) for a in answers):
        verdict = "fail"  # even if other pairs are undecided
    elif (
        unlisted_open
        or any(f.undecided is not None and f.baseline_state != "accepted" for f in findings)
        or not (counts.asked or report.alone)  # a check without pairs never passes
        or any(answer.answer == "open" for answer in answers)
        or any(issue.state == "blocking" for issue in report.issues)
    ):
        verdict = "incomplete"
    return Summary(
        verdict=verdict,
        pairs=counts,
        by_relation={relation: by_relation[relation] for relation in RELATIONS},
        surfaces_only=undecided["inside"],
        limits_undecided=undecided["limit"],
        sweeps_undecided=undecided["motion"],
        disputed=undecided["cross-check"],
        accepted=sum(finding.baseline_state in HELD for finding in findings),
    )


def truncated_of(counts: PairCounts, findings: Sequence[Finding]) -> Truncated | None:
    """Return what the findings of the report leave out."""
    left_out = counts.asked - len(findings)
    if not left_out:
        return None
    unlisted_open = unlisted_indeterminate(counts, findings)
    why = "their boxes are apart"
    if unlisted_open:
        why += ", or nothing decides them: a body cannot be used or compared, or so many pairs fail"
    return Truncated(left_out, why)


def exempt_by(counts: PairCounts, static_bodies: int) -> tuple[int, int]:
    """Return how many pairs of static bodies are exempt, and how many within ignored groups.
    static_bodies: 0 if pairs of static bodies are checked."""
    static = static_bodies * (static_bodies - 1) // 2
    return static, counts.exempt - static
