"""The effects of a check: what required each, on how many pairs it ran, and why not on others."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable

from satcheck.audit.planner import FOR_FAILURES, Planner
from satcheck.report.report import (
    BEYOND_BUDGET,
    EFFECTS,
    OVERLAPS,
    Effect,
    EffectReport,
    Finding,
    PairCounts,
)
from satcheck.report.request import ON_REQUEST, Request
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
    spared: dict[Effect, Counter[str | None]] = {effect: Counter() for effect in effects}
    called_for: set[Effect] = set()  # effects that nobody requests, and a failing pair calls for
    fail_on, examined = planner.settings.fail_on, 0
    for request, finding in close:
        examined += 1
        by: set[str] = set(request.by)
        if request.if_failing and finding.at_rest in OVERLAPS and fails(finding, fail_on):
            called_for.update(request.if_failing)
            by.update(request.if_failing)
        if finding.motion is not None:
            by.add("sweep")
        done = _done(finding, by, time)
        for effect in effects:
            spared[effect][_why_not(effect, finding, by, done)] += 1
    unreadable = counts.asked - counts.pruned - examined - units_unknown
    before = (PRUNED, counts.pruned), (UNREADABLE, unreadable), (UNITS_UNKNOWN, units_unknown)
    reports = []
    for effect, why_not in spared.items():
        asked_by = planner.requested_by(effect)
        if effect in called_for:
            asked_by += (FOR_FAILURES,)
        ran = why_not.pop(None, 0)
        why_not[ALLOWED] += counts.allowed
        for reason, count in before:
            why_not[reason if asked_by else NOT_ASKED] += count
        not_run = {reason: count for reason, count in sorted(why_not.items()) if reason and count}
        reports.append(EffectReport(effect, asked_by, ran, not_run, time[effect]))
    return tuple(reports)


def _done(finding: Finding, by: Collection[str], time: dict[str, float]) -> set[str]:
    """Return the effects whose stages ran, of those that were asked for. Add the time of each stage
    to that of its effect."""
    done = {"overlap"}
    for stage in finding.plan:
        effect = _PART_OF.get(stage.stage, stage.stage)
        if effect not in by:  # a step that only the overlap needed
            effect = "overlap"
        time[effect] += stage.microseconds
        done.add(effect)
    if finding.depth is not None:  # also if the touch band computed it
        done.add("depth")
    return done


def _why_not(
    effect: Effect, finding: Finding, by: Collection[str], done: Collection[str]
) -> str | None:
    """Return why an effect has no result, for example because it was refused; None: it has one."""
    if effect in done:
        answer = _ANSWERS.get(effect)
        return NO_ANSWER if answer is not None and answer(finding) is None else None
    if effect not in by:
        return NOT_ASKED
    if finding.at_rest == "indeterminate":
        return FAILED
    if effect == "distance":
        return OVERLAP if (finding.exact_relation or finding.at_rest) in OVERLAPS else FAR
    if effect in ("depth", "thickness") and finding.at_rest in OVERLAPS:
        return NO_ANSWER if "depth" in done else BEYOND_BUDGET
    return NO_OVERLAP
