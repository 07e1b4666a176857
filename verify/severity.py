"""How grave a finding is, and what it leaves undecided, from what is proven of it.

That an overlap is deeper than its limit, or undecided, is taken as said: neither passes. That it is
within its limit has to be proven, by a certified depth or way out. Volumes are not certified.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from satcheck.verify.evidence import vector
from satcheck.verify.exact import Rejected, dot
from satcheck.verify.relations import OVERLAPS
from satcheck.verify.rules import SEVERITIES, Asked


def check_severity(
    finding: dict[str, Any],
    asked: Asked,
    unseen: bool,
    depth_at_most: Fraction | None,
    rounding: Fraction,
) -> None:
    """unseen: one body may lie in the other, which has no inside to check, or come to lie there by
    the way out of an overlap. depth_at_most: as far as
    that is proven. rounding: the relative width that a limit is granted."""
    relation = finding.get("relation")
    severity, undecided = "none", None
    if relation in OVERLAPS:
        severity = "error"
        if asked.limited:
            severity, undecided = _limited(finding, asked, depth_at_most, rounding)
        unseen &= (severity, undecided) == ("note", None)
    elif relation == "near" or _keeps_no_clearance(finding, asked):
        severity = "error"
    elif relation == "touching":
        severity = "note"
    if severity == "error":
        severity = _said_by_rule(asked)
    if unseen:
        least = "note" if asked.allow_open else "warning"
        severity = max(severity, least, key=SEVERITIES.index)
        undecided = None if asked.allow_open else "inside"
    if _is_disputed(finding):
        severity = max(severity, "warning", key=SEVERITIES.index)
        undecided = undecided or "cross-check"
    if (finding.get("severity"), finding.get("undecided")) != (severity, undecided):
        raise Rejected(f"its severity is {severity!r}, and what is undecided {undecided!r}")


def _said_by_rule(asked: Asked) -> str:
    """Of an error."""
    return {None: "error", "none": "silenced"}.get(asked.severity) or str(asked.severity)


def _is_disputed(finding: dict[str, Any]) -> bool:
    """Whether the report says that another library contradicts the relation."""
    plan = finding.get("plan")
    stages = [stage for stage in plan if isinstance(stage, dict)] if isinstance(plan, list) else []
    return any(
        stage.get("stage") == "cross-check" and stage.get("result") == "disagrees"
        for stage in stages
    )


def _keeps_no_clearance(finding: dict[str, Any], asked: Asked) -> bool:
    """Bodies that meet keep none. Of those in the touch band whose gap is not certified it is taken
    as said that they do not."""
    if not asked.clearance:
        return False
    said = finding.get("severity") == _said_by_rule(asked)
    return finding.get("exact_relation") != "separated" or (
        finding.get("relation") == "touching" and said
    )


def _limited(
    finding: dict[str, Any], asked: Asked, depth_at_most: Fraction | None, rounding: Fraction
) -> tuple[str, str | None]:
    if asked.max_volume is None and depth_at_most is not None:
        assert asked.max_depth is not None
        if depth_at_most <= Fraction(asked.max_depth) * (1 + rounding):
            return "note", None
    if finding.get("undecided") == "limit":
        return "warning", "limit"
    if finding.get("severity") == "note" != asked.severity:
        raise Rejected("that it is within its limits is not certified")
    return "error", None


def proven_depth(finding: dict[str, Any], depth: bool, mtv: bool) -> Fraction | None:
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
