"""The severity of a finding, the rule that decided it, and what it leaves undecided.

An overlap is an error, unless rules allow it within limits; then it is an error if it exceeds a
limit. A gap below the clearance is an error. Rules may set another severity for the errors of a
pair. An undecided question is at least a warning, whatever the rules say.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.bodies.pair import Pair
from satcheck.audit.request.planner import Request
from satcheck.audit.rounding import is_within, keeps
from satcheck.report.report import OVERLAPS, SEVERITIES, Severity, Undecided

if TYPE_CHECKING:
    from satcheck.audit.answer import Answer
    from satcheck.audit.request.settings import FailOn
    from satcheck.report.report import BodyAnswer, Finding
    from satcheck.report.statics import State

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


# Without rules: of an overlap, a touch, and no finding.
_OVERLAP, _TOUCH, _NOTHING = Judgement("error"), Judgement("note"), Judgement("none")


def clearance_judgement(
    request: Request, least: float, most: float, kept: bool | None = None
) -> Judgement | None:
    """The judgement of a gap between these bounds; None: the gap keeps the clearance, or there is
    no clearance. kept: whether the gap keeps it, if that is known more exactly than by the
    bounds."""
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


def judged(answer: Answer, pair: Pair, *, overlaps: bool = False) -> Judgement:
    """overlaps: an overlap is proven, even if the relation is not. An unproven relation does not
    pass, and an unproven overlap does not fail, unless --accuracy or --allow-open accepts
    estimates.
    """
    judgement = by_rule(_judged(answer, pair), pair.request)
    settings = pair.settings
    if answer.quality != "estimate" or settings.accuracy != "exact" or settings.allow_open:
        return judgement
    if answer.relation in OVERLAPS and overlaps:
        verified = answer.depth is not None and answer.depth.escape.verified
        is_proven = verified or not judgement.passes
        return judgement if is_proven else _warned(judgement, "relation")
    if answer.relation in OVERLAPS:  # or a gap that may keep no clearance
        close = clearance_judgement(pair.request, 0.0, 0.0)
        if close is not None and close.severity == "error":
            return _warned(by_rule(close, pair.request), "relation")
        return _warned(replace(judgement, severity="warning"), "relation")
    return _warned(judgement, "relation") if judgement.passes else judgement


def fails(finding: Finding, fail_on: FailOn) -> bool:
    """Return whether the finding is decided and at least as grave as `fail_on`. An error always
    counts as decided."""
    decided = finding.undecided is None or finding.severity == "error"
    return decided and SEVERITIES.index(finding.severity) <= SEVERITIES.index(fail_on)


def is_failure(finding: Finding, fail_on: FailOn) -> bool:
    """Return whether the check fails by it: a baseline does not hold it unchanged."""
    return fails(finding, fail_on) and finding.baseline_state != "unchanged"


def severity_of_answer(answer: State, own: str | None) -> Severity:
    """Return the severity of an answer to a question about a single body, without a doubt. own: the
    severity that rules give the errors of the body."""
    if answer == "yes":
        return "none"
    if answer == "open":
        return "error" if own == "error" else "warning"
    return "silenced" if own == "none" else own or "error"  # type: ignore[return-value]


def is_unmet(finding: BodyAnswer, fail_on: FailOn) -> bool:
    """Return whether the check fails by the answer to a question about a single body."""
    level = SEVERITIES.index(fail_on)
    return finding.answer != "open" and SEVERITIES.index(finding.severity) <= level


def by_rule(judgement: Judgement, request: Request) -> Judgement:
    """An error gets the severity that a rule sets for its pair."""
    if judgement.severity != "error" or request.severity is None:
        return judgement
    severity: Severity = "silenced" if request.severity == "none" else request.severity
    return replace(judgement, severity=severity, rule=request.rule("severity"))


def _judged(answer: Answer, pair: Pair) -> Judgement:
    request, gap = pair.request, answer.gap
    if answer.relation in OVERLAPS:
        return _limited(answer, request) if request.limited else _OVERLAP
    if answer.relation == "near":
        return Judgement("error", request.rule("clearance") or CLEARANCE_RULE)
    if gap is None:  # an overlap within the touch band
        close = clearance_judgement(request, 0.0, 0.0)
    else:
        close = clearance_judgement(request, gap.lower, gap.upper, gap.kept)
    return close or (_TOUCH if answer.relation == "touching" else _NOTHING)


def disputed(judgement: Judgement, reason: str) -> Judgement:
    """The judgement if another library contradicts the answer."""
    warned = _warned(judgement, judgement.undecided or "cross-check")
    return replace(warned, reason=judgement.reason or reason)


def _warned(judgement: Judgement, undecided: Undecided) -> Judgement:
    severity = judgement.severity if _is_at_least(judgement, "warning") else "warning"
    return replace(judgement, severity=severity, undecided=undecided)


def _is_at_least(judgement: Judgement, severity: Severity) -> bool:
    return SEVERITIES.index(judgement.severity) <= SEVERITIES.index(severity)


def _limited(answer: Answer, request: Request) -> Judgement:
    """Return whether the overlap is within all limits, beyond one, or undecided."""
    limits = list(_limits(answer, request))
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


def _limits(answer: Answer, request: Request) -> Iterator[_Limit]:
    depth, thick, common = answer.depth, answer.thickness, answer.volume
    figures = {
        "max_depth": (None, None) if depth is None else (depth.lower, depth.upper),
        "max_thickness": (None, None) if thick is None else (thick.lower, thick.upper),
        "max_volume": (None, None) if common is None else common.bounds,
    }
    for key, (least, greatest) in figures.items():
        most = getattr(request, key)
        if most is not None:
            yield _Limit(request.rule(key) or "", key, most, least, greatest)
