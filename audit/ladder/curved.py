"""The rung of curved shapes: the decisions of the core, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.audit.bodies.verdict import Verdict
from satcheck.core.curved.exact.pair import proven, unit
from satcheck.core.curved.freeing import sides
from satcheck.core.curved.in_mesh import InMesh, relate
from satcheck.core.curved.nesting import nesting
from satcheck.core.curved.placed import is_convex
from satcheck.core.curved.signed import Signed, convex_pair
from satcheck.core.curved.triangles import Nearest, against_triangles

if TYPE_CHECKING:
    from satcheck.audit.bodies.pair import Pair
    from satcheck.audit.bodies.placed_body import PlacedBody
    from satcheck.audit.request.trace import Trace
    from satcheck.core.curved.exact.proof import Proof
    from satcheck.report.report import Relation

STAGE = "curved"
PROOF = "curved-exact"
TOO_CLOSE = "they overlap, and one may lie within the other: too close to its surface to tell"
OPEN_BOUNDS = "the bounds of a curved shape did not close"
CLOSE_CONTACT = "a curved shape in contact as far as its bounds tell"
_OPEN_TRIANGLES = "the bounds of a curved shape and a triangle did not close"
_NO_POINT = "no point of a curved shape could be told to lie within the mesh or not"
_SWAPPED: dict[Relation, Relation] = {"contains": "inside", "inside": "contains"}
_PROVES = {
    "separated": "separates them",
    "touching": "separates them without a gap, and they have a point in common",
    "penetrating": "is that of a point inside both",
    "free": "separates them without a gap",
}


def settle_curved(pair: Pair, trace: Trace) -> Verdict:
    """The relation of bodies whose boxes do not settle it."""
    if is_convex(pair.a) and is_convex(pair.b):
        return _settle_convex(pair, trace)
    return _settle_mesh(pair, trace)


def _settle_convex(pair: Pair, trace: Trace) -> Verdict:
    signed = convex_pair(pair.a, pair.b)
    if signed is None:
        trace.record(STAGE, "undecided", OPEN_BOUNDS)
        return Verdict("indeterminate", False, reason=f"undecided: {OPEN_BOUNDS}")
    trace.record(STAGE, signed.outcome, "convex shapes")
    if not signed.exact:
        signed, proof = proven(pair.a, pair.b, signed)
        trace.record(PROOF, signed.outcome if signed.exact else "undecided", _words(proof))
    if signed.outcome != "penetrating":
        reason = None if signed.exact else CLOSE_CONTACT
        return Verdict(signed.outcome, signed.exact, max(signed.lower, 0.0), signed, reason=reason)  # type: ignore[arg-type]
    return _nested(pair, signed, trace)


def _words(proof: Proof | None) -> str:
    if proof is None:
        return "no exact axis was found"
    axis = ", ".join(f"{c:.6g}" for c in unit(proof.axis))
    return f"the axis ({axis}) {_PROVES[proof.outcome]}"


def _nested(pair: Pair, signed: Signed, trace: Trace) -> Verdict:
    """Whether one of two overlapping convex bodies contains the other."""
    nested = nesting(pair.a, pair.b)
    if nested.exact:
        trace.record(PROOF, "known" if nested.known else "undecided", "which holds which")
    if nested.relation != "penetrating":
        trace.record("containment", nested.relation, "one shape holds the other")
    reason = None if nested.known else TOO_CLOSE
    return Verdict(nested.relation, nested.known, 0.0, signed, reason=reason, overlaps=True)


def _settle_mesh(pair: Pair, trace: Trace) -> Verdict:
    curved, mesh, sign = sides(pair.a, pair.b)
    seen = against_triangles(curved, mesh.mesh, pair.gap_limit)
    if seen.refined:
        detail = f"{seen.refined} triangles that bounds leave open"
        trace.record(PROOF, seen.nearest.outcome if seen.nearest else "undecided", detail)
    result = relate(curved, mesh, seen, pair.gap_limit)
    if result.relation == "undecided":
        reason = _open(result, pair.b if sign > 0 else pair.a, seen)
        trace.record(STAGE, "undecided", reason)
        return Verdict("indeterminate", False, reason=f"undecided: {reason}")
    relation: Relation = result.relation
    if sign < 0:
        relation = _SWAPPED.get(relation, relation)
    trace.record(STAGE, relation, _detail(result, seen))
    return _verdict(relation, result, sign)


def _verdict(relation: Relation, result: InMesh, sign: float) -> Verdict:
    if relation in ("separated", "touching"):
        signed = result.signed if sign > 0 or result.signed is None else result.signed.swapped()
        reason = None if result.proven else CLOSE_CONTACT
        return Verdict(relation, result.proven, result.gap_lower, signed, reason=reason)
    reason = None if result.proven else TOO_CLOSE
    overlaps = bool(result.crossed) or not result.proven
    return Verdict(relation, result.proven, reason=reason, overlaps=overlaps)


def _detail(result: InMesh, seen: Nearest) -> str:
    if result.crossed:
        return f"{result.crossed} triangles meet the inside of the shape"
    if result.relation == "inside":
        return "no triangle meets the shape, and its middle lies inside"
    if result.relation == "penetrating":
        if result.touched is not None:
            return f"within, and touches triangle {result.touched}"
        return f"within, and close to triangle {seen.triangle}"
    if result.signed is None:
        return "no triangle is near the shape"
    return f"nearest is triangle {seen.triangle}"


def _open(result: InMesh, mesh: PlacedBody, seen: Nearest) -> str:
    """Why the relation is undecided."""
    if result.hole is None:
        return _OPEN_TRIANGLES if seen.undecided else _NO_POINT
    number, count = result.hole
    which = "the hole" if count == 1 else f"hole {number + 1} of {count}"
    return f"{which} of {mesh.id} meets the curved shape: its fill decides"
