"""The severity of a finding, the rule behind it, and what stays open, from the proven facts.

That an overlap is within its limit, or a gap keeps its clearance, has to be proven. That it is
not follows from the figures of the finding. Volumes are not certified.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

from satcheck.report.report import CROSS_CHECK, OVERLAPS, Finding
from satcheck.verify.evidence import vector
from satcheck.verify.exact import Rejected, dot, root_above
from satcheck.verify.rules import SEVERITIES, Request

CLEARANCE = "clearance"


@dataclass(frozen=True, slots=True)
class ProvenFields:
    """Which fields of an accepted finding are proven. distance: how far it may be off; None: it is
    not proven. ball: with the lower end of the thickness. thickness: its upper end."""

    depth: bool = False
    mtv: bool = False
    distance: Fraction | None = None
    normal: bool = False
    contacts: bool = False
    ball: bool = False
    thickness: bool = False


@dataclass(frozen=True, slots=True)
class Judgement:
    """severity, undecided and rule as a finding has them."""

    severity: str
    undecided: str | None = None
    rule: str | None = None


@dataclass(frozen=True, slots=True)
class ProvenFigures:
    """The needs of a judgement besides the relation.

    depth_at_most, thickness_at_most: proven upper bounds. keeps: whether the gap has at least this
    length; None: undecided. rounding: the relative width that a limit is granted.
    """

    depth_at_most: Fraction | None
    thickness_at_most: Fraction | None
    keeps: Callable[[Fraction], bool | None]
    rounding: Fraction


def check_severity(finding: Finding, request: Request, proven: ProvenFigures) -> None:
    """Rejects a severity, a rule or an `undecided` that does not follow."""
    relation = finding.relation
    if relation in OVERLAPS:
        judgement = _limited(finding, request, proven) if request.limited else Judgement("error")
    else:
        judgement = _apart(finding, request, proven)
    if judgement.severity == "error" and request.severity is not None:
        severity = "silenced" if request.severity == "none" else request.severity
        judgement = replace(judgement, severity=severity, rule=request.name("severity"))
    if _is_disputed(finding):
        judgement = replace(
            judgement,
            severity=max(judgement.severity, "warning", key=SEVERITIES.index),
            undecided=judgement.undecided or "cross-check",
        )
    said = Judgement(finding.severity, finding.undecided, finding.rule)
    if said != judgement:
        raise Rejected(
            f"its severity is {judgement.severity!r} by the rule {judgement.rule!r}, "
            f"and what is undecided {judgement.undecided!r}"
        )


def _is_disputed(finding: Finding) -> bool:
    """Return whether the report says that another library contradicts the relation."""
    return any(stage.stage == CROSS_CHECK and stage.result == "disagrees" for stage in finding.plan)


def _apart(finding: Finding, request: Request, proven: ProvenFigures) -> Judgement:
    relation = finding.relation
    rule = request.name("clearance") or CLEARANCE
    if relation == "near":
        return Judgement("error", None, rule)
    if request.clearance:
        kept = proven.keeps(Fraction(request.clearance))
        if kept is False:
            return Judgement("error", None, rule)
        if kept is None:
            return Judgement("warning", "limit", rule)
    return Judgement("note" if relation == "touching" else "none")


@dataclass(frozen=True, slots=True)
class _Limit:
    """The pair may have `most` of something, and has between least and greatest, by its figures.
    kept: proven to be within; None: within by the figures only."""

    key: str
    most: Fraction
    least: Fraction | None
    greatest: Fraction | None
    proven: bool

    def is_kept(self, rounding: Fraction) -> bool:
        return self.greatest is not None and self.greatest <= self.most * (1 + rounding)


def _limited(finding: Finding, request: Request, proven: ProvenFigures) -> Judgement:
    limits = list(_limits(finding, request, proven))
    broken = [limit for limit in limits if not limit.is_kept(proven.rounding)]
    for limit in broken:
        if limit.least is not None and limit.least > limit.most:
            return Judgement("error", None, request.name(limit.key))
    for limit in broken:
        return Judgement("warning", "limit", request.name(limit.key))
    if not all(limit.proven for limit in limits):
        raise Rejected("that it is within its limits is not certified")
    names = (request.name(limit.key) or "" for limit in limits)
    return Judgement("note", None, ", ".join(dict.fromkeys(names)))


def _limits(finding: Finding, request: Request, proven: ProvenFigures) -> Iterator[_Limit]:
    intervals = {
        "max_depth": (finding.depth_bounds, proven.depth_at_most),
        "max_thickness": (finding.thickness_bounds, proven.thickness_at_most),
    }
    for key, (interval, bound) in intervals.items():
        if (limit := getattr(request, key)) is None:
            continue
        low, high = interval or (None, None)
        most = Fraction(limit)
        within = bound is not None and bound <= most * (1 + proven.rounding)
        yield _Limit(key, most, _fraction(low), _fraction(high), within)
    if request.max_volume is not None:
        volume, error = _fraction(finding.volume), _fraction(finding.volume_error)
        least = greatest = None
        if volume is not None and error is not None:
            least, greatest = volume - error, volume + error
        yield _Limit("max_volume", Fraction(request.max_volume), least, greatest, False)


def _fraction(value: float | None) -> Fraction | None:
    return None if value is None else Fraction(value)


def proven_depth(finding: Finding, proven: ProvenFields) -> Fraction | None:
    """An upper bound, world units, of the depth that is certified; None: none is."""
    bounds = []
    if proven.depth and finding.depth is not None:
        bounds.append(Fraction(finding.depth))
    if proven.mtv and finding.mtv is not None:
        move = vector(finding.mtv)
        bounds.append(root_above(dot(move, move)))
    return min(bounds, default=None)


def severity_of_answer(answer: str, own: str | None) -> str:
    """Return the severity of an answer about a single body. own: the severity that rules give its
    errors."""
    if answer == "yes":
        return "none"
    if answer == "open":
        return "error" if own == "error" else "warning"
    return "silenced" if own == "none" else own or "error"
