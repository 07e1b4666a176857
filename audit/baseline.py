"""Findings beside a baseline: which are new, unchanged, worse, and which known ones are gone.

An unchanged finding does not fail a check. A finding is worse if its relation is graver than the
known one, or if its depth or gap is proven to be worse by more than the precision of the input (the
touch band of the pair).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from msgspec.structs import replace

from satcheck.audit.severity import fails
from satcheck.audit.summary import verdict_of
from satcheck.report.baseline import Baseline, BaselineState, KnownFinding, StatedBaseline
from satcheck.report.report import OVERLAPS, Finding, Relation, Report

# From the mildest to the gravest.
_GRAVITY: dict[Relation, int] = {
    "separated": 0,
    "touching": 1,
    "near": 1,
    "penetrating": 2,
    "contains": 3,
    "inside": 3,
    "coincident": 4,
}


def beside_baseline(report: Report, baseline: Baseline, file: str, asset: str = "") -> Report:
    """The report with the state of each failing finding, and its verdict without unchanged ones.

    file: of the baseline, to name it.
    """
    known = {each.key: each for each in baseline.findings}
    findings = tuple(_with_state(finding, report, known, asset) for finding in report.findings)
    stated = StatedBaseline(file, tuple(absent_from(report, baseline, asset)))
    judged = replace(report, findings=findings, baseline=stated)
    accepted = sum(finding.baseline_state == "unchanged" for finding in findings)
    return replace(
        judged, summary=replace(report.summary, verdict=verdict_of(judged), accepted=accepted)
    )


def known_findings(report: Report, asset: str = "", reason: str = "") -> list[KnownFinding]:
    """The failing findings of a report, as a baseline holds them."""
    return [
        KnownFinding(
            asset=asset,
            a=finding.a,
            b=finding.b,
            relation=finding.relation,
            depth=finding.depth,
            distance=finding.distance,
            reason=reason,
        )
        for finding in report.findings
        if fails(finding, report.settings.fail_on)
    ]


def absent_from(report: Report, baseline: Baseline, asset: str = "") -> list[KnownFinding]:
    """Known findings of pairs that this report has checked, and that do not fail any more."""
    usable = {body.id for body in report.bodies if body.triangles is not None}
    still = {
        frozenset((finding.a, finding.b))
        for finding in report.findings
        if finding.undecided is not None or fails(finding, report.settings.fail_on)
    }
    return [
        known
        for known in baseline.findings
        if known.asset == asset and {known.a, known.b} <= usable and known.key[1] not in still
    ]


def updated(baseline: Baseline, found: Iterable[KnownFinding]) -> Baseline:
    """With the figures of these findings, in the order of their names; reasons are kept."""
    known = {each.key: each for each in baseline.findings}
    for each in found:
        old = known.get(each.key)
        known[each.key] = replace(each, reason=old.reason) if old and old.reason else each
    return _sorted(known.values())


def pruned(baseline: Baseline, absent: Sequence[KnownFinding]) -> Baseline:
    gone = {each.key for each in absent}
    return _sorted(each for each in baseline.findings if each.key not in gone)


def _sorted(findings: Iterable[KnownFinding]) -> Baseline:
    return Baseline(findings=tuple(sorted(findings, key=lambda f: (f.asset, f.a, f.b))))


def _with_state(
    finding: Finding,
    report: Report,
    known: Mapping[tuple[str, frozenset[str]], KnownFinding],
    asset: str,
) -> Finding:
    if not fails(finding, report.settings.fail_on):
        return finding
    before = known.get((asset, frozenset((finding.a, finding.b))))
    state: BaselineState = "new" if before is None else _compared(before, finding)
    return replace(finding, baseline_state=state)


def _compared(before: KnownFinding, now: Finding) -> BaselineState:
    if now.undecided is not None or _GRAVITY[now.relation] > _GRAVITY[before.relation]:
        return "worse"
    band = now.tolerance or 0.0
    if now.relation in OVERLAPS and before.depth is not None:
        if now.depth_bounds is None:
            return "unmeasured"
        return "worse" if now.depth_bounds[0] > before.depth + band else "unchanged"
    if now.relation == "near" and before.distance is not None:
        if now.distance is None:
            return "unmeasured"
        return "worse" if now.distance < before.distance - band else "unchanged"
    return "unchanged"
