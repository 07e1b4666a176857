"""The effects of a check: what required each, on how many pairs it ran, and why not on others."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping

from satcheck.audit.request.planner import Planner
from satcheck.report.report import (
    EFFECTS,
    OVERLAPS,
    Effect,
    EffectReport,
    Finding,
    PairCounts,
)
from satcheck.report.request import Request

# Stages of effects that are not requested for every pair. All other stages decide the overlap.
_EFFECT_OF_STAGE: dict[str, Effect] = {
    "depth": "depth",
    "search": "depth",
    "verify": "depth",
    "thickness": "thickness",
    "distance": "distance",
    "volume": "volume",
    "contacts": "contacts",
    "components": "components",
    "cross-check": "cross-check",
    "certificate": "certificate",
    "sweep": "sweep",
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


class _Alike:
    """Findings that are equal in everything that counts here. Most findings have many equals."""

    __slots__ = ("findings", "request")

    def __init__(self, request: Request) -> None:
        self.request = request
        self.findings: list[Finding] = []

    @property
    def finding(self) -> Finding:
        """One of them."""
        return self.findings[0]

    def stages(self) -> Iterator[tuple[Effect, float]]:
        """The effect of each stage, and its microseconds."""
        for place, stage in enumerate(self.finding.plan):
            time = sum([finding.plan[place].microseconds for finding in self.findings])
            effect = _EFFECT_OF_STAGE.get(stage.stage, "overlap")
            # A step that only the overlap needed belongs to the overlap.
            yield effect if effect in self.request.by else "overlap", time

    @property
    def unanswered(self) -> set[Effect]:
        """Effects whose stage ran without a result, for example because it was refused."""
        answers: dict[Effect, object] = {
            "thickness": self.finding.thickness,
            "volume": self.finding.volume,
            "contacts": self.finding.contacts,
            "certificate": self.finding.certificate,
        }
        return {effect for effect, answer in answers.items() if answer is None}


def effects_of(
    planner: Planner,
    close: Iterable[tuple[Request, Finding]],
    counts: PairCounts,
    units_unknown: int = 0,
) -> tuple[EffectReport, ...]:
    """A report for each effect. close: the pairs that the broad phase kept. For each effect, the
    pairs on which it ran and those on which it did not add up to all pairs. Without motions there
    is no sweep. units_unknown: the number of pairs without a common unit."""
    effects = [effect for effect in EFFECTS if effect != "sweep" or planner.moving]
    groups = _grouped(close)
    time: dict[Effect, float] = dict.fromkeys(EFFECTS, 0.0)
    ran: Counter[Effect] = Counter()
    spared: dict[Effect, Counter[str]] = {effect: Counter() for effect in EFFECTS}
    for group in groups:
        done: set[Effect] = {"overlap"}
        for effect, microseconds in group.stages():
            time[effect] += microseconds
            done.add(effect)
        if group.finding.depth is not None:  # also if the touch band computed it
            done.add("depth")
        unanswered = done & group.unanswered
        for effect in effects:
            if effect in done and effect not in unanswered:
                ran[effect] += len(group.findings)
            else:
                why = NO_ANSWER if effect in unanswered else _why_not(effect, group)
                spared[effect][why] += len(group.findings)
    looked_at = sum(len(group.findings) for group in groups)
    unreadable = counts.total - counts.allowed - counts.pruned - looked_at - units_unknown
    beforehand = {
        PRUNED: counts.pruned,
        UNREADABLE: unreadable,
        UNITS_UNKNOWN: units_unknown,
    }
    requesters = {effect: planner.requested_by(effect) for effect in effects}
    return tuple(
        EffectReport(
            effect,
            by,
            ran[effect],
            _reasons(spared[effect], beforehand, counts.allowed, is_requested=bool(by)),
            time[effect],
        )
        for effect, by in requesters.items()
    )


def _grouped(close: Iterable[tuple[Request, Finding]]) -> list[_Alike]:
    groups: dict[tuple[object, ...], _Alike] = {}
    for request, finding in close:
        key = (
            id(request),
            finding.at_rest,
            finding.exact_relation,
            finding.depth is None,
            finding.thickness is None,
            finding.volume is None,
            finding.contacts is None,
            finding.certificate is None,
            *[stage.stage for stage in finding.plan],
        )
        group = groups.get(key)
        if group is None:
            group = groups[key] = _Alike(request)
        group.findings.append(finding)
    return list(groups.values())


def _reasons(
    spared: Counter[str], beforehand: Mapping[str, int], allowed: int, *, is_requested: bool
) -> dict[str, int]:
    reasons = Counter(spared)
    for reason, count in beforehand.items():
        reasons[reason if is_requested else NOT_ASKED] += count
    reasons[ALLOWED] += allowed
    return {reason: count for reason, count in sorted(reasons.items()) if count}


def _why_not(effect: Effect, group: _Alike) -> str:
    finding = group.finding
    if not group.request.wants(effect):
        return NOT_ASKED
    if finding.at_rest == "indeterminate":
        return FAILED
    if effect == "distance":
        return OVERLAP if (finding.exact_relation or finding.at_rest) in OVERLAPS else FAR
    return NO_OVERLAP
