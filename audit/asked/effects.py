"""Each effect of a check: who asked for it, on how many pairs it ran, on how many not, and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import NamedTuple

from satcheck.audit.asked.planner import Asked, Planner
from satcheck.audit.report.report import (
    EFFECTS,
    OVERLAPS,
    Effect,
    EffectReport,
    Finding,
    PairCounts,
    Relation,
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


class _Shown(NamedTuple):
    """What of a finding decides this. exact: the relation without the touch band, where it is
    known. The others: whether it has that figure."""

    relation: Relation
    exact: Relation
    depth: bool
    volume: bool
    contacts: bool
    certificate: bool

    @property
    def unanswered(self) -> set[Effect]:
        """What has nothing to show for its stage, because it was refused, for instance."""
        answers: dict[Effect, bool] = {
            "volume": self.volume,
            "contacts": self.contacts,
            "certificate": self.certificate,
        }
        return {effect for effect, is_there in answers.items() if not is_there}


def effects_of(
    planner: Planner, close: Iterable[tuple[Asked, Finding]], counts: PairCounts
) -> tuple[EffectReport, ...]:
    """close: the pairs that the broad phase left over. The pairs of each effect, and those on which
    it did not run, are together all pairs. A sweep is left out where nothing moves."""
    effects = [effect for effect in EFFECTS if effect != "sweep" or planner.moving]
    time: dict[Effect, float] = dict.fromkeys(EFFECTS, 0.0)
    # Most pairs are like many others in all that counts here.
    alike: Counter[tuple[int, _Shown, tuple[Effect, ...]]] = Counter()
    known: dict[int, Asked] = {}
    looked_at = 0
    for asked, finding in close:
        looked_at += 1
        known[id(asked)] = asked
        stages = []
        for stage in finding.plan:
            effect = _EFFECT_OF_STAGE.get(stage.stage, "overlap")
            if effect not in asked.by:  # what the overlap needed, and nobody asked more for
                effect = "overlap"
            time[effect] += stage.microseconds
            if effect != "overlap":
                stages.append(effect)
        alike[id(asked), _shown(finding), tuple(stages)] += 1
    ran: Counter[Effect] = Counter()
    spared: dict[Effect, Counter[str]] = {effect: Counter() for effect in EFFECTS}
    for (asking, shown, stages_run), pairs in alike.items():
        asked = known[asking]
        done: set[Effect] = {"overlap", *stages_run}
        if shown.depth:  # also where the touch band found it
            done.add("depth")
        unanswered = done & shown.unanswered
        for effect in effects:
            if effect in done and effect not in unanswered:
                ran[effect] += pairs
            else:
                why = NO_ANSWER if effect in unanswered else _why_not(effect, asked, shown)
                spared[effect][why] += pairs
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


def _shown(finding: Finding) -> _Shown:
    return _Shown(
        finding.relation,
        finding.exact_relation or finding.relation,
        finding.depth is not None,
        finding.volume is not None,
        finding.contacts is not None,
        finding.certificate is not None,
    )


def _reasons(
    planner: Planner, effect: Effect, spared: Counter[str], counts: PairCounts, unreadable: int
) -> dict[str, int]:
    asked = bool(planner.who_asks(effect))
    reasons = Counter(spared)
    reasons[PRUNED if asked else NOT_ASKED] += counts.pruned
    reasons[UNREADABLE if asked else NOT_ASKED] += unreadable
    reasons[ALLOWED] += counts.allowed
    return {reason: count for reason, count in sorted(reasons.items()) if count}


def _why_not(effect: Effect, asked: Asked, shown: _Shown) -> str:
    if not asked.wants(effect):
        return NOT_ASKED
    if shown.relation == "indeterminate":
        return FAILED
    if effect == "distance":
        return OVERLAP if shown.exact in OVERLAPS else FAR
    return NO_OVERLAP
