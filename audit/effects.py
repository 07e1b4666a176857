"""Each effect of a check: who asked for it, on how many pairs it ran, on how many not, and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from satcheck.audit.planner import Asked, Planner
from satcheck.audit.report import (
    EFFECTS,
    OVERLAPS,
    Effect,
    EffectReport,
    Finding,
    PairCounts,
    Stage,
)

# Stages that belong to an effect which not every pair asks for; the others find the overlap.
_EFFECT_OF_STAGE: dict[str, Effect] = {
    "depth": "depth",
    "search": "depth",
    "verify": "depth",
    "distance": "distance",
    "volume": "volume",
    "contacts": "contacts",
    "cross-check": "cross-check",
    "certificate": "certificate",
    "sweep": "sweep",
}
NOT_ASKED = "not asked"
PRUNED = "boxes apart"
ALLOWED = "allowed"
UNREADABLE = "unreadable"
NO_OVERLAP = "no overlap"
OVERLAP = "overlap"
FAR = "further apart than asked about"
FAILED = "not decided"
NO_ANSWER = "no answer"


def effects_of(
    planner: Planner, close: Iterable[tuple[Asked, Finding]], counts: PairCounts
) -> tuple[EffectReport, ...]:
    """close: the pairs that the broad phase left over. The pairs of each effect, and those on which
    it did not run, are together all pairs. A sweep is left out where nothing moves."""
    effects = [effect for effect in EFFECTS if effect != "sweep" or planner.moving]
    ran: Counter[Effect] = Counter()
    time: dict[Effect, float] = dict.fromkeys(EFFECTS, 0.0)
    spared: dict[Effect, Counter[str]] = {effect: Counter() for effect in EFFECTS}
    looked_at = 0
    for asked, finding in close:
        looked_at += 1
        done: set[Effect] = {"overlap"}
        if finding.depth is not None:  # also where the touch band found it
            done.add("depth")
        for stage in finding.plan:
            effect = _effect(stage, asked)
            done.add(effect)
            time[effect] += stage.microseconds
        unanswered = done & _unanswered(finding)
        done -= unanswered
        ran.update(done)
        for effect in effects:
            if effect not in done:
                why = NO_ANSWER if effect in unanswered else _why_not(effect, asked, finding)
                spared[effect][why] += 1
    unreadable = counts.total - counts.allowed - counts.pruned - looked_at
    return tuple(
        EffectReport(
            effect,
            planner.who_asks(effect),
            ran[effect],
            _reasons(planner, effect, spared[effect], counts, unreadable),
            time[effect],
        )
        for effect in effects
    )


def _unanswered(finding: Finding) -> set[Effect]:
    """What has nothing to show for its stage, because it was refused, for instance."""
    answers: dict[Effect, object] = {
        "volume": finding.volume,
        "contacts": finding.contacts,
        "certificate": finding.certificate,
    }
    return {effect for effect, answer in answers.items() if answer is None}


def _effect(stage: Stage, asked: Asked) -> Effect:
    """Of a stage that the overlap needed, where nobody asked for more: the overlap."""
    effect = _EFFECT_OF_STAGE.get(stage.stage, "overlap")
    return effect if asked.wants(effect) else "overlap"


def _reasons(
    planner: Planner, effect: Effect, spared: Counter[str], counts: PairCounts, unreadable: int
) -> dict[str, int]:
    asked = bool(planner.who_asks(effect))
    reasons = Counter(spared)
    reasons[PRUNED if asked else NOT_ASKED] += counts.pruned
    reasons[UNREADABLE if asked else NOT_ASKED] += unreadable
    reasons[ALLOWED] += counts.allowed
    return {reason: count for reason, count in sorted(reasons.items()) if count}


def _why_not(effect: Effect, asked: Asked, finding: Finding) -> str:
    if not asked.wants(effect):
        return NOT_ASKED
    if finding.relation == "indeterminate":
        return FAILED
    if effect == "distance":
        exact = finding.exact_relation or finding.relation
        return OVERLAP if exact in OVERLAPS else FAR
    return NO_OVERLAP
