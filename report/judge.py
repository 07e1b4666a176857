"""The relation and the severity of a finding, the rule that decided it, and what it leaves
undecided: pure functions of what the report states.

An overlap is an error, unless rules allow it within limits; then it is an error if it exceeds a
limit. A gap below the clearance is an error. Rules may set another severity for the errors of a
pair. An undecided question is at least a warning, whatever the rules say.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf
from typing import Protocol

from msgspec import Struct
from msgspec.structs import replace

from satcheck.report.report import OVERLAPS, SEVERITIES, Severity, Undecided
from satcheck.report.request import Request
from satcheck.report.values import Interval, Quality, Relation

CLEARANCE_RULE = "clearance"
# A depth interval of this relative width comes from rounding alone and counts as exact.
EXACT_WIDTH = 1e-9


class Judgement(Struct, frozen=True):
    """A severity, the rule that decided it, and what was left open, with the reason."""

    severity: Severity
    rule: str | None = None
    undecided: Undecided | None = None
    reason: str | None = None

    @property
    def passes(self) -> bool:
        return self.severity in ("note", "silenced", "none") and self.undecided is None

    def warned(self, undecided: Undecided) -> Judgement:
        """Return the same with an open question, at least a warning."""
        severity = min(self.severity, "warning", key=SEVERITIES.index)
        return replace(self, severity=severity, undecided=undecided)


class Figures(Protocol):
    """What a finding is judged by."""

    @property
    def relation(self) -> Relation: ...
    @property
    def depth_bounds(self) -> Interval | None: ...
    @property
    def thickness_bounds(self) -> Interval | None: ...
    @property
    def volume(self) -> float | None: ...
    @property
    def volume_error(self) -> float | None: ...


def named(exact: Relation, within: bool | None, kept: bool | None = True) -> Relation:
    """Return what a pair of bodies is called where they are placed. Nothing else decides whether
    that is `touching`; what a motion meets on its way has words of its own (`report.sweep`).

    exact: what it is without a tolerance. within: whether its overlap, or its gap, is at most the
    tolerance, or a surface tolerance explains it; None: open. Unless the relation is an estimate,
    this is proven (`audit/stages/touch_band.py`, `audit/stages/gap.py`). kept: whether its gap is
    at least the clearance, as far as the figure of the gap tells; None: there is no figure.

    - touching: what it shares, or what lies between, is within the tolerance; or it just touches.
    - near: it is apart, and the gap is less than the clearance, or nothing is known of it.
    - else what it is exactly: an open question never makes an overlap a touch.
    """
    if within:
        return "touching"
    return "near" if exact == "separated" and not kept else exact


def judged(
    finding: Figures, request: Request, gap: tuple[float, float], kept: bool | None = None
) -> Judgement:
    """gap: bounds of the gap; (0, 0): the bodies overlap within the touch band. kept: whether the
    gap keeps the clearance, if that is known more exactly than by the bounds."""
    return by_rule(_by_default(finding, request, gap, kept), request)


def by_rule(judgement: Judgement, request: Request) -> Judgement:
    """Give an error the severity that a rule sets for its pair."""
    if judgement.severity != "error" or request.severity is None:
        return judgement
    severity: Severity = "silenced" if request.severity == "none" else request.severity
    return replace(judgement, severity=severity, rule=request.rule("severity"))


def disputed(judgement: Judgement, reason: str | None) -> Judgement:
    """Return the judgement if another library contradicts the answer."""
    warned = judgement.warned(judgement.undecided or "cross-check")
    return replace(warned, reason=judgement.reason or reason)


def clearance_judgement(
    request: Request, least: float, most: float, kept: bool | None = None
) -> Judgement | None:
    """Judge a gap between these bounds; None: it keeps the clearance, or there is none."""
    if not request.clearance:
        return None
    rule = request.rule("clearance") or CLEARANCE_RULE
    if kept is None:
        kept = keeps(request.clearance, least, most)
    if kept is None:
        known = f"at least {least:.9g}" if most == inf else f"between {least:.9g} and {most:.9g}"
        by = f"--{rule}" if rule == CLEARANCE_RULE else rule
        reason = f"undecided: clearance is {request.clearance:.9g} ({by}), and the gap is {known}"
        return Judgement("warning", rule, "limit", reason)
    return None if kept else Judgement("error", rule)


def is_within(limit: float, least: float, greatest: float) -> bool | None:
    """Return whether a figure between these bounds is within a limit; None: undecided. Figures are
    rounded, so a figure that equals the limit up to EXACT_WIDTH is within it."""
    if greatest <= limit * (1 + EXACT_WIDTH):
        return True
    return False if least > limit else None


def keeps(clearance: float, least: float, most: float) -> bool | None:
    """Return whether a gap between these bounds keeps the clearance; None: undecided. Figures are
    rounded, so a gap that equals the clearance up to EXACT_WIDTH keeps it."""
    if most < clearance:
        return False
    return True if least >= clearance * (1 - EXACT_WIDTH) else None


def quality_of(depth_bounds: Interval | None, distance_bounds: Interval | None) -> Quality:
    """Return the quality of a proven relation with these figures."""
    low, high = depth_bounds or (0.0, 0.0)
    wide = high - low > EXACT_WIDTH * high
    return "bounded" if wide or distance_bounds is not None else "exact"


def _by_default(
    finding: Figures, request: Request, gap: tuple[float, float], kept: bool | None
) -> Judgement:
    """Judge without the severity that a rule sets for the pair."""
    if finding.relation in OVERLAPS:
        return _limited(finding, request) if request.limited else Judgement("error")
    if finding.relation == "near":
        return Judgement("error", request.rule("clearance") or CLEARANCE_RULE)
    close = clearance_judgement(request, *gap, kept)
    return close or Judgement("note" if finding.relation == "touching" else "none")


def _limited(finding: Figures, request: Request) -> Judgement:
    """Return whether the overlap is within all limits, beyond one, or undecided."""
    limits = list(_limits(finding, request))
    for limit in limits:
        if limit.kept is False:
            return Judgement("error", limit.rule)
    for limit in limits:
        if limit.kept is None:
            return Judgement("warning", limit.rule, "limit", f"undecided: {limit.question}")
    return Judgement("note", ", ".join(dict.fromkeys(limit.rule for limit in limits)))


class _Limit(Struct, frozen=True):
    """The figure of the pair lies between least and greatest (None: unknown). It may be at most
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


def _limits(finding: Figures, request: Request) -> Iterator[_Limit]:
    volume, error = finding.volume, finding.volume_error
    figures: dict[str, tuple[float | None, float | None]] = {
        "max_depth": finding.depth_bounds or (None, None),
        "max_thickness": finding.thickness_bounds or (None, None),
        "max_volume": (None, None),
    }
    if volume is not None and error is not None:
        figures["max_volume"] = volume - error, volume + error
    for key, (least, greatest) in figures.items():
        most = getattr(request, key)
        if most is not None:
            yield _Limit(request.rule(key) or "", key, most, least, greatest)
