"""The severity of a finding, the rule that decided it, and what it leaves undecided.

An overlap is an error unless rules limit it, and then where it exceeds a limit; so is a gap below
the clearance. Rules may call the errors of a pair something else. What could not be decided stays a
warning at least, whatever they say.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf
from typing import Any

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.asked.planner import Asked
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.report.report import OVERLAPS, SEVERITIES, Relation, Severity, Undecided
from satcheck.audit.tolerances import EXACT_WIDTH, is_within

CLEARANCE_RULE = "clearance"


class Judgement(Struct, frozen=True):
    """A severity, the rule that decided it, and what was left open, with the reason."""

    severity: Severity
    rule: str | None = None
    undecided: Undecided | None = None
    reason: str | None = None

    @property
    def passes(self) -> bool:
        return self.severity in ("note", "silenced", "none") and self.undecided is None


# As a matter of course: an overlap, a touch, and what is no finding.
_OVERLAP, _TOUCH, _NOTHING = Judgement("error"), Judgement("note"), Judgement("none")


def keeps(clearance: float, least: float, most: float) -> bool | None:
    """Whether a gap between these bounds keeps the clearance; None: not decided. Figures are
    rounded: bounds that hold a clearance less than that below their ends keep it."""
    if most < clearance:
        return False
    return True if least >= clearance * (1 - EXACT_WIDTH) else None


def of_clearance(
    asked: Asked, least: float, most: float, kept: bool | None = None
) -> Judgement | None:
    """Of a gap between these bounds; None: it keeps the clearance, or there is none. kept:
    whether it does, where that is known better than by the bounds."""
    if not asked.clearance:
        return None
    rule = asked.rule("clearance") or CLEARANCE_RULE
    if kept is None:
        kept = keeps(asked.clearance, least, most)
    if kept is None:
        known = f"at least {least:.9g}" if most == inf else f"between {least:.9g} and {most:.9g}"
        by = f"--{rule}" if rule == CLEARANCE_RULE else rule
        reason = f"undecided: clearance is {asked.clearance:.9g} ({by}), and the gap is {known}"
        return Judgement("warning", rule, "limit", reason)
    return None if kept else Judgement("error", rule)


def judged(
    known: Mapping[str, Any],
    pair: Pair,
    gap: tuple[float, float, bool | None],
    *,
    overlaps: bool = False,
) -> Judgement:
    """Of a finding, by what is known of it: its fields by name.

    gap: proven bounds of the distance of bodies without a common interior, and whether it keeps the
    clearance. overlaps: an overlap is proven, even if the relation is not. A relation that is not
    proven does not pass, and an overlap that is not proven does not fail, unless --accuracy or
    --allow-open asks for less.
    """
    found = by_rule(_found(known, pair.asked, gap), pair.asked)
    settings = pair.settings
    if known["quality"] != "estimate" or settings.accuracy != "exact" or settings.allow_open:
        return found
    if known["relation"] in OVERLAPS and overlaps:
        is_proven = not found.passes or known.get("mtv_verified") is True
        return found if is_proven else _warned(found, "relation")
    if known["relation"] in OVERLAPS:  # or a gap within these bounds
        close = of_clearance(pair.asked, *gap)
        if close is not None and close.severity == "error":
            return _warned(by_rule(close, pair.asked), "relation")
        return _warned(replace(found, severity="warning"), "relation")
    return _warned(found, "relation") if found.passes else found


def by_rule(found: Judgement, asked: Asked) -> Judgement:
    """An error gets the severity that a rule sets for its pair."""
    if found.severity != "error" or asked.severity is None:
        return found
    severity: Severity = "silenced" if asked.severity == "none" else asked.severity
    return replace(found, severity=severity, rule=asked.rule("severity"))


def _found(
    known: Mapping[str, Any], asked: Asked, gap: tuple[float, float, bool | None]
) -> Judgement:
    relation: Relation = known["relation"]
    if relation in OVERLAPS:
        return _limited(known, asked) if asked.limited else _OVERLAP
    if relation == "near":
        return Judgement("error", asked.rule("clearance") or CLEARANCE_RULE)
    return of_clearance(asked, *gap) or (_TOUCH if relation == "touching" else _NOTHING)


def disputed(found: Judgement, reason: str) -> Judgement:
    """The same where another library contradicts the answer."""
    warned = _warned(found, found.undecided or "cross-check")
    return replace(warned, reason=found.reason or reason)


def _warned(found: Judgement, undecided: Undecided) -> Judgement:
    severity = found.severity if _is_at_least(found, "warning") else "warning"
    return replace(found, severity=severity, undecided=undecided)


def _is_at_least(found: Judgement, severity: Severity) -> bool:
    return SEVERITIES.index(found.severity) <= SEVERITIES.index(severity)


def _limited(known: Mapping[str, Any], asked: Asked) -> Judgement:
    """Within all limits, beyond one, or undecided."""
    limits = list(_limits(known, asked))
    for limit in limits:
        if limit.kept is False:
            return Judgement("error", limit.rule)
    for limit in limits:
        if limit.kept is None:
            return Judgement("warning", limit.rule, "limit", f"undecided: {limit.question}")
    return Judgement("note", ", ".join(dict.fromkeys(limit.rule for limit in limits)))


class _Limit(Struct, frozen=True):
    """What the pair has is between least and greatest (None: not known), and may have at most
    `most`."""

    rule: str
    key: str
    most: float
    least: float | None
    greatest: float | None

    @property
    def kept(self) -> bool | None:
        """None: not decided."""
        if self.least is None or self.greatest is None:
            return None
        return is_within(self.most, self.least, self.greatest)

    @property
    def question(self) -> str:
        known = f"{self.key} is {self.most:.6g} ({self.rule})"
        figure = self.key.removeprefix("max_")
        if self.least is None or self.greatest is None:
            return f"{known}, and the {figure} of the pair is not known"
        return f"{known}, and the {figure} is between {self.least:.6g} and {self.greatest:.6g}"


def _limits(known: Mapping[str, Any], asked: Asked) -> Iterator[_Limit]:
    if asked.max_depth is not None:
        least, greatest = known.get("depth_bounds") or (None, None)
        yield _Limit(asked.rule("max_depth") or "", "max_depth", asked.max_depth, least, greatest)
    if asked.max_volume is not None:
        least = greatest = None
        volume, error = known.get("volume"), known.get("volume_error")
        if volume is not None and error is not None:
            least, greatest = volume - error, volume + error
        yield _Limit(
            asked.rule("max_volume") or "", "max_volume", asked.max_volume, least, greatest
        )
