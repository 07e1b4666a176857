"""The stage of curved shapes: the relation, as the core decides it, the depth in a mesh that is not
convex, and what is not available.

The depth is between that of a mesh inside the shape and that of a mesh around it. A translation
that frees the outer mesh frees the shape, and one that frees the shape frees the inner mesh.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.audit.body import PlacedBody, SharedMesh
from satcheck.audit.draft import Depth, Trace, Verdict
from satcheck.audit.pair import Pair
from satcheck.audit.stages.concave_depth import depth_of_move
from satcheck.audit.stages.depth import measure_depth
from satcheck.audit.stages.relation import settle
from satcheck.core import Mesh
from satcheck.core.curved.exact.pair import proven, unit
from satcheck.core.curved.freeing import move_off, sides
from satcheck.core.curved.in_mesh import InMesh, relate
from satcheck.core.curved.nesting import nesting
from satcheck.core.curved.placed import is_convex
from satcheck.core.curved.signed import Signed, convex_pair
from satcheck.core.curved.triangles import Nearest, against_triangles
from satcheck.core.rounding import rounding_pad
from satcheck.core.shape_mesh import mesh_around
from satcheck.core.shapes import is_curved
from satcheck.report.report import NOT_AVAILABLE, ON_TRIANGLES, OVERLAPS, Vector
from satcheck.scene.inspect import remeshed

if TYPE_CHECKING:
    from satcheck.audit.body import PlacedBody
    from satcheck.audit.draft import Trace
    from satcheck.audit.pair import Pair
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


def sandwiched_depth(pair: Pair, move: Vector | None, trace: Trace) -> Depth:
    """move: a translation of A within the touch band that is known to free it."""
    inner, outer = _depth_with(pair, around=False), _depth_with(pair, around=True)
    if outer is None:
        raise AssertionError("what is known to overlap a shape overlaps the mesh around it")
    lower = 0.0 if inner is None else max(min(inner.lower, outer.upper) - _sticks_out(pair), 0.0)
    trace.record("depth", "bounded", "between a mesh inside the curved shape and one around it")
    if move is None and None in (pair.a.curved, pair.b.curved):
        move = move_off(pair.a, pair.b, outer.upper, rounding_pad(pair.largest_coordinate))
    if move is not None:
        trace.record("verify", "separated", "the shape, moved by the MTV")
        return depth_of_move(pair, move, lower)
    verified = "separated" if outer.escape.verified else "failed"
    trace.record("verify", verified, "the mesh around the shape, moved by the MTV")
    return Depth(lower, outer.upper, outer.normal, outer.escape)


def _depth_with(pair: Pair, *, around: bool) -> Depth | None:
    """None where the meshes do not overlap."""
    settings = pair.settings
    if not pair.may("hull"):  # shapes have no oriented boxes, so meshes get none
        settings = replace(settings, accuracy="aabb")
    a, b = _as_mesh(pair, pair.a, around), _as_mesh(pair, pair.b, around)
    meshes = replace(pair, a=a, b=b, settings=settings)
    trace = Trace()
    verdict = settle(meshes, trace)
    return measure_depth(meshes, verdict, None, trace) if verdict.relation in OVERLAPS else None


def _sticks_out(pair: Pair) -> float:
    """World units: how far the mesh within the shape may be outside of it, by rounding."""
    slack = sum(body.curved.slack for body in (pair.a, pair.b) if body.curved is not None)
    return slack + rounding_pad(pair.largest_coordinate)


def _as_mesh(pair: Pair, body: PlacedBody, around: bool) -> PlacedBody:
    curved = body.curved
    if curved is None:
        return body
    file, primitive = body.body.file, body.body.shape
    if around and is_curved(primitive):
        # Grown once more by what placing the shape may have rounded, relative to its size.
        grown = mesh_around(primitive)
        size = 1.0 + 4.0 * curved.slack / min(_extents(grown))
        file = remeshed(file, _scaled(grown, size))
    return PlacedBody(replace(body.body, file=file, shape=None), SharedMesh(file, pair.settings))


def _extents(mesh: Mesh) -> tuple[float, ...]:
    low, high = mesh.bounds
    return tuple(b - a for a, b in zip(low, high, strict=True))


def _scaled(mesh: Mesh, by: float) -> Mesh:
    return mesh.transformed(
        [by if i == j < 3 else float(i == j) for i in range(4) for j in range(4)]
    )


def without_meshes(reason: str | None, pair: Pair, trace: Trace) -> str | None:
    """The reason of a finding; it names the figures that are computed on meshes alone, and so are
    not available for a curved shape."""
    missing = [effect for effect in ON_TRIANGLES if pair.request.wants(effect)]
    for effect in missing:
        trace.record(effect, NOT_AVAILABLE, "a curved shape has no triangles")
    if missing:
        return reason or f"{' and '.join(missing)}: not available for curved shapes"
    return reason
