"""The stage of curved shapes: the relation, as the core decides it, the depth in a mesh that is not
convex, and what is not available.

The depth is between that of a mesh inside the shape and that of a mesh around it. A translation
that frees the outer mesh frees the shape, and one that frees the shape frees the inner mesh.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.audit.body import PlacedBody, SharedMesh
from satcheck.audit.draft import Depth, Draft
from satcheck.audit.pair import Pair
from satcheck.audit.stages.concave_depth import depth_of_move
from satcheck.audit.stages.depth import measure_depth
from satcheck.audit.stages.relation import settle
from satcheck.core import Mesh
from satcheck.core.curved.exact.pair import proven, unit
from satcheck.core.curved.freeing import move_off, sides
from satcheck.core.curved.in_mesh import InMesh, ends_crossed, relate
from satcheck.core.curved.nesting import nesting
from satcheck.core.curved.placed import is_convex
from satcheck.core.curved.signed import Signed, convex_pair
from satcheck.core.curved.triangles import FEW, Nearest, against_triangles
from satcheck.core.rounding import rounding_pad
from satcheck.core.shape_mesh import mesh_around
from satcheck.core.shapes import is_curved
from satcheck.report.report import NOT_AVAILABLE, ON_TRIANGLES, OVERLAPS, Vector
from satcheck.scene.inspect import remeshed

if TYPE_CHECKING:
    from satcheck.audit.body import PlacedBody
    from satcheck.audit.pair import Pair
    from satcheck.core.curved.exact.proof import Proof
    from satcheck.report.report import Relation


STAGE = "curved"
PROOF = "curved-exact"
TOO_CLOSE = "they overlap, and one may lie within the other: too close to its surface to tell"
OPEN_BOUNDS = "the bounds of a curved shape did not close"
CLOSE_CONTACT = "a curved shape in contact as far as its bounds tell"
# Steps, each about a nanosecond: of a triangle that is compared, of bounds that are narrowed to
# rounding, and of exact arithmetic.
STEPS_OF_COMPARED, STEPS_OF_BOUNDS, STEPS_OF_PROOF = 25_000, 200_000, 200_000
_OPEN_TRIANGLES = "the bounds of a curved shape and a triangle did not close"
_NO_POINT = "no point of a curved shape could be told to lie within the mesh or not"
_SWAPPED: dict[Relation, Relation] = {"contains": "inside", "inside": "contains"}
_PROVES = {
    "separated": "separates them",
    "touching": "separates them without a gap, and they have a point in common",
    "penetrating": "is that of a point inside both",
    "free": "separates them without a gap",
}


def settle_curved(draft: Draft) -> None:
    """Find how bodies relate whose boxes do not settle it."""
    if is_convex(draft.pair.a) and is_convex(draft.pair.b):
        _settle_convex(draft)
    else:
        _settle_mesh(draft)


def _settle_convex(draft: Draft) -> None:
    pair = draft.pair
    # An overlap deeper than the tolerance has no figures before it fails.
    wants_figures = "depth" not in pair.request.if_failing
    signed = convex_pair(pair.a, pair.b, enough=math.inf if wants_figures else pair.tolerance)
    if signed is None:
        draft.record(STAGE, "undecided", OPEN_BOUNDS)
        draft.found("indeterminate", False, weak=f"undecided: {OPEN_BOUNDS}")
        return
    draft.record(STAGE, signed.outcome, "convex shapes")
    draft.steps += STEPS_OF_BOUNDS if signed.outcome != "separated" and signed.normal else 0
    if not signed.exact:
        draft.steps += STEPS_OF_PROOF
        signed, proof = proven(pair.a, pair.b, signed)
        draft.record(PROOF, signed.outcome if signed.exact else "undecided", _words(proof))
    if signed.outcome == "penetrating":
        _find_nested(draft, signed)
        return
    weak = None if signed.exact else CLOSE_CONTACT
    relation: Relation = signed.outcome  # type: ignore[assignment]
    draft.found(relation, signed.exact, max(signed.lower, 0.0), signed, weak=weak)


def _words(proof: Proof | None) -> str:
    if proof is None:
        return "no exact axis was found"
    axis = ", ".join(f"{c:.6g}" for c in unit(proof.axis))
    return f"the axis ({axis}) {_PROVES[proof.outcome]}"


def _find_nested(draft: Draft, signed: Signed) -> None:
    """Find whether one of two overlapping convex bodies contains the other."""
    nested = nesting(draft.pair.a, draft.pair.b)
    draft.steps += STEPS_OF_PROOF if nested.exact and nested.known else 0
    if nested.exact:
        draft.record(PROOF, "known" if nested.known else "undecided", "which holds which")
    if nested.relation != "penetrating":
        draft.record("containment", nested.relation, "one shape holds the other")
    weak = None if nested.known else TOO_CLOSE
    draft.found(nested.relation, nested.known, 0.0, signed, weak=weak, overlaps=True)


def _settle_mesh(draft: Draft) -> None:
    pair = draft.pair
    curved, mesh, sign = sides(pair.a, pair.b)
    seen = against_triangles(curved, mesh.mesh, pair.gap_limit, FEW)
    draft.steps += _steps_of(seen)
    if seen.compared == FEW and not ends_crossed(mesh, seen):
        seen = against_triangles(curved, mesh.mesh, pair.gap_limit)
        draft.steps += _steps_of(seen)
    if seen.refined:
        detail = f"{seen.refined} triangles that bounds leave open"
        draft.record(PROOF, seen.nearest.outcome if seen.nearest else "undecided", detail)
    result = relate(curved, mesh, seen, pair.gap_limit)
    if result.relation == "undecided":
        weak = _open(result, pair.b if sign > 0 else pair.a, seen)
        draft.record(STAGE, "undecided", weak)
        draft.found("indeterminate", False, weak=f"undecided: {weak}")
        return
    relation: Relation = result.relation
    if sign < 0:
        relation = _SWAPPED.get(relation, relation)
    draft.record(STAGE, relation, _detail(result, seen))
    if relation in ("separated", "touching"):
        signed = result.signed if sign > 0 or result.signed is None else result.signed.swapped()
        why = None if result.proven else CLOSE_CONTACT
        draft.found(relation, result.proven, result.gap_lower, signed, weak=why)
    else:
        why = None if result.proven else TOO_CLOSE
        overlaps = bool(result.crossed) or not result.proven
        draft.found(relation, result.proven, weak=why, overlaps=overlaps)


def _steps_of(seen: Nearest) -> int:
    return STEPS_OF_COMPARED * seen.compared + STEPS_OF_PROOF * seen.refined


def _detail(result: InMesh, seen: Nearest) -> str:
    if result.crossed:
        return f"at least {result.crossed} triangles meet the inside of the shape"
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


def sandwiched_depth(draft: Draft, move: Vector | None) -> Depth:
    """move: a translation of A within the touch band that is known to free it."""
    pair = draft.pair
    inner, outer = _depth_with(pair, around=False), _depth_with(pair, around=True)
    if outer is None:
        raise AssertionError("what is known to overlap a shape overlaps the mesh around it")
    lower = 0.0 if inner is None else max(min(inner.lower, outer.upper) - _sticks_out(pair), 0.0)
    draft.record("depth", "bounded", "between a mesh inside the curved shape and one around it")
    if move is None and None in (pair.a.curved, pair.b.curved):
        move = move_off(pair.a, pair.b, outer.upper, rounding_pad(pair.largest_coordinate))
    if move is not None:
        draft.record("verify", "separated", "the shape, moved by the MTV")
        return depth_of_move(pair, move, lower)
    verified = "separated" if outer.escape.verified else "failed"
    draft.record("verify", verified, "the mesh around the shape, moved by the MTV")
    return Depth(lower, outer.upper, outer.escape)


def _depth_with(pair: Pair, *, around: bool) -> Depth | None:
    """None where the meshes do not overlap."""
    settings = pair.settings
    if not pair.may("hull"):  # shapes have no oriented boxes, so meshes get none
        settings = replace(settings, accuracy="aabb")
    a, b = _as_mesh(pair, pair.a, around), _as_mesh(pair, pair.b, around)
    meshes = replace(pair, a=a, b=b, settings=settings)
    draft = Draft(meshes)
    settle(draft)
    return measure_depth(draft, None) if draft.exact in OVERLAPS else None


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


def note_unavailable(draft: Draft) -> None:
    """Note the figures that are computed on meshes alone, and so are not available for a curved
    shape."""
    missing = [effect for effect in ON_TRIANGLES if draft.pair.request.wants(effect)]
    for effect in missing:
        draft.record(effect, NOT_AVAILABLE, "a curved shape has no triangles")
    if missing and draft.reason is None:
        draft.reason = f"{' and '.join(missing)}: not available for curved shapes"
