"""One pair: up the ladder, the figures that are needed, the words for the result.

A clearance is kept or not by the exact gap, whatever the touch band calls the pair: an overlap has
no gap, so it keeps none.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any

from satcheck.audit.asked.plan import Plan
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.figures.gap import Gap, compare_convex, measure_gap
from satcheck.audit.figures.touch_band import Band, band_of, estimate_is_within, touch_band
from satcheck.audit.ladder.around import open_pieces_around
from satcheck.audit.ladder.ladder import Contact, boxes_apart, settle
from satcheck.audit.report.contact_report import Contacts
from satcheck.audit.report.report import OVERLAPS, Finding, Quality, Relation, Vector
from satcheck.audit.severity import disputed, judged
from satcheck.audit.tolerances import EXACT_WIDTH

if TYPE_CHECKING:
    from satcheck.audit.figures.depth import Depth
    from satcheck.audit.figures.touch_band import Side
    from satcheck.core import Climb, PairResult
    from satcheck.core.curved.signed import Signed

ID_DIGITS = 12
OPEN_BAND = "undecided: whether that is within the tolerance"


def finding_id(a: str, b: str) -> str:
    """Stable for the two bodies, whatever their order, pose or result."""
    key = f"{a}\0{b}" if a < b else f"{b}\0{a}"
    return hashlib.sha256(key.encode(errors="surrogatepass")).hexdigest()[:ID_DIGITS]


def examine(pair: Pair, plan: Plan, climb: Climb | None = None) -> Finding:
    """Everything asked about one pair. Warnings go to the plan. climb: where it has been made."""
    contact = settle(pair, plan, climb)
    if contact.relation == "indeterminate":
        return indeterminate(pair.a.id, pair.b.id, contact.reason or "undecided", plan)
    if contact.relation in ("separated", "touching"):
        surrounded = open_pieces_around(pair)
        if surrounded is not None:
            return indeterminate(pair.a.id, pair.b.id, surrounded, plan)
    gap: tuple[float, float, bool | None] = (0.0, 0.0, None)
    if contact.relation in OVERLAPS:
        overlap = _overlapping(pair, contact, plan)
        if overlap is None:
            reason = f"undecided: rounding hides whether the overlap is within {pair.tolerance:.9g}"
            return indeterminate(pair.a.id, pair.b.id, reason, plan)
        known = overlap
        gap = (0.0, pair.farther, None)
    else:
        measured = measure_gap(pair, contact, plan)
        if pair.closer:
            from satcheck.audit.figures.curve_error import gap_of_curves

            measured = gap_of_curves(pair, measured)
        gap = measured.lower, measured.upper, measured.kept
        known = _apart(pair, contact, measured)
    contradiction = _add_extras(known, pair, contact, plan)
    found = judged(known, pair, gap, overlaps=contact.overlaps)
    if contradiction is not None:
        found = disputed(found, contradiction)
    known["reason"] = known["reason"] or found.reason
    known["rule"], known["severity"], known["undecided"] = (
        found.rule,
        found.severity,
        found.undecided,
    )
    return _finding(pair.a.id, pair.b.id, plan, known)


def _add_extras(known: dict[str, Any], pair: Pair, contact: Contact, plan: Plan) -> str | None:
    """Adds what only some ask for; returns what another library says against the relation."""
    if pair.curved:
        from satcheck.audit.figures.curved import without_meshes

        known["reason"] = without_meshes(known["reason"], pair, plan)
        return None
    asked = pair.asked.by
    if "volume" in asked:
        from satcheck.audit.figures.volume import common_volume

        volume = common_volume(pair, contact, plan)
        known["volume"], known["volume_error"] = volume.volume, volume.error
        known["reason"] = known["reason"] or volume.refusal
    if "contacts" in asked:
        from satcheck.audit.figures.contacts import find_contacts

        known["contacts"] = find_contacts(pair, contact, plan)
    if pair.peers is None:
        return None
    from satcheck.audit.cross_check import say

    return say(pair, contact, pair.peers, plan)


def apart_by_boxes(pair: Pair) -> Finding:
    """The finding of a pair that the broad phase settled."""
    plan = Plan()
    if not boxes_apart(pair, plan) > pair.asked_gap:
        raise RuntimeError(f"the broad phase dropped {pair.a.id} and {pair.b.id}")
    known = {
        "relation": "separated",
        "severity": "none",
        "exact_relation": "separated",
        "quality": "exact",
        "tolerance": pair.tolerance,
        "contacts": Contacts() if pair.asked.wants("contacts") else None,
        "volume": 0.0 if pair.asked.wants("volume") else None,
        "volume_error": 0.0 if pair.asked.wants("volume") else None,
    }
    return _finding(pair.a.id, pair.b.id, plan, known)


def indeterminate(a: str, b: str, reason: str, plan: Plan) -> Finding:
    known = {
        "relation": "indeterminate",
        "severity": "warning",
        "undecided": "relation",
        "reason": reason,
    }
    return _finding(a, b, plan, known)


def _weakness(pair: Pair, contact: Contact) -> str | None:
    """What the answer leaves out; the relation of hulls that are apart leaves out nothing."""
    if contact.reason is not None:
        return contact.reason
    if not contact.proven:
        return _unproven(pair) if not pair.may("exact") else "a degenerate contact was sampled"
    return None


def _unproven(pair: Pair) -> str:
    return f"not proven at --accuracy {pair.settings.accuracy}"


def _overlapping(pair: Pair, contact: Contact, plan: Plan) -> dict[str, Any] | None:
    """None: rounding hides whether the overlap is within the tolerance."""
    if contact.convex is not None:
        # No triangles are needed to see an overlap within the touch band.
        band = Band(_side(pair, contact.convex))
    elif pair.may("exact"):
        band = touch_band(pair, contact, plan)
    else:
        band = Band("within" if estimate_is_within(pair, plan) else "open")
    guess = band.side == "within" and not contact.proven
    depth = None if guess else _depth(pair, contact, band.move, plan)
    if depth is not None and band.side in ("open", "hidden"):
        band = _band_of_depth(pair, depth) or band
    if band.side == "hidden":
        return None
    is_open = pair.curved and contact.convex is not None and band.side == "open"
    relation: Relation = "touching" if band.side == "within" else contact.relation
    proven = shown = contact.proven
    reason = _weakness(pair, contact) or (OPEN_BAND if is_open else None)
    if pair.closer:
        from satcheck.audit.figures import curve_error

        depth = depth and curve_error.depth_of_curves(pair, contact, depth, plan)
        shown = proven and curve_error.overlap_of_curves(pair, contact)
        in_band = relation == "touching" and pair.tolerance >= pair.closer
        if not (shown or in_band) and curve_error.is_hidden(pair, contact, depth):
            proven, reason = False, reason or _within_curves(pair)
    return {
        "relation": relation,
        "exact_relation": contact.relation if shown else None,
        "quality": _depth_quality(depth, proven=proven),
        "tolerance": pair.tolerance,
        "reason": reason,
        **({} if depth is None else _depth_figures(depth)),
    }


def _depth(pair: Pair, contact: Contact, move: Vector | None, plan: Plan) -> Depth | None:
    if not pair.asked.wants("depth"):
        return None
    from satcheck.audit.figures.depth import measure_depth

    return measure_depth(pair, contact, move, plan)


def _side(pair: Pair, found: PairResult | Signed) -> Side:
    """Whether two convex bodies overlap by no more than the tolerance."""
    if pair.tolerance == 0:
        return "deeper"
    least, most = -(found.upper or 0.0), -(found.lower or 0.0)
    if most <= pair.tolerance:
        return "within"
    side = -1 if least > pair.tolerance else compare_convex(pair, -pair.tolerance)
    if side is None:
        return "open"
    return "within" if side >= 0 else "deeper"


def _band_of_depth(pair: Pair, depth: Depth) -> Band | None:
    """By the way out that was found, by parts for instance; None: it says nothing."""
    if not depth.escape.verified or depth.lower > pair.tolerance:
        return None
    return band_of(pair, depth.escape.mtv)


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


def _depth_quality(depth: Depth | None, *, proven: bool) -> Quality:
    if not proven:
        return "estimate"
    if depth is None or depth.upper - depth.lower <= EXACT_WIDTH * depth.upper:
        return "exact"
    return "bounded"


def _apart(pair: Pair, contact: Contact, gap: Gap) -> dict[str, Any]:
    relation, proven, reason = contact.relation, contact.proven, _weakness(pair, contact)
    if gap.within:
        relation = "touching"
        # The band is proven, whichever side of a touch the bodies are on.
        proven = proven or _overlaps_within(contact, pair.tolerance)
    elif relation == "separated":
        guess = gap.kept is None and gap.distance is None
        if gap.kept is False or guess:
            relation = "near"
        elif gap.within is None:
            reason = reason or OPEN_BAND
        if guess:
            proven, reason = False, _open_gap(pair)
    shown = contact.proven
    if pair.closer and gap.lower == 0:  # the curves may meet
        shown = False
        if pair.tolerance < pair.closer:
            proven, reason = False, reason or _within_curves(pair)
    figures: dict[str, Any] = {}
    if pair.asked.clearance is not None and gap.distance is not None:
        figures = {"distance": gap.distance, "normal": gap.normal, "witness": gap.witness}
        if pair.closer:
            figures["distance_bounds"] = (gap.lower, gap.upper)
    at_best: Quality = "bounded" if "distance_bounds" in figures else "exact"
    return {
        "relation": relation,
        "exact_relation": contact.relation if shown else None,
        "quality": at_best if proven else "estimate",
        "tolerance": pair.tolerance,
        "reason": reason,
        **figures,
    }


def _within_curves(pair: Pair) -> str:
    return f"undecided: the curves may be {pair.closer:.3g} off their polygons"


def _overlaps_within(contact: Contact, tolerance: float) -> bool:
    """Whether two convex bodies are proven to overlap by no more than that, if they do."""
    lower = None if contact.convex is None else contact.convex.lower
    return lower is not None and lower >= -tolerance


def _open_gap(pair: Pair) -> str:
    if not pair.may("exact"):
        return f"the gap is {_unproven(pair)}"
    return "the gap may be less: what fills a hole may be nearer than the surface"


def _finding(a: str, b: str, plan: Plan, known: dict[str, Any]) -> Finding:
    """known: its other fields."""
    known["id"], known["a"], known["b"] = finding_id(a, b), a, b
    known["plan"] = tuple(plan.stages)
    return Finding(**known)
