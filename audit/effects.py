"""The effects of a check: what required each, on how many pairs it ran, and why not on others."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from typing import NamedTuple

from satcheck.audit.planner import FOR_FAILURES, Planner
from satcheck.report.report import (
    BEYOND_BUDGET,
    EFFECTS,
    OVERLAPS,
    Effect,
    EffectReport,
    Finding,
    PairCounts,
    Relation,
)
from satcheck.report.request import ON_REQUEST, Request
from satcheck.report.settings import FailOn
from satcheck.report.verdict import fails

# Stages that are part of an effect of another name. All that no effect is named after decide the
# overlap.
_PART_OF = {"search": "depth", "verify": "depth"}
_ANSWERS: dict[Effect, Callable[[Finding], object]] = {
    "thickness": lambda finding: finding.thickness,
    **{effect: extra.answer for effect, extra in ON_REQUEST.items() if extra.answer},
}
NOT_ASKED = "not asked"
PRUNED = "boxes apart"
ALLOWED = "allowed"
UNREADABLE = "unreadable"
UNITS_UNKNOWN = "units unknown"
NO_OVERLAP = "no overlap"
OVERLAP = "overlap"
FAR = "further apart than asked about"
FAILED = "not decided"
NO_ANSWER = "no answer"


class _Kind(NamedTuple):
    """What counts here of a finding. Most findings have many equals.

    called_for: effects that nobody requests, and a failing pair calls for. done: the effects whose
    stages ran. unanswered: those of them without a result, for example because they were refused.
    """

    by: frozenset[str]
    called_for: frozenset[str]
    at_rest: Relation
    exact: Relation | None
    done: frozenset[str]
    unanswered: frozenset[str]


def effects_of(
    planner: Planner,
    close: Iterable[tuple[Request, Finding]],
    counts: PairCounts,
    units_unknown: int = 0,
) -> tuple[EffectReport, ...]:
    """Return a report for each effect. close: the pairs that the broad phase kept. For each effect,
    the pairs on which it ran and those on which it did not add up to all pairs. Without motions
    there is no sweep. units_unknown: the number of pairs without a common unit."""
    effects = [effect for effect in EFFECTS if effect != "sweep" or planner.moving]
    time: dict[str, float] = dict.fromkeys(EFFECTS, 0.0)
    fail_on = planner.settings.fail_on
    kinds = Counter(_kind_of(request, finding, fail_on, time) for request, finding in close)
    unreadable = counts.asked - counts.pruned - kinds.total() - units_unknown
    reports = []
    for effect in effects:
        by, ran = planner.requested_by(effect), 0
        if any(effect in kind.called_for for kind in kinds):
            by += (FOR_FAILURES,)
        spared = Counter({ALLOWED: counts.allowed})
        before = (PRUNED, counts.pruned), (UNREADABLE, unreadable), (UNITS_UNKNOWN, units_unknown)
        for reason, count in before:
            spared[reason if by else NOT_ASKED] += count
        for kind, count in kinds.items():
            if (why := _why_not(effect, kind)) is None:
                ran += count
            else:
                spared[why] += count
        not_run = {reason: count for reason, count in sorted(spared.items()) if count}
        reports.append(EffectReport(effect, by, ran, not_run, time[effect]))
    return tuple(reports)


def _kind_of(request: Request, finding: Finding, fail_on: FailOn, time: dict[str, float]) -> _Kind:
    """Adds the time of each stage to that of its effect."""
    by: frozenset[str] = frozenset(request.by)
    called_for: frozenset[str] = frozenset()
    if request.if_failing and finding.at_rest in OVERLAPS and fails(finding, fail_on):
        called_for = frozenset(request.if_failing)
        by |= called_for
    if finding.motion is not None:
        by |= {"sweep"}
    done: set[str] = {"overlap"}
    for stage in finding.plan:
        effect = _PART_OF.get(stage.stage, stage.stage)
        if effect not in by:  # a step that only the overlap needed
            effect = "overlap"
        time[effect] += stage.microseconds
        done.add(effect)
    if finding.depth is not None:  # also if the touch band computed it
        done.add("depth")
    unanswered = frozenset(
        effect for effect, answer in _ANSWERS.items() if effect in done and answer(finding) is None
    )
    exact = finding.exact_relation
    return _Kind(by, called_for, finding.at_rest, exact, frozenset(done), unanswered)


def _why_not(effect: Effect, kind: _Kind) -> str | None:
    """Return why an effect has no result for pairs of this kind; None: it has one."""
    if effect in kind.unanswered:
        return NO_ANSWER
    if effect in kind.done:
        return None
    if effect not in kind.by:
        return NOT_ASKED
    if kind.at_rest == "indeterminate":
        return FAILED
    if effect == "distance":
        return OVERLAP if (kind.exact or kind.at_rest) in OVERLAPS else FAR
    if effect in ("depth", "thickness") and kind.at_rest in OVERLAPS:
        return NO_ANSWER if "depth" in kind.done else BEYOND_BUDGET
    return NO_OVERLAP
