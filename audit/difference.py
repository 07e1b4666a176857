"""How the failing findings of a report differ from those of an older one of the same scene.

The older report is a baseline of the newer one, and the newer one of the older: what is worse in
the older one is better now.
"""

from __future__ import annotations

from collections.abc import Iterator

from satcheck.audit.baseline import beside_baseline, known_findings
from satcheck.report.baseline import Baseline, BaselineState, KnownFinding
from satcheck.report.difference import FindingChange, FindingState
from satcheck.report.report import Report

_Pair = frozenset[str]


def finding_changes(before: Report, now: Report) -> Iterator[FindingChange | None]:
    """One for each finding that fails in either; None: it is unchanged."""
    previous, current = _by_pair(before), _by_pair(now)
    states, absent = _states(now, previous)
    back, _ = _states(before, current)
    for finding in now.findings:
        pair = frozenset((finding.a, finding.b))
        if finding.undecided is not None and pair in previous:
            states.setdefault(pair, "undecided")
        if pair in states:
            state = _state(states[pair], back.get(pair))
            old, new = previous.get(pair), current.get(pair)
            yield FindingChange(finding.a, finding.b, state, old, new) if state else None
    for pair, old in previous.items():
        if pair not in states:
            yield FindingChange(old.a, old.b, "gone" if pair in absent else "unchecked", old, None)


def _by_pair(report: Report) -> dict[_Pair, KnownFinding]:
    return {frozenset((each.a, each.b)): each for each in known_findings(report)}


def _states(
    report: Report, previous: dict[_Pair, KnownFinding]
) -> tuple[dict[_Pair, BaselineState], set[_Pair]]:
    """The states of the failing findings, and the known pairs that were checked and pass."""
    judged = beside_baseline(report, Baseline(findings=tuple(previous.values())), "")
    states = {
        frozenset((each.a, each.b)): each.baseline_state
        for each in judged.findings
        if each.baseline_state is not None
    }
    absent = judged.baseline.absent if judged.baseline is not None else ()
    return states, {frozenset((each.a, each.b)) for each in absent}


def _state(state: BaselineState, back: BaselineState | None) -> FindingState | None:
    """back: how the older finding compares with the newer one."""
    if state != "unchanged":
        return state
    return "better" if back == "worse" else None
