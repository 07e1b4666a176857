"""The severity of a finding, the rule behind it, and what stays open, from the proven facts.

That an overlap is within its limit, or a gap keeps its clearance, has to be proven. That it is
not follows from the figures of the finding. Volumes are not certified.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from satcheck.verify.evidence import vector
from satcheck.verify.exact import Rejected, dot
from satcheck.verify.relations import OVERLAPS
from satcheck.verify.rules import SEVERITIES, Asked

CLEARANCE = "clearance"
Json = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Judgement:
    """severity, undecided and rule as a finding has them."""

    severity: str
    undecided: str | None = None
    rule: str | None = None


@dataclass(frozen=True, slots=True)
class Known:
    """What is proven of a finding besides its relation.

    depth_at_most: as far as that is proven. keeps: whether the gap is at least as wide as this
    length; None: not decided. rounding: the relative width that a limit is granted.
    """

    depth_at_most: Fraction | None
    keeps: Callable[[Fraction], bool | None]
    rounding: Fraction


def check_severity(finding: Json, asked: Asked, known: Known) -> None:
    """Rejects a severity, a rule or an `undecided` that does not follow."""
    relation = finding["relation"]
    if relation in OVERLAPS:
        found = _limited(finding, asked, known) if asked.limited else Judgement("error")
    else:
        found = _apart(finding, asked, known)
    if found.severity == "error" and asked.severity is not None:
        severity = "silenced" if asked.severity == "none" else asked.severity
        found = replace(found, severity=severity, rule=asked.name("severity"))
    if _is_disputed(finding):
        found = replace(
            found,
            severity=max(found.severity, "warning", key=SEVERITIES.index),
            undecided=found.undecided or "cross-check",
        )
    said = Judgement(finding["severity"], finding["undecided"], finding["rule"])
    if said != found:
        raise Rejected(
            f"its severity is {found.severity!r} by the rule {found.rule!r}, "
            f"and what is undecided {found.undecided!r}"
        )


def _is_disputed(finding: Json) -> bool:
    """Whether the report says that another library contradicts the relation."""
    return any(
        stage["stage"] == "cross-check" and stage["result"] == "disagrees"
        for stage in finding["plan"]
    )


def _apart(finding: Json, asked: Asked, known: Known) -> Judgement:
    relation = finding["relation"]
    rule = asked.name("clearance") or CLEARANCE
    if relation == "near":
        return Judgement("error", None, rule)
    if asked.clearance:
        kept = known.keeps(Fraction(asked.clearance))
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


def _limited(finding: Json, asked: Asked, known: Known) -> Judgement:
    limits = list(_limits(finding, asked, known))
    broken = [limit for limit in limits if not limit.is_kept(known.rounding)]
    for limit in broken:
        if limit.least is not None and limit.least > limit.most:
            return Judgement("error", None, asked.name(limit.key))
    for limit in broken:
        return Judgement("warning", "limit", asked.name(limit.key))
    if not all(limit.proven for limit in limits):
        raise Rejected("that it is within its limits is not certified")
    names = (asked.name(limit.key) or "" for limit in limits)
    return Judgement("note", None, ", ".join(dict.fromkeys(names)))


def _limits(finding: Json, asked: Asked, known: Known) -> Iterator[_Limit]:
    if asked.max_depth is not None:
        low, high = finding["depth_bounds"] or (None, None)
        most, proven = Fraction(asked.max_depth), known.depth_at_most
        within = proven is not None and proven <= most * (1 + known.rounding)
        yield _Limit("max_depth", most, _fraction(low), _fraction(high), within)
    if asked.max_volume is not None:
        volume, error = _fraction(finding["volume"]), _fraction(finding["volume_error"])
        least = greatest = None
        if volume is not None and error is not None:
            least, greatest = volume - error, volume + error
        yield _Limit("max_volume", Fraction(asked.max_volume), least, greatest, False)


def _fraction(value: float | None) -> Fraction | None:
    return None if value is None else Fraction(value)


def proven_depth(finding: Json, depth: bool, mtv: bool) -> Fraction | None:
    """An upper bound, world units, of the depth that is certified; None: none is."""
    bounds = []
    if depth:
        bounds.append(Fraction(finding["depth"]))
    if mtv:
        move = vector(finding["mtv"])
        squared = dot(move, move)
        bounds.append(_root_above(squared))
    return min(bounds, default=None)


def _root_above(value: Fraction) -> Fraction:
    """At least the square root, by a relative 2**-50 at most."""
    from math import isqrt

    shift = 200 + max(value.denominator.bit_length(), value.numerator.bit_length())
    return Fraction(isqrt((value.numerator << (2 * shift)) // value.denominator) + 1, 1 << shift)
