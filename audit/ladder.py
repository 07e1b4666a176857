"""The ladder: each rung settles what it can prove and leaves the rest to the next.

aabb -> obb -> hull -> triangles, or -> parts where --accuracy stops there. A rung that proves the
bodies apart by more than was asked about ends the climb. The highest allowed rung answers in any
case: what it could not prove is then an estimate, and it can only err towards "penetrating".
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from satcheck import core
from satcheck.audit.boxes import holds
from satcheck.audit.oriented_box import nothing_new
from satcheck.audit.pair import Pair
from satcheck.audit.plan import Plan
from satcheck.audit.report import Relation, Vector
from satcheck.audit.tolerances import rounding_pad
from satcheck.core.frozen import frozen

if TYPE_CHECKING:
    from satcheck.audit.curved.signed import Signed

RELATION_OF_OUTCOME: dict[str, Relation] = {
    "separated": "separated",
    "touching": "touching",
    "penetrating": "penetrating",
}


@frozen
class Contact:
    """How two bodies relate, without a touch band.

    proven: False where a capped ladder or a degenerate contact left it open.
    gap_lower: a proven lower bound of their distance, 0.0 where none is known.
    convex: the signed distance, where both bodies are convex and it therefore says everything.
    crossing: indices of one triangle of each body that meet; point: a common point, rounded.
    reason: why it is not proven, where that is no matter of --accuracy.
    """

    relation: Relation
    proven: bool
    gap_lower: float = 0.0
    convex: core.PairResult | Signed | None = None
    crossing: tuple[int, int] | None = None
    point: Vector | None = None
    reason: str | None = None


def settle(pair: Pair, plan: Plan) -> Contact:
    """The relation of the pair by the lowest rung that settles what is asked."""
    contact = _settled(pair, plan)
    plane = pair.settings.planar
    if plane is None:
        return contact
    from satcheck.audit.in_plane import refine_nesting

    return refine_nesting(pair, contact, plane, plan)


def _settled(pair: Pair, plan: Plan) -> Contact:
    gap = boxes_apart(pair, plan)
    if gap > pair.asked_gap or not pair.may("obb"):
        return _apart_or_guess(gap)
    if pair.curved:
        from satcheck.audit.curved.contact import settle_curved

        return settle_curved(pair, plan) if pair.may("hull") else _apart_or_guess(gap)
    if _oriented_boxes_apart(pair, plan):
        return Contact("separated", True, math.nextafter(pair.asked_gap, math.inf))
    if not pair.may("hull"):
        return _apart_or_guess(gap)
    if _outlines_apart(pair, plan):
        return Contact("separated", True, math.nextafter(pair.asked_gap, math.inf))
    contact = _convex(pair, plan) if pair.both_convex else _hulls(pair, plan, gap)
    if contact is not None:
        return contact
    if pair.may("exact"):
        return _triangles(pair, plan)
    if pair.may("parts"):
        from satcheck.audit.parts_only import settle_by_parts

        return settle_by_parts(pair, plan)
    return Contact("penetrating", False)


def _apart_or_guess(gap: float) -> Contact:
    return Contact("separated", True, gap) if gap > 0 else Contact("penetrating", False)


def boxes_apart(pair: Pair, plan: Plan) -> float:
    """Rung 0: a lower bound of the gap of the world boxes, 0.0 when they meet."""
    gap = core.box_gap(pair.a.bounds, pair.b.bounds)
    if gap > 0:
        plan.record("aabb", "separated", f"world boxes apart by at least {gap:.6g}")
    else:
        plan.record("aabb", "meet", "world boxes meet")
    return gap


def _oriented_boxes_apart(pair: Pair, plan: Plan) -> bool:
    """Whether the files' own boxes, placed, are apart by more than was asked about."""
    pads, gap = (pair.a.resolution, pair.b.resolution), pair.asked_gap
    if sum(pads) < gap:  # as a rule it is not, and a body keeps its box for all its pairs
        pads = (0.5 * gap, 0.5 * gap)
    a, b = pair.a.oriented_box(pads[0]), pair.b.oriented_box(pads[1])
    if a.posed is None or b.posed is None or not (a.turned or b.turned):
        plan.record("obb", "skipped", nothing_new(a, b))
        return False
    (shape_a, pose_a), (shape_b, pose_b) = a.posed, b.posed
    result = core.check_pair(shape_a, shape_b, pose_a, pose_b, query="overlap")
    apart = result.outcome == "separated"
    plan.record("obb", "separated" if apart else "meet", result.feature if apart else "")
    return apart


def _outlines_apart(pair: Pair, plan: Plan) -> bool:
    """Whether, in a check in a plane, an edge of two convex outlines proves what is asked."""
    a, b = pair.a.body.file.outline, pair.b.body.file.outline
    if a is None or b is None:
        return False
    import numpy as np

    found = core.sat_polygons(np.array(a), np.array(b))
    # The widest gap along an edge normal, less what its rounding can make of it.
    gap = -found.penetration - rounding_pad(pair.largest_coordinate)
    plan.record("sat", found.outcome, _edge_of(found))
    return found.outcome == "separated" and gap > pair.asked_gap


def _edge_of(found: core.PolygonResult) -> str:
    body, edge = ("A", found.edge_a) if found.edge_a >= 0 else ("B", found.edge_b)
    return f"outlines, edge {edge} of {body}"


def _convex(pair: Pair, plan: Plan) -> Contact | None:
    """Everything about two convex bodies; None when the solver could not decide."""
    result = core.check_pair(pair.a.hull_shape(), pair.b.hull_shape(), query="depth")
    plan.record("hull", result.outcome, f"both convex: {result.method} {result.feature}".rstrip())
    if result.outcome == "undecided":
        return None
    relation = RELATION_OF_OUTCOME[result.outcome]
    if relation == "penetrating":
        relation = _containment(pair, plan)
    return Contact(relation, True, max(result.lower or 0.0, 0.0), result)


def _containment(pair: Pair, plan: Plan) -> Relation:
    """Refine "penetrating" of two convex bodies; only nested boxes can hold nested bodies."""
    if not (holds(pair.a.bounds, pair.b.bounds) or holds(pair.b.bounds, pair.a.bounds)):
        return "penetrating"
    found = core.mesh_relation(pair.a.surface(), pair.b.surface())
    plan.record("containment", found.relation, "one world box holds the other")
    # The surfaces differ from the hulls by the rounding of the pose: a relation without a common
    # interior can then only mean a graze, which the hulls have already settled.
    nested = found.relation in ("contains", "inside", "coincident")
    return _relation(found.relation) if nested else "penetrating"


def _hulls(pair: Pair, plan: Plan, box_lower: float) -> Contact | None:
    """Apart, if the hulls of the whole meshes are; None otherwise."""
    a, b = pair.a.hull_shape(), pair.b.hull_shape()
    overlap = core.check_pair(a, b, query="overlap")
    if overlap.outcome != "separated":
        result = "undecided" if overlap.outcome == "undecided" else "meet"
        plan.record("hull", result, "not both convex: hulls prove only separation")
        return None
    distance = core.check_pair(a, b, query="distance")
    lower = max(distance.lower or 0.0, box_lower)
    plan.record("hull", "separated", f"hulls apart by at least {lower:.6g}")
    return Contact("separated", True, lower)


def _triangles(pair: Pair, plan: Plan) -> Contact:
    found = core.mesh_relation(pair.a.surface(), pair.b.surface())
    detail = f"{found.box_tests} box tests, {found.triangle_tests} triangle tests"
    crossing = None
    if found.triangle_a >= 0 and found.triangle_b >= 0:
        crossing = (found.triangle_a, found.triangle_b)
        detail += f", triangles {found.triangle_a} and {found.triangle_b} meet"
    if not found.proven:
        detail += ", sampled in a degenerate contact"
    plan.record("triangles", found.relation, detail)
    return Contact(_relation(found.relation), found.proven, crossing=crossing, point=found.point)


def _relation(name: str) -> Relation:
    known: dict[str, Relation] = {
        **RELATION_OF_OUTCOME,
        "contains": "contains",
        "inside": "inside",
        "coincident": "coincident",
    }
    return known[name]
