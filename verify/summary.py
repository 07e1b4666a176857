"""Whether the summary of a report follows from its findings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from satcheck.report.report import EFFECTS, BodyAnswer, Finding, Report
from satcheck.verify.exact import Rejected
from satcheck.verify.rules import SEVERITIES, Rules

# Counts of the summary -> the open question of the findings that they count.
UNDECIDED = (
    ("surfaces_only", "inside"),
    ("limits_undecided", "limit"),
    ("sweeps_undecided", "motion"),
    ("disputed", "cross-check"),
)


def check_summary(
    report: Report,
    findings: Sequence[Finding],
    rules: Rules,
    pruned: int,
    listed_apart: int,
    left_open: int,
) -> None:
    """pruned: pairs without a finding whose boxes are apart. listed_apart: pairs with one whose
    boxes may be apart. left_open: pairs without a finding that nothing decides."""
    total, allowed = rules.count()
    relations = Counter(str(finding.relation) for finding in findings)
    relations["indeterminate"] += left_open
    undecided = Counter(finding.undecided for finding in findings)
    _check_pairs(report, total, allowed, relations["indeterminate"], pruned, listed_apart)
    relations["separated"] += pruned
    by_relation = Counter({str(key): n for key, n in report.summary.by_relation.items()})
    if by_relation != relations:
        raise Rejected("the summary's counts by relation are not those of the findings")
    for key, kind in UNDECIDED:
        if getattr(report.summary, key) != undecided[kind]:  # type: ignore[index]
            raise Rejected(f"the summary's {key} is not {undecided[kind]}")  # type: ignore[index]
    _check_effects(report, total)
    truncated = report.truncated
    if (0 if truncated is None else truncated.pairs) != pruned + left_open:
        raise Rejected(f"the findings leave out {pruned + left_open} pairs")
    least = SEVERITIES.index(report.settings.fail_on)
    _check_baseline(report, findings, least)
    new = (finding for finding in findings if finding.baseline_state != "unchanged")
    failed = any(_fails(finding, least) for finding in new)
    alone = len(report.bodies) < 2 and all(body.triangles is not None for body in report.bodies)
    answers = report.answers
    nothing = total == allowed and not (alone or report.regions)
    open_ = left_open or undecided.total() > undecided[None] or nothing
    failed = failed or any(_is_no(answer, least) for answer in answers)
    open_ = open_ or any(answer.answer == "open" for answer in answers)
    open_ = open_ or any(issue.state == "blocking" for issue in report.issues)
    verdict = "fail" if failed else "incomplete" if open_ else "pass"
    if report.summary.verdict != verdict:
        raise Rejected(f"the verdict that follows from the findings is {verdict!r}")


def _check_pairs(
    report: Report, total: int, allowed: int, indeterminate: int, pruned: int, listed_apart: int
) -> None:
    pairs, bodies = report.summary.pairs, len(report.bodies)
    expected = {
        "total": total,
        "allowed": allowed,
        "indeterminate": indeterminate,
        "exempt": bodies * (bodies - 1) // 2 - total,
    }
    for key, count in expected.items():
        stated = getattr(pairs, key)
        if stated != count:
            raise Rejected(f"the summary counts {stated!r} pairs as {key}, not {count}")
    if pairs.pruned != pruned and not (pruned == 0 and pairs.pruned <= listed_apart):
        raise Rejected("the summary's count of pruned pairs is not that of the boxes apart")
    if pairs.decided != total - allowed - indeterminate - pairs.pruned:
        raise Rejected("the summary's counts of pairs do not add up")


def _check_effects(report: Report, total: int) -> None:
    names = Counter(effect.effect for effect in report.effects)
    expected = set(EFFECTS) if report.motions else set(EFFECTS) - {"sweep"}
    if names.keys() != expected or names.total() > len(names):
        raise Rejected("the list of effects has each of them once")
    for effect in report.effects:
        if effect.pairs + sum(effect.not_run.values()) != total:
            raise Rejected(f"the pairs of the effect {effect.effect} are not all pairs")


def _check_baseline(report: Report, findings: Sequence[Finding], least: int) -> None:
    """Failing findings have a state if there is a baseline, and no others do."""
    for finding in findings:
        has_state = report.baseline is not None and _fails(finding, least)
        if (finding.baseline_state is not None) != has_state:
            raise Rejected(f"{finding.a} and {finding.b}: the baseline_state is out of place")
    accepted = sum(finding.baseline_state == "unchanged" for finding in findings)
    if report.summary.accepted != accepted:
        raise Rejected(f"the baseline accepts {accepted} findings")


def _is_no(answer: BodyAnswer, least: int) -> bool:
    return answer.answer != "open" and answer.severity in SEVERITIES[least:]


def _fails(finding: Finding, least: int) -> bool:
    """Whether a decided severity of the finding reaches this level. An open question does not
    count."""
    decided = finding.undecided is None or finding.severity == "error"
    return decided and finding.severity in SEVERITIES[least:]
