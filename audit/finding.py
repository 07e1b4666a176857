"""One pair: up the ladder, the figures that were asked for, the words for the result.

A clearance is kept or not by the exact gap, whatever the touch band calls the pair: an overlap has
no gap, so it keeps none.
"""

from __future__ import annotations

import hashlib
import math
from dataclasses import replace
from typing import Any

from satcheck.audit.contact_report import Contacts
from satcheck.audit.depth import Depth, measure_depth
from satcheck.audit.gap import Gap, measure_gap
from satcheck.audit.ladder import Contact, boxes_apart, settle
from satcheck.audit.pair import Pair
from satcheck.audit.plan import Plan
from satcheck.audit.report import OVERLAPS, Finding, Quality, Relation, Severity
from satcheck.audit.tolerances import EXACT_WIDTH
from satcheck.audit.touch_band import estimate_is_within, move_within
from satcheck.audit.unseen import unseen_inside, unseen_severity

CLEARANCE_RULE = "clearance"
ID_DIGITS = 12


def finding_id(a: str, b: str) -> str:
    """Stable for the two bodies, whatever their order, pose or result."""
    key = "\0".join(sorted((a, b)))
    return hashlib.sha256(key.encode(errors="surrogateescape")).hexdigest()[:ID_DIGITS]


def examine(pair: Pair, plan: Plan) -> Finding:
    """Everything asked about one pair. Warnings go to the plan."""
    contact = settle(pair, plan)
    if contact.relation in OVERLAPS:
        finding = _overlapping(pair, contact, plan)
    else:
        finding = _apart(pair, contact, measure_gap(pair, contact, plan), plan)
    return _with_extras(finding, pair, contact, plan)


def _with_extras(finding: Finding, pair: Pair, contact: Contact, plan: Plan) -> Finding:
    """The finding with what only some ask for."""
    if pair.settings.volume:
        from satcheck.audit.volume import common_volume

        volume = common_volume(pair, contact, plan)
        finding = replace(
            finding,
            volume=volume.volume,
            volume_error=volume.error,
            reason=finding.reason or volume.refusal,
        )
    if pair.settings.contacts:
        from satcheck.audit.contacts import find_contacts

        finding = replace(finding, contacts=find_contacts(pair, contact, plan))
    if pair.peers is not None:
        from satcheck.audit.cross_check.opinions import say

        say(pair, contact, pair.peers, plan)
    return replace(finding, plan=tuple(plan.stages))


def apart_by_boxes(pair: Pair) -> Finding:
    """The finding of a pair that the broad phase settled."""
    plan = Plan()
    if not boxes_apart(pair, plan) > pair.asked_gap:
        raise RuntimeError(f"the broad phase dropped {pair.a.id} and {pair.b.id}")
    return _finding(
        pair.a.id,
        pair.b.id,
        "separated",
        plan,
        exact_relation="separated",
        quality="exact",
        tolerance=pair.tolerance,
        contacts=Contacts() if pair.settings.contacts else None,
        volume=0.0 if pair.settings.volume else None,
        volume_error=0.0 if pair.settings.volume else None,
    )


def indeterminate(a: str, b: str, reason: str, plan: Plan) -> Finding:
    return _finding(a, b, "indeterminate", plan, severity="warning", reason=reason)


def _weakness(pair: Pair, contact: Contact) -> str | None:
    """What the answer leaves out; the relation of hulls that are apart leaves out nothing."""
    hollow = [body.id for body in (pair.a, pair.b) if not body.solid]
    if not contact.proven:
        return _unproven(pair) if not pair.may("exact") else "a degenerate contact was sampled"
    if not hollow or contact.gap_lower > 0:
        return None
    verb = "is no solid" if len(hollow) == 1 else "are no solids"
    return f"surfaces only: {' and '.join(hollow)} {verb}, so containment is not defined"


def _unproven(pair: Pair) -> str:
    return f"not proven at --accuracy {pair.settings.accuracy}"


def _overlapping(pair: Pair, contact: Contact, plan: Plan) -> Finding:
    shallow, move = _is_shallow(pair, contact, plan), None
    if contact.convex is None and pair.may("exact"):
        move = move_within(pair, contact, plan)
    guess = shallow and not contact.proven
    depth = measure_depth(pair, contact, move, plan) if pair.settings.depth and not guess else None
    within = shallow or move is not None or _is_within(pair, depth)
    relation: Relation = "touching" if within else contact.relation
    figures = {} if depth is None else _depth_figures(depth)
    if pair.settings.clearance is not None and contact.convex is not None:
        signed = contact.convex.distance or 0.0
        figures["distance"] = signed if depth is None else -depth.upper
    return _finding(
        pair.a.id,
        pair.b.id,
        relation,
        plan,
        exact_relation=contact.relation if contact.proven else None,
        quality=_depth_quality(contact, depth),
        tolerance=pair.tolerance,
        reason=_weakness(pair, contact),
        **(_broken_clearance(pair, 0.0) if within else {}),
        **figures,
    )


def _is_shallow(pair: Pair, contact: Contact, plan: Plan) -> bool:
    """Whether an overlap within the touch band needs no triangles to be seen."""
    if contact.convex is not None:
        return -(contact.convex.lower or 0.0) <= _band_with_rounding(pair)
    return not pair.may("exact") and estimate_is_within(pair, plan)


def _band_with_rounding(pair: Pair) -> float:
    """The tolerance, and what rounding may add to a proven bound of a length equal to it."""
    return pair.tolerance * (1 + EXACT_WIDTH)


def _is_within(pair: Pair, depth: Depth | None) -> bool:
    """Whether the way out that was found, by parts for instance, is no longer than the band."""
    return depth is not None and depth.escape.verified and depth.upper <= pair.tolerance


def _depth_figures(depth: Depth) -> dict[str, Any]:
    return {
        "depth": depth.upper,
        "depth_bounds": (depth.lower, depth.upper),
        "normal": depth.normal,
        "mtv": depth.escape.mtv,
        "mtv_moves": "a",
        "mtv_verified": depth.escape.verified,
        "witness": depth.witness,
    }


def _depth_quality(contact: Contact, depth: Depth | None) -> Quality:
    if not contact.proven:
        return "estimate"
    if depth is None or depth.upper - depth.lower <= EXACT_WIDTH * depth.upper:
        return "exact"
    return "bounded"


def _apart(pair: Pair, contact: Contact, gap: Gap, plan: Plan) -> Finding:
    relation, proven, reason = contact.relation, contact.proven, _weakness(pair, contact)
    broken = _broken_clearance(pair, gap.lower)
    if gap.most <= _band_with_rounding(pair):
        relation = "touching"
    elif broken and relation == "separated":
        relation = "near"
        if math.isinf(gap.upper):
            proven, reason = False, _open_gap(pair)
    unseen = unseen_inside(pair, contact)
    if unseen is not None:
        reason = unseen
        plan.record("containment", "not checked", unseen)
    figures: dict[str, Any] = {}
    if pair.settings.clearance is not None and math.isfinite(gap.upper):
        figures = {"distance": gap.upper, "normal": gap.normal, "witness": gap.witness}
    severity = {} if unseen is None else {"severity": unseen_severity(pair)}
    return _finding(
        pair.a.id,
        pair.b.id,
        relation,
        plan,
        exact_relation=contact.relation if contact.proven else None,
        quality="exact" if proven else "estimate",
        tolerance=pair.tolerance,
        reason=reason,
        **{**severity, **broken},
        **figures,
    )


def _open_gap(pair: Pair) -> str:
    if not pair.may("exact"):
        return f"the gap is {_unproven(pair)}"
    return "the gap may be wider: the nearest wall has no thickness and may be no part of the body"


def _broken_clearance(pair: Pair, gap: float) -> dict[str, Any]:
    """gap: as far as it is proven. Empty where the clearance is kept or none was asked for."""
    if gap < (pair.settings.clearance or 0.0):
        return {"rule": CLEARANCE_RULE, "severity": "error"}
    return {}


def _severity(relation: Relation) -> Severity:
    if relation in OVERLAPS:
        return "error"
    return "note" if relation == "touching" else "none"


def _finding(a: str, b: str, relation: Relation, plan: Plan, **known: Any) -> Finding:
    known.setdefault("severity", _severity(relation))
    return Finding(
        id=finding_id(a, b), a=a, b=b, relation=relation, plan=tuple(plan.stages), **known
    )
